"""Replays a recorded run and verifies that it is reproduced."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Protocol

from agent_economy._core import InputError
from agent_economy.build import own_build
from agent_economy.recording.fields import hash_text
from agent_economy.recording.identity import Identity
from agent_economy.recording.reading import Point, Recorded, named, read
from agent_economy.runs import factory
from agent_economy.runs.external import ExternalBody
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.scenario import Scenario, validation


class InputsByTick(Protocol):
    """External inputs of steps, as keyword arguments of `Simulation.step`, such as a dict."""

    def get(self, tick: int, default: Mapping[str, Any], /) -> Mapping[str, Any]:
        """Return the inputs of a step; it is called with ticks that never decrease."""


@dataclass(frozen=True)
class Replay:
    """The result of replaying a recorded run.

    Attributes:
        scenario: The initial scenario.
        seed: Seed of all random numbers.
        run: Run number.
        program: The version of the program that recorded it.
        engine: The hash of the sources of the engine that recorded it, 16 hexadecimal digits; None
            if it is unknown.
        is_complete: Whether the file is complete; a truncated file is compared up to its end, a
            damaged one up to the damage.
        tick: Tick of the last compared state; of a drive, that after its last whole step.
        hash: Hash of that state in the replay: 64 bits, hexadecimal.
        mismatch_tick: Tick of the first recorded state that the replay does not reproduce; None if
            it reproduces all.
        mismatch: What differs there: "state", "decisions" (the percepts and commands until then) or
            "decisions and state"; of a drive also "readings", if the recorded lines do not give
            them, "percepts", if the readings do not, "setpoints" or "percepts and setpoints". None
            if nothing differs.
        outcome: The outcome of the replay.
        external: The bodies that were external from the start, by robot name.
        lines: Number of lines of robots from which the readings were made again; None if the
            recording is not of a drive.
        readings: Number of recorded readings, from which the percepts were made again; 0 if an
            earlier version recorded lines only, None if the recording is not of a drive.
        damaged_tick: Tick from which on the file is damaged; None if it is not. Nothing after it
            is compared.
    """

    scenario: Scenario
    seed: int
    run: int
    program: str
    engine: str | None
    is_complete: bool
    tick: int
    hash: str
    mismatch_tick: int | None
    mismatch: str | None
    outcome: Outcome
    external: Mapping[str, ExternalBody] = field(default_factory=dict)
    lines: int | None = None
    readings: int | None = None
    damaged_tick: int | None = None

    @property
    def agrees(self) -> bool:
        """Whether the replay reproduces all recorded states and decisions."""
        return self.mismatch_tick is None


def replay(path: str | Path, *, verify: bool = True) -> Replay:
    """Replay a recorded run from its file alone. Ctrl-C stops it between two steps.

    Args:
        path: A recording. A truncated file is compared up to its end, a damaged one up to the
            damage.
        verify: Whether to refuse a recording of another build of this program, which may give
            another run. Without it, such a recording is replayed and compared all the same.

    Raises:
        InputError: If the file cannot be read, is damaged before its first state, is not a
            recording of a run, contains a scenario that this version does not accept, or is of
            another build.
    """
    path = validation.path("path", path)
    identity, recorded = read(path)
    with named(path):
        if verify:
            check_build(identity)
        begun = identity.scenario, identity.seed, identity.run
        simulation = factory.create(*begun, identity.external)
        return compared(simulation, identity, recorded)


def check_build(identity: Identity) -> None:
    """Check that a run was recorded by this build.

    Raises:
        InputError: If it was not.
    """
    if identity.build != own_build():
        message = (
            f"was recorded by another build of this program ({identity.build}), this one is "
            f"{own_build()}: install that build to verify it, or replay it with --no-verify "
            "(verify=False) to compare it all the same"
        )
        raise InputError(message)


def compared(simulation: Stepped, identity: Identity, recorded: Recorded) -> Replay:
    """Replay a run, and compare it with the recorded states and decisions."""
    mismatch_tick, mismatch = None, None
    for point in recorded.points:
        changes = recorded.changes[: point.changes]
        for _ in replay_steps(simulation, simulation.step, changes, recorded.inputs, point.tick):
            pass
        if simulation.decision_hash is None and point.decisions is not None:
            # The recorded hash may have begun before the recording.
            simulation.hash_decisions(int(point.decisions, 16))
        if mismatch is None and (mismatch := difference(simulation, point)):
            mismatch_tick = point.tick
    return Replay(
        scenario=identity.scenario,
        seed=identity.seed,
        run=identity.run,
        program=identity.build.program,
        engine=identity.build.engine,
        is_complete=recorded.is_complete,
        tick=simulation.tick,
        hash=hash_text(simulation.hash),
        mismatch_tick=mismatch_tick,
        mismatch=mismatch,
        outcome=simulation.outcome(),
        external=identity.external,
        damaged_tick=recorded.damaged_tick,
    )


def difference(simulation: Stepped, point: Point) -> str | None:
    """Return what of a run differs from a recorded point, in words; None if nothing does."""
    own = simulation.decision_hash
    differ = {
        "decisions": own is not None and point.decisions not in (None, hash_text(own)),
        "state": hash_text(simulation.hash) != point.hash,
    }
    return " and ".join(what for what, differs in differ.items() if differs) or None


def replay_steps(
    simulation: Stepped,
    step: Callable[..., object],
    changes: Sequence[Change],
    inputs: InputsByTick,
    until: int,
) -> Iterator[int]:
    """Replay a run up to a tick or to its end; yield each tick that it reaches.

    Args:
        simulation: The run, which is advanced.
        step: Advances it, as `Simulation.step` does.
        changes: All changes of the recorded run, in order; those still missing are made.
        inputs: The external inputs by tick, as keyword arguments of `step`.
        until: The last tick.
    """
    while True:
        tick = simulation.tick
        while (made := len(simulation.changes)) < len(changes) and changes[made].tick <= tick:
            simulation.change(changes[made].path, changes[made].value)
        if tick >= until:
            return
        step(1, **inputs.get(tick, {}))
        if simulation.tick == tick:  # a finished classic run does not advance
            return
        yield simulation.tick
