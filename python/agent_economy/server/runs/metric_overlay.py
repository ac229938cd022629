"""What a page draws over a moment of the metric engine: who hears whom, and what sensors cover."""

from agent_economy import _core
from agent_economy.runs.simulation import Simulation

MAX_ROBOTS = 300
"""Of more robots only what is the selected one's is drawn: a picture full of it says nothing."""

MAX_LINKS = 4000


def links(simulation: Simulation, selected: str | None) -> bytes:
    """Return who hears whom: see `_core.drawn_links`."""
    run, everyone = simulation._run, is_few(simulation)  # noqa: SLF001  (ours)
    return _core.drawn_links(run, selected, everyone, MAX_LINKS)


def footprints(simulation: Simulation, selected: str | None) -> bytes:
    """Return what sensors cover: see `_core.drawn_footprints`."""
    run, everyone = simulation._run, is_few(simulation)  # noqa: SLF001  (ours)
    return _core.drawn_footprints(run, selected, everyone)


def is_few(simulation: Simulation) -> bool:
    """Return whether what is of all robots can be drawn."""
    return sum(simulation.scenario.robots.values()) <= MAX_ROBOTS
