"""Writers of recordings, by engine."""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Protocol

from agent_economy.recording import classic_writer, metric_writer
from agent_economy.recording.classic_writer import ClassicMoments
from agent_economy.recording.clock import Clock
from agent_economy.recording.file import File
from agent_economy.recording.inputs import ExternalInputs
from agent_economy.recording.logged import Logged
from agent_economy.recording.metric_writer import MetricMoments
from agent_economy.recording.selection import Selection
from agent_economy.runs.brain import Command
from agent_economy.runs.classic_simulation import ClassicSimulation
from agent_economy.runs.simulation import Simulation


class Moments(Protocol):
    """Writes the steps of a run to a file until its scenario changes."""

    @property
    def tick(self) -> int:
        """Tick of the step written last."""

    @property
    def hash(self) -> int:
        """Hash of the step written last."""

    @property
    def decision_hash(self) -> int | None:
        """Hash of the decisions until then; None if they are not hashed."""

    def step(self, steps: int, inputs: ExternalInputs, /) -> dict[str, Command]:
        """Advance the simulation, and write its external inputs."""

    def log_events(self) -> None:
        """Write the events since the last call to the log, each at its own time."""

    def write(self) -> None:
        """Write the current step, and the events since the last call."""

    def close(self) -> None:
        """Collect no more events: nothing will be written."""


class Engine(NamedTuple):
    """The functions of an engine, which take its own runs.

    Attributes:
        moments: Writes the static topics and the first step. It takes the file, the run, the
            robots whose percepts are recorded, what is already in the log, and the times of
            steps.
        errors: Returns the errors of the names of robots whose percepts are to be recorded.
    """

    moments: Callable[[File, Any, Selection, Logged, Clock], Moments]
    errors: Callable[[Any, Sequence[str]], list[str]]


ENGINES: dict[type, Engine] = {
    Simulation: Engine(MetricMoments, metric_writer.errors),
    ClassicSimulation: Engine(ClassicMoments, classic_writer.errors),
}


def of(simulation: object) -> Engine | None:
    """Return the engine of a run; None if the object is not a run."""
    engines = (engine for kind, engine in ENGINES.items() if isinstance(simulation, kind))
    return next(engines, None)
