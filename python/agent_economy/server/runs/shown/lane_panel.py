"""The panel of the mined lane: what a controller believes of it, beside the truth."""

from collections import Counter
from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy.runs.lane import BelievedLane, LaneMark
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.shown import passage
from agent_economy.server.runs.shown.lane_choice import CONTROLLER
from agent_economy.server.runs.shown.tables import (
    muted,
    percent,
    plain,
    plural,
    row,
    section,
    strong,
    table,
)
from agent_economy.types.page import Choice, Panel, Section

STATES = ("unverified", "confirmed", "rejected", "missed", "neutralised", "isolated")

HEADING = "Mined lane"
"""The heading of the legend."""

BELIEVED = 0.5
"""From this probability on, a mark is believed to be a mine."""

EXPLANATION = (
    "A cell is cleared if the lane would be declared clear with this risk in all cells. The colour "
    "scale is logarithmic and includes the mines at marks."
)


def panel(simulation: Simulation, lane: BelievedLane) -> Panel:
    """Return the panel for the belief of a controller."""
    return {"note": None, "sections": list(sections(simulation, lane))}


def sections(simulation: Simulation, lane: BelievedLane) -> Iterator[Section]:
    """Yield the sections."""
    yield belief(simulation, lane)
    if lane.passage is not None:
        yield passage.section_of(lane.passage)
    vehicles = simulation.vehicles
    truth = section("Truth")
    truth["switch"] = {"layer": "items", "label": "Show the truth: items and mines left"}
    texts = [truth_label(simulation.mines_left)]
    if vehicles:
        texts.append(passage.vehicles_label(vehicles))
    truth["paragraphs"] = [strong(text) for text in texts]
    truth["legend"] = HEADING
    yield truth
    yield section() | {"paragraphs": [muted(EXPLANATION)]}


def belief(simulation: Simulation, lane: BelievedLane) -> Section:
    """Return what the controller believes."""
    names = [each.controller for each in simulation.lanes]
    chosen: Choice = {
        "key": CONTROLLER,
        "label": "Controller",
        "options": names,
        "chosen": lane.controller,
    }
    statement = statement_label(lane)
    found = section(f"Belief of {lane.controller}")
    found["choice"] = chosen if len(names) > 1 else None
    found["paragraphs"] = [
        plain(risk_label(lane)),
        strong(statement) if lane.statement else plain(statement),
    ]
    if lane.statement is None:
        path = f"controllers.{clearing_kind(simulation.scenario.to_dict())}.clearance.called_off"
        found["button"] = {"label": "Call off the mission", "path": path}
    shares = [row((f"Clearance of {of.kind}", passage.cleared_label(of))) for of in lane.clearance]
    mines = sum(is_believed_mine(mark.mine) for mark in lane.marks)
    signals = [f"controller/{lane.controller}/{key}" for key in ("risk", "marked", "marks")]
    path = f"{percent(float(lane.cleared.mean()))} of the lane"
    rest = [
        row(("Remaining risk", percent(lane.risk.probability)), signals=signals[:1]),
        row(("Cleared path", path)),
        row(("Believed mines", str(mines)), signals=signals[1:2]),
        row(("Marks", mark_counts(lane.marks)), signals=signals[2:]),
    ]
    found["table"] = table((), [*shares, *rest])
    return found


def clearing_kind(document: Mapping[str, Any]) -> str | None:
    """Return the kind of controllers that are to clear the lane; None if there is none."""
    kinds = document.get("controllers", {}).items()
    return next((name for name, kind in kinds if "clearance" in kind), None)


def is_believed_mine(mine: float) -> bool:
    """Return whether the controller believes that there is a mine, by its probability."""
    return mine >= BELIEVED


def mark_counts(marks: list[LaneMark]) -> str:
    """Return the marks of each state that occurs: "3 unverified, 2 neutralised"."""
    counts: Counter[str] = Counter(mark.verdict or "unverified" for mark in marks)
    return ", ".join(f"{counts[state]} {state}" for state in STATES if counts[state]) or "no marks"


def risk_label(lane: BelievedLane) -> str:
    """Return the risk: "Remaining risk 3.1%: 0.021 mines expected without a mark, ..."."""
    risk = lane.risk
    return (
        f"Remaining risk {percent(risk.probability)}: {expected_label(risk.unmarked)} mines "
        f"expected without a mark, {expected_label(risk.marked)} at marks."
    )


def statement_label(lane: BelievedLane) -> str:
    """Return what has been stated: "Declared clear at 412.0 s, at a risk of 4.6%."."""
    of = lane.statement
    if of is None:
        below = percent(lane.declare_below)
        return f"No statement yet: it declares the lane clear below {below}."
    verb = "Declared clear" if of.is_clear else "Given up"
    return f"{verb} at {of.at_s:.1f} s, at a risk of {percent(of.risk)}."


def truth_label(mines: int) -> str:
    """Return the truth: "2 mines left in the lane."."""
    return f"{plural(mines, 'mine') if mines else 'No mines'} left in the lane."


def expected_label(mines: float) -> str:
    """Return an expected number of mines: "2.3", "0.31", "0.021"."""
    decimals = (mines < 1) + (mines < 0.1) + 1  # noqa: PLR2004  (two figures)
    return f"{mines:.{decimals}f}"
