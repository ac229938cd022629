"""What a page draws over a frame of the metric engine: radio links, and what sensors cover."""

from agent_economy import _core
from agent_economy.runs.simulation import Simulation

MAX_ROBOTS = 300
"""Larger teams are drawn with the links and footprints of the selected robot only."""

MAX_LINKS = 4000


def links(simulation: Simulation, selected: str | None) -> bytes:
    """Return the radio links: see `_core.drawn_links`."""
    run, everyone = simulation._run, is_small(simulation)  # noqa: SLF001  (ours)
    return _core.drawn_links(run, selected, everyone, MAX_LINKS)


def footprints(simulation: Simulation, selected: str | None) -> bytes:
    """Return the areas that sensors cover: see `_core.drawn_footprints`."""
    run, everyone = simulation._run, is_small(simulation)  # noqa: SLF001  (ours)
    return _core.drawn_footprints(run, selected, everyone)


def is_small(simulation: Simulation) -> bool:
    """Return whether the team is small enough to draw all of it."""
    return sum(simulation.scenario.robots.values()) <= MAX_ROBOTS
