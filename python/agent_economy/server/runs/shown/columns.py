"""The columns of the outcome that a page displays: those that apply, and which come first."""

from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy.runs.columns import ColumnText, column_text
from agent_economy.runs.outcome import find_times, kinds
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario
from agent_economy.types.page import ColumnOffer

Bounds = Mapping[str, tuple[float | None, float | None]]
"""The minimum and the maximum of each column; None where there is none."""

GROUPS = ("Mission", "Finds", "Goals", "Acts", "Lane", "Vehicles", "Team", "Costs", "Messages")
"""The groups in the order in which they are displayed."""

SOUGHT = ("declared", "served", "found")
"""Columns that say how far a mission is; without any of them, each run is complete from the start."""

NONE = (0, 0)
"""The bounds of a column that does not apply; also of one that there is not."""

PROGRESS = (*SOUGHT, "complete")
"""What `failed` depends on: the first that applies says how far the mission is."""

USUAL = ("declared", "stated_risk", "served", "found", "time_s", "collisions", "distance_m")
"""What is displayed first of scenarios whose question asks for less than `NUMBER_FIRST`."""

NUMBER_FIRST = 3


def offer_of(simulation: Stepped) -> list[ColumnOffer]:
    """Return the columns that apply to a run: first those that its question asks for."""
    bounds = {name: (low, high) for name, _, low, high in simulation._run.columns}  # noqa: SLF001  (ours)
    texts = dict(texts_of(bounds, simulation.scenario))
    first = first_of(simulation.scenario, bounds, texts)
    order = {name: place for place, name in enumerate(first)}
    names = sorted(
        texts, key=lambda name: (order.get(name, len(first)), GROUPS.index(texts[name].group))
    )
    return [
        offered(name, texts[name], bounds.get(name, (None, None)), is_first=name in order)
        for name in names
    ]


def texts_of(bounds: Bounds, scenario: Scenario) -> Iterator[tuple[str, ColumnText]]:
    """Yield the columns that apply to a scenario."""
    times = find_times(bounds)
    document = scenario.to_dict()
    for name in ("complete", *bounds, "merit"):
        text = column_text(name)
        if text and name not in times and applies(name, bounds, document):
            yield name, text


def applies(name: str, bounds: Bounds, document: Mapping[str, Any]) -> bool:
    """Return whether a column can have another value than 0, by its bounds and the scenario."""
    _, high = bounds.get(name, (None, None))
    if high == 0:
        return False
    if name == "complete":
        return bool(document.get("end")) or any(bounds.get(each, NONE) != NONE for each in SOUGHT)
    if name == "false_alarms":
        return bool(kinds(bounds))
    if name in ("goals_refused", "leases_lapsed"):
        return bool(document.get("controllers"))
    return all(is_in_use(kind, robots, name) for kind, robots in robots_of(document))


def robots_of(document: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any]]]:
    """Yield the robot kinds."""
    robots = document.get("robots")
    yield from robots.items() if isinstance(robots, Mapping) else ()


def is_in_use(kind: str, robots: Mapping[str, Any], name: str) -> bool:
    """Return whether there are robots of a kind, and charges, if a column counts what it does."""
    own = (f"on_station_{kind}_s", f"distance_{kind}_m", f"energy_{kind}_j")
    charges = f"charges_used_{kind}"
    if name not in (*own, charges):
        return True
    has_charges = "neutralise" in robots.get("tools", {})
    return robots.get("count", 1) != 0 and (name != charges or has_charges)


def first_of(scenario: Scenario, bounds: Bounds, texts: Mapping[str, ColumnText]) -> list[str]:
    """Return the columns that the question of a scenario asks for.

    These are those of its requirement, then those of its figure of merit in the order of their
    weights, without those that are the same in all runs of the scenario.
    """
    required = scenario.requirement.conditions if scenario.requirement else ()
    terms = sorted(scenario.merit.terms, key=lambda term: -abs(term.weight))
    asked = [*(each.column for each in required), *(term.column for term in terms)]
    varying = [name for name in asked if not is_constant(bounds, name)]
    known = [column for name in varying for column in displayed(name, texts)]
    usual = [name for name in USUAL if name in texts]
    return list(dict.fromkeys([*known, *usual]))[:NUMBER_FIRST]


def is_constant(bounds: Bounds, name: str) -> bool:
    """Return whether a column is the same in all runs."""
    low, high = bounds.get(name, (None, None))
    return low is not None and low == high


def displayed(name: str, texts: Mapping[str, ColumnText]) -> list[str]:
    """Return what is displayed of a column: of one known only after an event, that event."""
    if name == "failed":
        return [each for each in PROGRESS if each in texts][:1]
    text = texts.get(name)
    if text is None:
        return []
    return [text.time_of or (text.after[0] if text.after else name)]


def offered(
    name: str, text: ColumnText, bounds: tuple[float | None, float | None], *, is_first: bool
) -> ColumnOffer:
    """Return a column as it is sent."""
    high = bounds[1]
    return {
        "id": name,
        "label": text.label,
        "unit": text.unit,
        "group": text.group,
        "help": text.help,
        "is_first": is_first,
        "known": text.known,
        "after": text.after,
        "time_of": text.time_of,
        "out_of": text.out_of,
        "all": int(high) if text.of_all and high is not None else None,
    }
