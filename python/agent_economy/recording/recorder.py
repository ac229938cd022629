"""Records a run."""

from collections.abc import Mapping, Sequence
from io import BufferedWriter
from pathlib import Path
from typing import Self

from foxglove_schemas_protobuf.Log_pb2 import Log

from agent_economy._core import InputError
from agent_economy.recording import engines
from agent_economy.recording.clock import Clock
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import SECOND_NS, log
from agent_economy.recording.identity import write_change, write_end, write_files, write_identity
from agent_economy.recording.inputs import ExternalInputs
from agent_economy.recording.logged import Logged
from agent_economy.recording.selection import Selection, selection_of
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Source, validation

SUFFIX = ".mcap"
"""Suffix of the file names of recordings."""

FLUSH_S = 5.0
"""Simulated time that a kill of the process loses; shorter intervals make larger files."""


class Recording:
    """Records a run to an MCAP file, which Foxglove displays and `replay` replays.

    Use it as a context manager, and step the recording instead of the simulation.

    Attributes:
        simulation: The run; it can be inspected and changed between two steps.
    """

    simulation: Stepped

    def __init__(
        self,
        simulation: Stepped,
        path: str | Path | BufferedWriter,
        *,
        every: int = 1,
        percepts: Sequence[str] | Selection = (),
        flush_s: float = FLUSH_S,
    ) -> None:
        """Start a recording at the current step of the run; from then on, decisions are hashed.

        Args:
            simulation: The run, a `Simulation` or a `ClassicSimulation`, at its first step. Of a
                later start, only the changes of the scenario can be replayed, not other inputs.
            path: The file, NAME.mcap. It replaces an existing file, unless that is the recording
                of a drive, the scenario was read from it, or a program is writing it. Or an empty
                file that is open for writing, and stays open when the recording is closed.
            every: Number of steps per recorded step, 1 or more.
            percepts: Names of robots, KIND/INDEX, of which the percepts, commands and range scans
                are recorded in each step. None by default: those of all robots take about twenty
                times the space of everything else. Not available for the classic engine. A
                `Selection` also states how often.
            flush_s: Simulated time that a kill of the process loses; shorter times make larger
                files.

        Raises:
            InputError: If an argument is not allowed, or the file cannot be written.
        """
        selected = selection_of(percepts)
        stream = path if isinstance(path, BufferedWriter) else None
        given = Path(path.name) if isinstance(path, BufferedWriter) else path
        path = validation.path("path", given)
        self._engine = check(simulation, path, every, selected.robots)
        self.simulation = simulation
        self._every, self._selected = every, selected
        self._flush_ns = round(flush_s * SECOND_NS)
        self._clock = Clock(simulation.step_s)
        self._file = File(stream or path)
        self._flushed_ns = self._clock.time_ns(simulation.tick)
        self._changes = simulation.changes[:0]
        self._files: set[str] = set()
        self._logged = Logged()
        if simulation.decision_hash is None:
            simulation.hash_decisions()
        write_identity(self._file, simulation)
        self._write_scenario()
        # The file of a killed process must identify its run.
        self._file.flush()

    def step(
        self,
        steps: int = 1,
        *,
        percepts: Mapping[str, Percept] | None = None,
        observed: Mapping[str, Percept] | None = None,
        commands: Mapping[str, Command] | None = None,
    ) -> dict[str, Command]:
        """Advance as `step` of the simulation does, and record the steps.

        Raises:
            InputError: If an argument is not allowed (the classic engine takes no percepts or
                commands), the recording is closed, or the simulation was restored to an earlier
                step.
            RecordingError: If the file cannot be written. The recording is then closed.
        """
        self._check_simulation()
        inputs = ExternalInputs(percepts, observed, commands)
        if any(each is not None for each in inputs):
            return self._step(steps, inputs)
        validation.whole("steps", steps, 0)
        for _ in range(steps):
            tick = self.simulation.tick
            self._step(1, ExternalInputs())
            if self.simulation.tick == tick:  # a finished classic run does not advance
                break
        return {}

    def finish(self) -> Outcome:
        """Advance to the end of the run, and record all steps. Ctrl-C stops between two steps."""
        while not self.simulation.is_over:
            self.step()
        return self.simulation.outcome()

    def note(self) -> None:
        """Record the current step, if you step the simulation itself.

        Raises:
            InputError: If the recording is closed, or the simulation was restored to an earlier
                step.
        """
        self._check_simulation()
        if self.simulation.tick != self._moments.tick:
            self._moments.write()
        self._flush_if_due()

    def _flush_if_due(self) -> None:
        time_ns = self._clock.time_ns(self.simulation.tick)
        if time_ns - self._flushed_ns >= self._flush_ns:
            self._file.flush()
            self._flushed_ns = time_ns

    def write_json(self, topic: str, schema: str, message: object, time_s: float) -> None:
        """Add a message of the caller's own topic.

        Args:
            topic: The topic; none of those of the run.
            schema: Its JSON Schema, with a title.
            message: The message, which the schema allows.
            time_s: Its time since the start of the run.

        Raises:
            RecordingError: If the file cannot be written. The recording is then closed.
        """
        self._file.declare(topic, schema)
        self._file.write_json(topic, message, max(0, round(time_s * SECOND_NS)))

    def note_values(self, name: str, values: Mapping[str, str]) -> None:
        """Add metadata, and write it to the file at once."""
        self._file.note(name, values)
        self._file.flush()

    def close(self) -> None:
        """Record the current step and the outcome, and close the file."""
        try:
            if self._file.is_open:
                self._write_end()
        finally:
            self._moments.close()
            if self._file.is_open:
                self._file.close()

    def __enter__(self) -> Self:
        """Return the recording."""
        return self

    def __exit__(self, *_: object) -> None:
        """Close the recording, also after an exception."""
        self.close()

    def _write_end(self) -> None:
        self.note()
        last, outcome = self._moments, self.simulation.outcome()
        row = {"status": outcome.status, **outcome.row}
        self._file.write_json("/outcome", row, self._clock.time_ns(last.tick))
        write_end(self._file, last.tick, last.hash, last.decision_hash)

    def _step(self, steps: int, inputs: ExternalInputs) -> dict[str, Command]:
        self._check_simulation()
        tick = self.simulation.tick
        try:
            return self._moments.step(steps, inputs)
        finally:
            if self.simulation.tick > tick:
                self._note_step()

    def _note_step(self) -> None:
        """Record the current step if it is due, but the events of every step."""
        if self.simulation.tick % self._every == 0:
            self.note()
        else:
            self._moments.log_events()
            self._flush_if_due()  # inputs and the messages of the caller are written in each step

    def _check_simulation(self) -> None:
        """Check that the simulation continues from the recorded step, and write its changes."""
        if not self._file.is_open:
            message = (
                "the recording is closed: step the simulation itself, or start a new recording"
            )
            raise InputError(message)
        simulation, seen = self.simulation, self._changes
        if simulation.tick < self._moments.tick or simulation.changes[: len(seen)] != seen:
            message = (
                "the simulation was restored to an earlier step: it must continue from the "
                "last recorded step"
            )
            raise InputError(message)
        if simulation.changes != seen:
            self._moments.log_events()
            self._moments.close()
            self._write_scenario()

    def _write_scenario(self) -> None:
        """Write the changes, newly referenced files, and the scene."""
        simulation = self.simulation
        self._clock.set_step(simulation.tick, simulation.step_s)
        time_ns = self._clock.time_ns(simulation.tick)
        files = simulation.scenario.source.files
        write_files(self._file, files, self._files)
        self._files |= files.keys()
        for change in simulation.changes[len(self._changes) :]:
            write_change(self._file, change)
            message = f"{change.path} = {change.value!r}"
            self._file.write("/log", log(time_ns, Log.INFO, "scenario", message), time_ns)
        self._changes = simulation.changes
        self._moments = self._engine.moments(
            self._file, simulation, self._selected, self._logged, self._clock
        )


def check(simulation: Stepped, path: Path, every: int, percepts: Sequence[str]) -> engines.Engine:
    """Check the arguments of a recording, and return the engine of the run.

    Raises:
        InputError: If an argument is not allowed; it lists all errors.
    """
    engine = engines.of(simulation)
    errors = []
    if path.suffix != SUFFIX:
        errors.append(f"{path}: the name of a recording must end in {SUFFIX}")
    elif engine and is_read_from(simulation.scenario.source, path):
        errors.append(f"{path}: must not be a file that the scenario was read from")
    if engine:
        errors += engine.errors(simulation, percepts)
    runs = "a Simulation or a ClassicSimulation"
    errors += validation.errors_unless(engine is not None, "simulation", simulation, runs)
    errors += validation.errors_unless(
        validation.is_whole(every, 1), "every", every, "a whole number, 1 or more"
    )
    if errors or engine is None:
        raise InputError("\n".join(errors))
    return engine


def is_read_from(source: Source, path: Path) -> bool:
    """Return whether a file is that of a scenario, or one that it refers to."""
    own = Path(source.file)
    files = (own, *(own.parent / name for name in source.files))
    return path.exists() and any(file.exists() and file.samefile(path) for file in files)
