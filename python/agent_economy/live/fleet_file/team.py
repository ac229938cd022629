"""The robots of a fleet are robots of its scenario; the others of its team are simulated."""

import re
from collections.abc import Iterable, Iterator, Mapping
from itertools import islice

from agent_economy._core import Document
from agent_economy.live.fleet_file.findings import Findings, listed

MAX_NAMES = 1000
"""Maximum number of names that are compared for a suggestion."""


def robot_of(name: str, counts: Mapping[str, int]) -> tuple[str, int] | None:
    """Return the kind and the index of a robot; None if the scenario has no robot of that name."""
    match = re.fullmatch(r"(.+)/(0|[1-9][0-9]{0,8})", name)
    if match is None:
        return None
    kind, index = match[1], int(match[2])
    return (kind, index) if index < counts.get(kind, 0) else None


def check_names(
    findings: Findings, fleet: Document, names: Iterable[str], counts: Mapping[str, int]
) -> None:
    """Report robots that the scenario lacks, and a fleet without robots.

    Args:
        findings: Receives the errors.
        fleet: The fleet file.
        names: The robots of the fleet.
        counts: The number of robots of the scenario, by kind.
    """
    given = sorted(names)
    for name in given:
        if robot_of(name, counts) is None:
            near = list(islice(_team(counts), MAX_NAMES))
            allowed = (
                f"a robot of the scenario: {listed(_spans(counts)) if near else 'it has none'}"
            )
            findings.unknown_key(fleet, ("robots", name), allowed, near)
    if not given:
        findings.error(fleet, ("robots",), "a table with at least one robot of the scenario")


def simulated(names: Iterable[str], counts: Mapping[str, int]) -> list[str]:
    """Return robots that a fleet lacks: of each kind the first, and the number of others."""
    given = set(names)
    found = []
    for kind, count in counts.items():
        others = [index for index in range(count) if f"{kind}/{index}" not in given]
        if others:
            more = f" and {len(others) - 1} more of this kind" if others[1:] else ""
            found.append(f"{kind}/{others[0]}{more}")
    return found


def _team(counts: Mapping[str, int]) -> Iterator[str]:
    for kind, count in counts.items():
        yield from (f"{kind}/{index}" for index in range(count))


def _spans(counts: Mapping[str, int]) -> list[str]:
    ends = {kind: count - 1 for kind, count in counts.items() if count}
    return [f"{kind}/0" + (f" to {kind}/{last}" if last else "") for kind, last in ends.items()]
