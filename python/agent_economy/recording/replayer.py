"""Taking a recorded run again, to see whether the same comes of it."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy.recording.identity import Identity
from agent_economy.recording.reading import Recorded, named, read
from agent_economy.runs import factory
from agent_economy.runs.outcome import Outcome
from agent_economy.runs.stepped import Change, Stepped
from agent_economy.scenario import Scenario, validation


@dataclass(frozen=True)
class Replay:
    """A recorded run, taken again.

    Attributes:
        scenario: What the run began with.
        seed: Of all chance.
        run: Its number.
        program: The version that recorded it.
        is_whole: Whether the file has its end; of one that is cut, what is there was compared.
        tick: Steps to the last state that was compared.
        hash: Of that state, as it is now: 64 bits, hexadecimal.
        differs_at: Steps to the first recorded state that is not the same now; None if all are.
        outcome: What the run has given.
    """

    scenario: Scenario
    seed: int
    run: int
    program: str
    is_whole: bool
    tick: int
    hash: str
    differs_at: int | None
    outcome: Outcome

    @property
    def agrees(self) -> bool:
        """Whether every recorded state came again."""
        return self.differs_at is None


def replay(path: str | Path) -> Replay:
    """Take a recorded run again, from its file alone; Ctrl-C stops it between two steps.

    Args:
        path: A file that `Recording` wrote; one that is cut is compared as far as it goes.

    Raises:
        InputError: If the file cannot be read, is damaged, is no recording of a run, or this
            version does not take its scenario any more.
    """
    path = validation.path("path", path)
    identity, recorded = read(path)
    with named(path):
        simulation = factory.create(identity.scenario, identity.seed, identity.run)
        return compared(simulation, identity, recorded)


def compared(simulation: Stepped, identity: Identity, recorded: Recorded) -> Replay:
    """Take a run again, and compare it with what was recorded."""
    differs_at = None
    for point in recorded.points:
        changes = recorded.changes[: point.changes]
        for _ in replay_steps(simulation, simulation.step, changes, recorded.inputs, point.tick):
            pass
        if differs_at is None and f"{simulation.hash:016x}" != point.hash:
            differs_at = point.tick
    return Replay(
        scenario=identity.scenario,
        seed=identity.seed,
        run=identity.run,
        program=identity.program,
        is_whole=recorded.is_whole,
        tick=simulation.tick,
        hash=f"{simulation.hash:016x}",
        differs_at=differs_at,
        outcome=simulation.outcome(),
    )


def replay_steps(
    simulation: Stepped,
    step: Callable[..., object],
    changes: Sequence[Change],
    inputs: Mapping[int, Mapping[str, Any]],
    until: int,
) -> Iterator[int]:
    """Take a run again up to a tick, or as far as it goes; yield each tick that has been come to.

    Args:
        simulation: The run, where it is.
        step: What steps it, as `Simulation.step` does.
        changes: All of its changes, in order; those that it does not have yet are made.
        inputs: What came into it from outside, by the tick, as `step` takes it.
        until: The tick.
    """
    while True:
        tick = simulation.tick
        while (made := len(simulation.changes)) < len(changes) and changes[made].tick <= tick:
            simulation.change(changes[made].path, changes[made].value)
        if tick >= until:
            return
        step(1, **inputs.get(tick, {}))
        if simulation.tick == tick:  # a classic run that is over stands
            return
        yield simulation.tick
