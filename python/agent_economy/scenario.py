"""What a job is: a scenario, read from a TOML file and checked as a whole."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from agent_economy import _core
from agent_economy._core import InputError

TEAM_SIZE_PATH = "robots.wanderer.count"
"""Path of the factor that a study of the classic engine varies."""


@dataclass(frozen=True)
class Merit:
    """Weights of a figure of merit; higher is better, so all are at most 0.

    Attributes:
        name: How scenarios name it.
        time_s: For each second of a run, capped.
        robots: For each robot.
        failed: For a failed run.
    """

    name: str
    time_s: float
    robots: float
    failed: float

    def score(
        self, time_s: NDArray[np.float64], robots: int, failed: NDArray[np.bool_]
    ) -> NDArray[np.float64]:
        """Return the merit of each of a team's runs; all arrays of shape (runs,)."""
        return self.time_s * time_s + self.robots * robots + self.failed * failed


@dataclass(frozen=True)
class Published:
    """Results of others, to show beside ours.

    Attributes:
        source: Where they stand.
        choice: The team size that they recommend.
        cap_s: Where they stopped; a time of this much is a failed run.
        times_s: The times of a team's runs, by team size.
    """

    source: str
    choice: int
    cap_s: float
    times_s: dict[int, list[float]]


@dataclass(frozen=True)
class Override:
    """A value put over what the file says; `origin` is how faults name it, such as --contact."""

    path: tuple[str, ...]
    value: str | float
    origin: str


@dataclass(frozen=True)
class Scenario:
    """Everything that does not change in a run, and what its study does.

    Attributes:
        name: The file's name without its ending.
        summary: One line for people.
        contact: What counts as finding an item.
        merit: How runs are scored.
        paints_per_s: Turns paints into seconds.
        cap_s: A run that takes longer has failed, and counts as this long.
        cap_paints: The last paint that is not beyond the cap.
        robots: Robots in a single run.
        runs: Runs of each team in a study.
        team_sizes: The teams that a study compares, ascending.
        published: Results of others, if the file has them.
    """

    name: str
    summary: str
    contact: str
    merit: Merit
    paints_per_s: float
    cap_s: float
    cap_paints: int
    robots: int
    runs: int
    team_sizes: tuple[int, ...]
    published: Published | None

    @classmethod
    def load(cls, file: str | Path, overrides: tuple[Override, ...] = ()) -> "Scenario":
        """Read a scenario from a file.

        Raises:
            InputError: If the file cannot be read or anything in it is wrong; all faults at once.
        """
        file = Path(file)
        try:
            text = file.read_text(encoding="utf-8")
        except OSError as error:
            message = f"{file}: cannot be read: {error.strerror}"
            raise InputError(message) from None
        except UnicodeDecodeError as error:
            message = (
                f"{file}: is not UTF-8 text: byte {error.start} is {error.object[error.start]:#x}"
            )
            raise InputError(message) from None
        return cls.loads(text, file=str(file), overrides=overrides)

    @classmethod
    def loads(
        cls, text: str, file: str = "scenario.toml", overrides: tuple[Override, ...] = ()
    ) -> "Scenario":
        """Read a scenario from TOML text; `file` is how faults name it.

        Raises:
            InputError: If anything in it is wrong; all faults at once.
        """
        changes = [(list(each.path), each.value, each.origin) for each in overrides]
        fields = _core.read_scenario(file, text, changes)
        published = fields.pop("published")
        return cls(
            name=Path(file).stem.strip(".") or "scenario",
            merit=Merit(**fields.pop("merit")),
            team_sizes=tuple(fields.pop("team_sizes")),
            published=published
            and Published(
                source=published["source"],
                choice=published["choice"],
                cap_s=published["cap_s"],
                times_s=dict(published["times_s"]),
            ),
            **fields,
        )
