"""The engines, as a page sees them: what begins a run of each, and what is drawn of one."""

from collections.abc import Callable
from typing import Any, NamedTuple, Protocol

from agent_economy.classic_simulation import ClassicSimulation
from agent_economy.scenario import Scenario
from agent_economy.server import classic_view, metric_view, mind
from agent_economy.simulation import Simulation
from agent_economy.stepped import Stepped


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


class Engine(NamedTuple):
    """What one engine gives; its functions take runs of its own.

    Attributes:
        begun: Makes a run of a scenario, a seed and a number.
        drawn: One moment of it, as `messages` says.
        still: What a setting has that is the engine's own: `world`, `kinds`, `items`, `maps`.
        selected: Makes what tells of the robot that a page looks at.
    """

    begun: Callable[[Scenario, int, int], Stepped]
    drawn: Callable[[Any], bytes]
    still: Callable[[Any], dict[str, Any]]
    selected: Callable[[], Selection]


ENGINES = {
    "metric": Engine(Simulation, metric_view.drawn, metric_view.still, mind.Selected),
    "classic": Engine(
        ClassicSimulation, classic_view.drawn, classic_view.still, classic_view.Selected
    ),
}


def begun(scenario: Scenario, seed: int, run: int) -> Stepped:
    """Begin a run.

    Raises:
        InputError: If the world has no room for the team or the items.
    """
    return ENGINES[scenario.engine].begun(scenario, seed, run)


def of(simulation: Stepped) -> Engine:
    """Return the engine of a run."""
    return ENGINES[simulation.scenario.engine]
