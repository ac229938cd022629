"""What docs/brain-comparison.md is about: the rows of its CSVs, by brain."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Brain:
    """A brain, alone or with radio."""

    brain: str
    radio: str

    @property
    def label(self) -> str:
        """Return what the page calls it."""
        return f"{self.brain}, radio" if self.radio == "radio" else self.brain


@dataclass(frozen=True)
class Team(Brain):
    """Results of a team size: means, each with its standard error."""

    robots: int
    runs: int
    time_s: float
    time_error_s: float
    failed: float
    failed_error: float
    collisions: float
    collisions_error: float
    energy_kj: float
    energy_error_kj: float

    @property
    def results(self) -> tuple[float, ...]:
        """Return the means."""
        return self.time_s, self.failed, self.collisions, self.energy_kj


@dataclass(frozen=True)
class Step:
    """How much sooner one brain is than another in the same worlds."""

    step: str
    robots: int
    sooner_s: float
    error_s: float


@dataclass(frozen=True)
class Answered(Brain):
    """The answer of a study of a brain's team size."""

    seed: int
    robots: int
    time_s: float
    failed: float
    merit: float
    runs: int
    guarantee: str


@dataclass(frozen=True)
class Measurements:
    """What the page is about; brains are named as in its tables.

    Attributes:
        teams: Results of each brain, by number of robots.
        steps: Effect of each part, by number of robots.
        studies: Answers of each brain's studies.
    """

    teams: dict[str, dict[int, Team]]
    steps: dict[str, dict[int, Step]]
    studies: dict[str, list[Answered]]

    @property
    def sizes(self) -> list[int]:
        """Return the team sizes."""
        return list(next(iter(self.teams.values())))

    def time_s(self, brain: str, robots: int) -> float:
        """Return a brain's mean time."""
        return self.teams[brain][robots].time_s

    def place(self, brain: str, robots: int, among: Iterable[str]) -> int:
        """Return how many brains of a list are at least as fast, itself included."""
        own_s = self.time_s(brain, robots)
        return sum(self.time_s(other, robots) <= own_s for other in among)

    def spread_s(self, robots: int) -> float:
        """Return the time between the best and the worst brain."""
        times_s = [self.time_s(brain, robots) for brain in self.teams]
        return max(times_s) - min(times_s)
