"""The columns of the outcome that a page displays: those that apply, and which come first."""

from collections.abc import Iterator, Mapping
from typing import Any

from agent_economy import _core
from agent_economy.runs.columns import Description, description_of
from agent_economy.runs.outcome import find_times, kinds
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario
from agent_economy.types.page import ColumnOffer

Bounds = Mapping[str, tuple[float | None, float | None]]
"""The minimum and the maximum of each column; None where there is none."""

GROUPS = ("Mission", "Finds", "Goals", "Acts", "Lane", "Vehicles", "Team", "Costs", "Messages")
"""The groups in the order in which they are displayed."""

MISSION = ("declared", "served", "found")
"""Columns of the progress of a mission. Without any, each run is complete from the start."""

NONE = (0, 0)
"""The bounds of a column that does not apply; also of one that there is not."""

PROGRESS = (*MISSION, "complete")
"""What `failed` depends on: the first that applies is displayed in its place."""

USUAL = ("declared", "stated_risk", "served", "found", "time_s", "collisions", "distance_m")
"""What is displayed first besides, if the question of a scenario has fewer columns than
`NUMBER_FIRST`."""

NUMBER_FIRST = 3


def offer_of(simulation: Stepped) -> list[ColumnOffer]:
    """Return the columns that apply to a run: first those that answer its question."""
    bounds = {name: (low, high) for name, _, low, high in simulation._run.columns}  # noqa: SLF001  (ours)
    descriptions = dict(descriptions_of(simulation, bounds))
    first = first_of(simulation.scenario, bounds, descriptions)
    order = {name: place for place, name in enumerate(first)}
    names = sorted(
        descriptions,
        key=lambda name: (order.get(name, len(first)), GROUPS.index(descriptions[name].group)),
    )
    return [
        offered(name, descriptions[name], bounds.get(name, (None, None)), is_first=name in order)
        for name in names
    ]


def descriptions_of(simulation: Stepped, bounds: Bounds) -> Iterator[tuple[str, Description]]:
    """Yield the columns that apply to a run.

    These are those that can have another value than 0, and those that have one, such as the
    distance of robots that were removed by a change.
    """
    times = find_times(bounds)
    document = _core.read_filled(simulation.scenario.source)
    values = simulation.outcome().row
    for name in ("complete", *bounds, "merit"):
        description = None if name in times else description_of(name)
        if description and (is_counted(values.get(name)) or applies(name, bounds, document)):
            yield name, description


def is_counted(value: object) -> bool:
    """Return whether a value is a number other than 0."""
    return isinstance(value, (int, float)) and not isinstance(value, bool) and value != 0


def applies(name: str, bounds: Bounds, document: Mapping[str, Any]) -> bool:
    """Return whether a column can have another value than 0, by its bounds and the scenario."""
    _, high = bounds.get(name, (None, None))
    if high == 0:
        return False
    if name == "complete":
        return bool(document.get("end")) or any(bounds.get(each, NONE) != NONE for each in MISSION)
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


def first_of(
    scenario: Scenario, bounds: Bounds, descriptions: Mapping[str, Description]
) -> list[str]:
    """Return the columns that answer the question of a scenario.

    These are those of its requirement, then those of its figure of merit in the order of their
    weights, without those that are the same in all runs of the scenario.
    """
    required = scenario.requirement.conditions if scenario.requirement else ()
    terms = sorted(scenario.merit.terms, key=lambda term: -abs(term.weight))
    wanted = [*(each.column for each in required), *(term.column for term in terms)]
    varying = [name for name in wanted if not is_constant(bounds, name)]
    known = [column for name in varying for column in displayed(name, descriptions)]
    usual = [name for name in USUAL if name in descriptions]
    return list(dict.fromkeys([*known, *usual]))[:NUMBER_FIRST]


def is_constant(bounds: Bounds, name: str) -> bool:
    """Return whether a column is the same in all runs."""
    low, high = bounds.get(name, (None, None))
    return low is not None and low == high


def displayed(name: str, descriptions: Mapping[str, Description]) -> list[str]:
    """Return what is displayed of a column: of one known only after an event, that event."""
    if name == "failed":
        return [each for each in PROGRESS if each in descriptions][:1]
    description = descriptions.get(name)
    if description is None:
        return []
    return [description.time_of or (description.after[0] if description.after else name)]


def offered(
    name: str,
    description: Description,
    bounds: tuple[float | None, float | None],
    *,
    is_first: bool,
) -> ColumnOffer:
    """Return a column as it is sent."""
    high = bounds[1]
    return {
        "id": name,
        "label": description.label,
        "unit": description.unit,
        "group": description.group,
        "help": description.help,
        "is_first": is_first,
        "known": description.known,
        "after": description.after,
        "time_of": description.time_of,
        "out_of": description.out_of,
        "all": int(high) if description.of_all and high is not None else None,
    }
