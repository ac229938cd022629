"""The runs of a study: every team, the same run numbers for all."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import _core, classic
from agent_economy._core import InputError
from agent_economy.scenario import TEAM_SIZE_PATH, Scenario

RUNS_PER_BLOCK = 5000
"""Runs between two progress reports."""


@dataclass(frozen=True)
class Progress:
    """How far a study is.

    Attributes:
        done: Runs done.
        total: Runs to do.
        robots: The team that ran last.
        seconds: Since the study began.
    """

    done: int
    total: int
    robots: int
    seconds: float

    @property
    def runs_per_s(self) -> float:
        """Runs a second so far."""
        return self.done / self.seconds if self.seconds > 0 else 0.0

    @property
    def seconds_left(self) -> float:
        """Seconds that the rest takes at the rate so far."""
        return (self.total - self.done) / self.runs_per_s if self.done else 0.0


@dataclass(frozen=True)
class Outcomes:
    """Outcomes of one team's runs 0, 1, ...: arrays of shape (runs,).

    Attributes:
        paints: When the last item was found; -1 = proven never.
        found: Items found by then or by the cap.
        collisions: Robot-decisions spent collided by then or by the cap.
        time_s: Seconds to the last find, at most the cap.
        failed: Whether the cap came first.
        merit: The scenario's figure of merit of each run; its mean is the team's.
    """

    paints: NDArray[np.int64]
    found: NDArray[np.int64]
    collisions: NDArray[np.int64]
    time_s: NDArray[np.float64]
    failed: NDArray[np.bool_]
    merit: NDArray[np.float64]


@dataclass(frozen=True)
class Runs:
    """All outcomes of a study, by team size."""

    scenario: Scenario
    seed: int
    teams: dict[int, Outcomes]

    def table(self) -> pa.Table:
        """Return a row a run, teams in ascending order."""
        return pa.concat_tables(team_table(robots, self.teams[robots]) for robots in self.teams)


def run_teams(
    scenario: Scenario, seed: int = 0, on_progress: Callable[[Progress], None] | None = None
) -> Runs:
    """Run every team of a scenario's study.

    Args:
        scenario: What to run.
        seed: 0 to 2^64 - 1. Run r places robot i of every team on the same cell.
        on_progress: Called after every block of runs.

    Raises:
        InputError: If the seed is out of range, or anything but the team size is varied.
    """
    if not scenario.team_sizes:
        paths = ", ".join(factor.path for factor in scenario.factors)
        message = f"study.vary: varies {paths}: must be {TEAM_SIZE_PATH} alone; not yet more"
        raise InputError(message)
    begin = time.monotonic()
    total = scenario.runs * len(scenario.team_sizes)
    teams = {}
    done = 0
    for robots in scenario.team_sizes:
        blocks = []
        for first_run in range(0, scenario.runs, RUNS_PER_BLOCK):
            runs = min(RUNS_PER_BLOCK, scenario.runs - first_run)
            blocks.append(run_block(scenario, robots, seed, first_run, runs))
            done += runs
            if on_progress:
                on_progress(Progress(done, total, robots, time.monotonic() - begin))
        paints, found, collisions = (np.concatenate(column) for column in zip(*blocks, strict=True))
        teams[robots] = outcomes(scenario, robots, paints, found, collisions)
    return Runs(scenario, seed, teams)


def run_block(
    scenario: Scenario, robots: int, seed: int, first_run: int, runs: int
) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.int64]]:
    """Return paints, found and collisions, each (runs,), of consecutive runs of one team."""
    return _core.replicate(
        robots,
        runs,
        contact=scenario.contact,
        cap_paints=scenario.cap_paints,
        seed=seed,
        first_run=first_run,
        threads=None,
    )


def outcomes(
    scenario: Scenario,
    robots: int,
    paints: NDArray[np.int64],
    found: NDArray[np.int64],
    collisions: NDArray[np.int64],
) -> Outcomes:
    """Return what a team's runs came to in seconds and merit."""
    failed = (paints < 0) | (paints > scenario.cap_paints)
    time_s = np.where(failed, scenario.cap_s, paints / scenario.paints_per_s)
    columns = {
        "time_s": time_s,
        "robots": np.full(len(paints), float(robots)),
        "failed": failed.astype(np.float64),
        "found": found.astype(np.float64),
        "collisions": collisions.astype(np.float64),
        "paints": np.where(paints < 0, np.inf, paints),
    }
    merit = scenario.merit.score(columns)
    return Outcomes(paints, found, collisions, time_s, failed, merit)


def team_table(robots: int, outcomes: Outcomes) -> pa.Table:
    """Return a row a run of one team."""
    runs = len(outcomes.paints)
    return pa.table(
        {
            TEAM_SIZE_PATH: np.full(runs, robots),
            "run": np.arange(runs),
            "paints": classic.or_null(outcomes.paints),
            "found": outcomes.found,
            "collisions": outcomes.collisions,
            "time_s": outcomes.time_s,
            "failed": outcomes.failed,
            "merit": outcomes.merit,
        }
    )
