"""What recordings hold of a run, by its engine."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, Protocol

from agent_economy.recording import classic_writer, metric_writer
from agent_economy.recording.classic_writer import ClassicMoments
from agent_economy.recording.file import File
from agent_economy.recording.metric_writer import MetricMoments
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.classic_simulation import ClassicSimulation
from agent_economy.runs.simulation import Simulation


class Moments(Protocol):
    """A run on its way into a file, as long as its scenario does not change."""

    @property
    def tick(self) -> int:
        """Of the moment that was written last."""

    @property
    def hash(self) -> int:
        """Of the moment that was written last."""

    def step(
        self,
        steps: int,
        percepts: Mapping[str, Percept] | None,
        commands: Mapping[str, Command] | None,
        time_ns: int,
        /,
    ) -> dict[str, Command]:
        """Take steps, and write what went into them."""

    def write(self, time_ns: int) -> None:
        """Write the run as it is now."""


class Engine(NamedTuple):
    """What one engine gives; its functions take runs of its own.

    Attributes:
        moments: Writes what stays as it is, and the first moment. It takes the file, the run, the
            names of robots whose percepts are recorded, those of items whose finds were told
            before, and the time.
        faults: What is wrong with the names of robots whose percepts are to be recorded.
    """

    moments: Callable[[File, Any, Sequence[str], set[str], int], Moments]
    faults: Callable[[Any, Sequence[str]], list[str]]


ENGINES: dict[type, Engine] = {
    Simulation: Engine(MetricMoments, metric_writer.faults),
    ClassicSimulation: Engine(ClassicMoments, classic_writer.faults),
}


def of(simulation: object) -> Engine | None:
    """Return the engine of a run; None if it is no run."""
    engines = (engine for kind, engine in ENGINES.items() if isinstance(simulation, kind))
    return next(engines, None)
