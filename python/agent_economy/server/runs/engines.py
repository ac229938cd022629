"""The engines as a page sees them: what is drawn of a run of each."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs import (
    belief_view,
    classic_view,
    metric_overlay,
    metric_view,
)
from agent_economy.types.page import Inspection, MapPart, RobotView


class Selection(Protocol):
    """The robot that a page has selected."""

    def choose(self, robot: str | None) -> None:
        """Select a robot, or none."""

    def inspection(self, simulation: Any) -> Inspection | None:
        """Return what the robot perceives, decides and believes; None if there is none."""

    def map(self, simulation: Any) -> MapPart | None:
        """Return the changes of the robot's map since the last call; None if there are none."""

    def details(self, simulation: Any) -> RobotView | None:
        """Return what else the engine knows of the robot."""


DrawOverlay = Callable[[Any, str | None], bytes]
"""Draws an overlay of the current moment of a run, with a robot selected or None."""


class Engine(NamedTuple):
    """The functions of one engine, which take its own runs.

    Attributes:
        drawn: Draws the current moment, encoded as in `frames`.
        still: Returns what a setting contains of the engine: `world`, `kinds`, `items`, `maps`.
        selected: Returns the selection of a new run.
        links: Draws the radio links, encoded as in `overlay`; None if robots have no radios.
        footprints: Draws the areas that sensors cover; None if robots have no sensors.
    """

    drawn: Callable[[Any], bytes]
    still: Callable[[Any], dict[str, Any]]
    selected: Callable[[], Selection]
    links: DrawOverlay | None
    footprints: DrawOverlay | None


ENGINES = {
    "metric": Engine(
        metric_view.drawn,
        metric_view.still,
        belief_view.Selected,
        metric_overlay.links,
        metric_overlay.footprints,
    ),
    "classic": Engine(classic_view.drawn, classic_view.still, classic_view.Selected, None, None),
}


def of(simulation: Stepped) -> Engine:
    """Return the engine of a run."""
    return ENGINES[simulation.scenario.engine]
