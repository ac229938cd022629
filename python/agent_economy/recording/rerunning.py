"""Taking a recorded run again, to see whether the same comes of it."""

from dataclasses import dataclass
from pathlib import Path

from agent_economy import given
from agent_economy.outcome import Outcome
from agent_economy.recording.reading import Point, Recorded, read
from agent_economy.scenario import Scenario
from agent_economy.simulation import Simulation


@dataclass(frozen=True)
class Rerun:
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


def rerun(path: str | Path) -> Rerun:
    """Take a recorded run again, from its file alone; Ctrl-C stops it between two steps.

    Args:
        path: A file that `Recording` wrote; one that is cut is compared as far as it goes.

    Raises:
        InputError: If the file cannot be read, is damaged, is no recording of a run, or this
            version does not take its scenario any more.
    """
    identity, recorded = read(given.path("path", path))
    simulation = Simulation(identity.scenario, identity.seed, identity.run)
    differs_at = None
    for point in recorded.points:
        go_to(simulation, point, recorded)
        if differs_at is None and f"{simulation.hash:016x}" != point.hash:
            differs_at = point.tick
    return Rerun(
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


def go_to(simulation: Simulation, point: Point, recorded: Recorded) -> None:
    """Step and change a run until it is where a state was recorded."""
    for change in recorded.changes[len(simulation.changes) : point.changes]:
        step_to(simulation, change.tick, recorded)
        simulation.change(change.path, change.value)
    step_to(simulation, point.tick, recorded)


def step_to(simulation: Simulation, tick: int, recorded: Recorded) -> None:
    """Step a run, with what came into it from outside."""
    while simulation.tick < tick:
        simulation.step(1, **recorded.inputs.get(simulation.tick, {}))
