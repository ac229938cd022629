"""The engines, as a page sees them: what is drawn of a run of each."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs import belief_view, classic_view, metric_overlay, metric_view


class Selection(Protocol):
    """What tells of the robot that a page looks at, as `messages` says."""

    def choose(self, robot: str | None) -> None:
        """Look at a robot, or at none."""

    def mind(self, simulation: Any) -> dict[str, Any] | None:
        """Return what the robot perceived, decided and believes; None if there is no such."""

    def map(self, simulation: Any) -> dict[str, Any] | None:
        """Return what of the robot's map the page does not know; None if it knows all."""

    def told(self, simulation: Any) -> dict[str, Any] | None:
        """Return what else the engine knows of the robot."""


Overlaid = Callable[[Any, str | None], bytes]
"""What lies over a moment of a run, of which a robot may be selected."""


class Engine(NamedTuple):
    """What one engine gives; its functions take runs of its own.

    Attributes:
        drawn: One moment of it, as `messages` says.
        still: What a setting has that is the engine's own: `world`, `kinds`, `items`, `maps`.
        selected: Makes what tells of the robot that a page looks at.
        links: Who hears whom, as `messages` says; None if robots have no radios.
        footprints: What sensors cover, as `messages` says; None if robots have none.
    """

    drawn: Callable[[Any], bytes]
    still: Callable[[Any], dict[str, Any]]
    selected: Callable[[], Selection]
    links: Overlaid | None
    footprints: Overlaid | None


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
