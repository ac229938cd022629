"""A run on its way into a file."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Self

from foxglove_schemas_protobuf.Log_pb2 import Log

from agent_economy._core import InputError
from agent_economy.recording import engines
from agent_economy.recording.clock import Clock
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import SECOND_NS, log
from agent_economy.recording.identity import write_change, write_end, write_files, write_identity
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Source, validation

ENDING = ".mcap"
"""Of the names of recordings."""

FLUSH_NS = 5 * SECOND_NS
"""What is simulated in this time is lost if the process is killed; shorter takes more room."""


class Recording:
    """A run on its way into a file in MCAP, which Foxglove shows and `replay` takes again.

    Use it as a context manager, and step it instead of the simulation.

    Attributes:
        simulation: The run; between two steps it can be looked at and changed.
    """

    simulation: Stepped

    def __init__(
        self,
        simulation: Stepped,
        path: str | Path,
        *,
        every: int = 1,
        percepts: Sequence[str] = (),
    ) -> None:
        """Begin a recording, with the run as it is now.

        Args:
            simulation: The run, a `Simulation` or a `ClassicSimulation`; at its beginning, or what
                came before cannot be taken again but for its changes.
            path: The file, NAME.mcap; one that is there is written anew, but for one that the
                scenario was read from.
            every: Steps from one recorded moment to the next, 1 or more.
            percepts: Names of robots, KIND/INDEX, of which all is recorded that their brains
                perceive and want, and their range scans, in every step. None by default: those of
                all robots take some twenty times the room of all the rest. Robots of the classic
                engine have none.

        Raises:
            InputError: If an argument is not allowed, or the file cannot be written.
        """
        chosen = validation.texts("percepts", percepts, "a list of robots' names")
        path = validation.path("path", path)
        self._engine = check(simulation, path, every, chosen)
        self.simulation = simulation
        self._every, self._chosen = every, chosen
        self._clock = Clock(simulation.step_s)
        self._file = File(path)
        self._flushed_ns = self._clock.time_ns(simulation.tick)
        self._changes = simulation.changes[:0]
        self._files: set[str] = set()
        self._found: set[str] = set()
        write_identity(self._file, simulation)
        self._take_in_scenario()
        # Whoever finds the file of a killed process can see which run it was.
        self._file.flush()

    def step(
        self,
        steps: int = 1,
        *,
        percepts: Mapping[str, Percept] | None = None,
        commands: Mapping[str, Command] | None = None,
    ) -> dict[str, Command]:
        """Take steps as `step` of the simulation does, and record them.

        Raises:
            InputError: If anything is not allowed, as percepts and commands for robots of the
                classic engine, the recording is closed, or the simulation was put back to an
                earlier moment.
            RecordingError: If the disk takes no more; the recording is closed then.
        """
        self._keep_up()
        if percepts is not None or commands is not None:
            return self._step(steps, percepts, commands)
        validation.check(validation.is_whole(steps, 0), "steps", steps, "a whole number, 0 or more")
        for _ in range(steps):
            tick = self.simulation.tick
            self._step(1, None, None)
            if self.simulation.tick == tick:  # a classic run that is over stands
                break
        return {}

    def finish(self) -> Outcome:
        """Take steps until the run is over, and record them; Ctrl-C stops between two."""
        while not self.simulation.is_over:
            self.step()
        return self.simulation.outcome()

    def note(self) -> None:
        """Record the run as it is now, for whoever steps the simulation itself.

        Raises:
            InputError: If the recording is closed, or the simulation was put back to an earlier
                moment.
        """
        self._keep_up()
        time_ns = self._clock.time_ns(self.simulation.tick)
        if self.simulation.tick != self._moments.tick:
            self._moments.write(time_ns)
        if time_ns - self._flushed_ns >= FLUSH_NS:
            self._file.flush()
            self._flushed_ns = time_ns

    def close(self) -> None:
        """Record the last moment and the outcome so far, and close the file."""
        if not self._file.is_open:
            return
        try:
            self.note()
            last, outcome = self._moments, self.simulation.outcome()
            row = {"status": outcome.status, **outcome.row}
            self._file.write_json("/outcome", row, self._clock.time_ns(last.tick))
            write_end(self._file, last.tick, last.hash)
        finally:
            if self._file.is_open:
                self._file.close()

    def __enter__(self) -> Self:
        """Return the recording."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close it, whatever has happened."""
        self.close()

    def _step(
        self,
        steps: int,
        percepts: Mapping[str, Percept] | None,
        commands: Mapping[str, Command] | None,
    ) -> dict[str, Command]:
        self._keep_up()
        tick = self.simulation.tick
        try:
            return self._moments.step(steps, percepts, commands, self._clock.time_ns(tick))
        finally:
            if self.simulation.tick > tick and self.simulation.tick % self._every == 0:
                self.note()

    def _keep_up(self) -> None:
        """Take in what was done to the simulation since the last step."""
        if not self._file.is_open:
            message = "the recording is closed: step the simulation itself, or record it anew"
            raise InputError(message)
        simulation, seen = self.simulation, self._changes
        if simulation.tick < self._moments.tick or simulation.changes[: len(seen)] != seen:
            message = "the simulation was put back: must go on from where it was recorded last"
            raise InputError(message)
        if simulation.changes != seen:
            self._take_in_scenario()

    def _take_in_scenario(self) -> None:
        """Write what was changed, the files that came with it, and the scene as it now is."""
        simulation = self.simulation
        self._clock.go_on(simulation.tick, simulation.step_s)
        time_ns = self._clock.time_ns(simulation.tick)
        files = simulation.scenario.source.files
        write_files(self._file, files, self._files)
        self._files |= files.keys()
        for change in simulation.changes[len(self._changes) :]:
            write_change(self._file, change)
            words = f"{change.path} = {change.value!r}"
            self._file.write("/log", log(time_ns, Log.INFO, "scenario", words), time_ns)
        self._changes = simulation.changes
        self._moments = self._engine.moments(
            self._file, simulation, self._chosen, self._found, time_ns
        )


def check(simulation: Stepped, path: Path, every: int, percepts: Sequence[str]) -> engines.Engine:
    """See to it that arguments are allowed, and return what is recorded of such runs.

    Raises:
        InputError: If one is not; all faults at once.
    """
    engine = engines.of(simulation)
    faults = []
    if path.suffix != ENDING:
        faults.append(f"{path}: a recording's name must end in {ENDING}")
    elif engine and is_read_from(simulation.scenario.source, path):
        faults.append(f"{path}: must be another file than what the scenario is read from")
    if engine:
        faults += engine.faults(simulation, percepts)
    runs = "a Simulation or a ClassicSimulation"
    faults += validation.errors_unless(engine is not None, "simulation", simulation, runs)
    faults += validation.errors_unless(
        validation.is_whole(every, 1), "every", every, "a whole number, 1 or more"
    )
    if faults or engine is None:
        raise InputError("\n".join(faults))
    return engine


def is_read_from(source: Source, path: Path) -> bool:
    """Return whether a file is a scenario's own, or one that it names."""
    own = Path(source.file)
    files = (own, *(own.parent / name for name in source.files))
    return path.exists() and any(file.exists() and file.samefile(path) for file in files)
