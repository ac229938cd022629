"""Measure and draw docs/brain-comparison.md: how five brains search, with and without radio.

The measurements are in docs/brain-comparison/*.csv; the tables of the page are between
`<!-- NAME -->` and `<!-- end -->`. Examples:

    python scripts/brain_comparison.py          run everything; write CSVs, pictures and page
    python scripts/brain_comparison.py --draw   only pictures and page, from the CSVs
    python scripts/brain_comparison.py --check  exit with 1 if pictures or page are stale
"""

import csv
import math
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from functools import cache
from typing import Any, TypeVar, get_type_hints

import numpy as np
from numpy.typing import NDArray
from page import ROOT, Page, table
from plots import Z95, Axes, Row, Spec, line, page_of, panel, points, side_by_side, values

import agent_economy as ae

PAGE = Page("brain-comparison")

TEAMS = (1, 2, 3, 4, 6, 8, 12, 16, 20)
RUNS = 400
"""Runs per brain and team size, all in the same worlds."""

SEED = 0

COUNT = "robots.rover.count"
BEHAVIOURS = "robots.rover.brain.behaviours"
RADIO = "robots.rover.radio.range_m"

WANDERERS = [{"kind": "cruise"}, {"kind": "avoid"}]
PLANS = ("lawnmower", "frontier", "bayesian_search")
"""Search behaviours; each replaces the first behaviour of scenarios/search-beliefs.toml."""

Kind = TypeVar("Kind")

Column = NDArray[np.float64]
Runs = dict[str, Column]
"""Outcomes of the runs of a team size, by column."""


@dataclass(frozen=True)
class SearchBrain:
    """A brain, alone or with radio."""

    name: str
    radio: str

    @property
    def scenario(self) -> ae.Scenario:
        """Return the search by robots with this brain."""
        if self.name in PLANS:
            scenario = ae.Scenario.load(ROOT / "scenarios" / "search-beliefs.toml")
            plan = [{"kind": self.name}, {"kind": "return_home"}, {"kind": "avoid"}]
            scenario = scenario.replace(BEHAVIOURS, plan)
        else:
            scenario = ae.Scenario.load(ROOT / "scenarios" / "search.toml")
        if self.name == "wanderers":
            scenario = scenario.replace(BEHAVIOURS, WANDERERS)
        return scenario if self.radio == "radio" else scenario.replace(RADIO, 0)


ALONE = [SearchBrain(name, "alone") for name in ("wanderers", "random_bounce", *PLANS)]
WITH_RADIO = [SearchBrain(name, "radio") for name in PLANS]
BRAINS = [*ALONE, *WITH_RADIO]
"""Wanderers and random_bounce send no messages, so radio makes no difference for them."""

STEPS = {
    "random_bounce vs wanderers": (
        SearchBrain("wanderers", "alone"),
        SearchBrain("random_bounce", "alone"),
    ),
    "memory: frontier vs random_bounce": (
        SearchBrain("random_bounce", "alone"),
        SearchBrain("frontier", "alone"),
    ),
    "radio: frontier": (SearchBrain("frontier", "alone"), SearchBrain("frontier", "radio")),
    "radio: bayesian_search": (
        SearchBrain("bayesian_search", "alone"),
        SearchBrain("bayesian_search", "radio"),
    ),
    "rate: bayesian_search vs frontier": (
        SearchBrain("frontier", "radio"),
        SearchBrain("bayesian_search", "radio"),
    ),
    "beliefs: bayesian_search vs lawnmower": (
        SearchBrain("lawnmower", "radio"),
        SearchBrain("bayesian_search", "radio"),
    ),
}
"""The effect of each part: the brains before and after."""


@dataclass(frozen=True)
class Team:
    """Results of a team size: means, each with its standard error."""

    brain: str
    radio: str
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


@dataclass(frozen=True)
class Step:
    """How much sooner one brain is than another in the same worlds."""

    step: str
    robots: int
    sooner_s: float
    error_s: float


@dataclass(frozen=True)
class Answered:
    """The answer of a study of a brain's team size."""

    brain: str
    radio: str
    best: str
    time_s: float
    failed: float
    merit: float
    merit_low: float
    merit_high: float
    runs: int
    delta: float
    confidence: float
    guarantee: str


def main() -> None:
    """Measure, draw or check."""
    if not {"--check", "--draw"} & set(sys.argv[1:]):
        measure()
    PAGE.draw(lambda name: TABLES[name](), specifications())


# Measured.


def measure() -> None:
    """Run everything, and write what it gave."""
    PAGE.folder.mkdir(exist_ok=True)
    given = {brain: {robots: runs(brain, robots) for robots in TEAMS} for brain in BRAINS}
    write(
        "teams", Team, [team(brain, robots, given[brain][robots]) for brain, robots in each_team()]
    )
    write("steps", Step, [step(name, n, given) for name in STEPS for n in TEAMS])
    write("studies", Answered, map(answered, BRAINS))


def each_team() -> Iterator[tuple[SearchBrain, int]]:
    """Yield each brain with each team."""
    return ((brain, robots) for brain in BRAINS for robots in TEAMS)


def runs(brain: SearchBrain, robots: int) -> Runs:
    """Return what each run of a team gave."""
    print(f"{brain.name} {brain.radio}: {robots}", flush=True)
    given = ae.replicate(brain.scenario.replace(COUNT, robots), RUNS, SEED)
    return {
        "time_s": given["time_s"].to_numpy().astype(np.float64),
        "failed": 1.0 - given["complete"].to_numpy().astype(np.float64),
        "collisions": given["collisions"].to_numpy().astype(np.float64),
        "energy_kj": given["energy_j"].to_numpy() / 1000,
    }


def team(brain: SearchBrain, robots: int, given: Runs) -> Team:
    """Return the means of a team's runs."""
    numbers = (part for column in given.values() for part in (mean(column), error(column)))
    return Team(brain.name, brain.radio, robots, RUNS, *numbers)


def step(name: str, robots: int, given: dict[SearchBrain, dict[int, Runs]]) -> Step:
    """Return by how much one brain is sooner than another, world by world."""
    before, after = STEPS[name]
    sooner = given[before][robots]["time_s"] - given[after][robots]["time_s"]
    return Step(name, robots, mean(sooner), error(sooner))


def answered(brain: SearchBrain) -> Answered:
    """Return how many robots with a brain to send."""
    print(f"{brain.name} {brain.radio}: study", flush=True)
    answer = ae.study.run(brain.scenario, seed=SEED)
    best = answer.results[answer.best]
    return Answered(
        brain=brain.name,
        radio=brain.radio,
        best=str(best.values[COUNT]),
        time_s=short(best.time_s.value),
        failed=short(best.failed.value),
        merit=short(best.merit.value),
        merit_low=short(best.merit.low),
        merit_high=short(best.merit.high),
        runs=answer.runs,
        delta=answer.delta,
        confidence=answer.confidence,
        guarantee=answer.guarantee,
    )


def mean(column: Column) -> float:
    """Return a mean, with six digits."""
    return short(math.fsum(column) / len(column))


def error(column: Column) -> float:
    """Return the standard error of a mean, with six digits."""
    middle = math.fsum(column) / len(column)
    squares = math.fsum((column - middle) ** 2)
    return short(math.sqrt(squares / (len(column) - 1) / len(column)))


def short(value: float) -> float:
    """Return a number with six digits."""
    return float(f"{value:.6g}")


def write(name: str, kind: type, rows: Iterable[Any]) -> None:
    """Write rows of a kind as CSV."""
    with (PAGE.folder / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        names = [field.name for field in fields(kind)]
        writer = csv.DictWriter(file, names, lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)


def read(name: str, kind: Callable[..., Kind]) -> tuple[Kind, ...]:
    """Return the rows of a CSV."""
    types = get_type_hints(kind)
    with (PAGE.folder / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return tuple(
            kind(**{key: types[key](value) for key, value in line.items()})
            for line in csv.DictReader(file)
        )


# Tables.


@cache
def teams() -> tuple[Team, ...]:
    """Return the results of all team sizes."""
    return read("teams", Team)


def of_teams(cell: Callable[[Team], str]) -> str:
    """Return a table with a row for each brain and a column for each team."""
    lines = []
    for brain in BRAINS:
        own = [each for each in teams() if (each.brain, each.radio) == (brain.name, brain.radio)]
        lines.append([label(brain), *map(cell, own)])
    return table(["robots", *map(str, TEAMS)], lines)


def label(brain: SearchBrain) -> str:
    """Return what the page calls a brain."""
    return f"{brain.name}, radio" if brain.radio == "radio" else brain.name


def interval(value: float, error: float, digits: int = 1) -> str:
    """Return a number with its 95% interval."""
    return f"{value:.{digits}f} ± {Z95 * error:.{digits}f}"


def failures(each: Team) -> str:
    """Return the share of failures with its 95% interval (Wilson's, which suits shares near 0)."""
    square = Z95**2 / each.runs
    middle = (each.failed + square / 2) / (1 + square)
    spread = each.failed * (1 - each.failed) + square / 4
    half = Z95 * math.sqrt(spread / each.runs) / (1 + square)
    low, high = max(0.0, middle - half), min(1.0, middle + half)
    return f"{each.failed:.0%} ({low:.0%} to {high:.0%})"


def steps() -> str:
    """Return the effect of each part, in seconds."""
    lines = []
    for name in STEPS:
        own = [each for each in read("steps", Step) if each.step == name]
        lines.append([name, *(interval(each.sooner_s, each.error_s) for each in own)])
    return table(["seconds sooner, by robots", *map(str, TEAMS)], lines)


def studies() -> str:
    """Return the best team of each brain."""
    header = ["", "send", "time, s", "failed", "merit, with all intervals at once at 95%"]
    header += ["runs"]
    lines = []
    for each in read("studies", Answered):
        merit = f"{each.merit:.2f} ({each.merit_low:.2f} to {each.merit_high:.2f})"
        brain = label(SearchBrain(each.brain, each.radio))
        numbers = [each.best, f"{each.time_s:.1f}", f"{each.failed:.1%}", merit]
        lines.append([brain, *numbers, f"{each.runs:,}"])
    return table(header, lines)


def guarantees() -> str:
    """Return the guarantees of the studies."""
    guarantees = dict.fromkeys(each.guarantee for each in read("studies", Answered))
    return "\n\n".join(f"> {guarantee}" for guarantee in guarantees)


TABLES: dict[str, Callable[[], str]] = {
    "times": lambda: of_teams(lambda each: interval(each.time_s, each.time_error_s)),
    "failures": lambda: of_teams(failures),
    "collisions": lambda: of_teams(
        lambda each: interval(each.collisions, each.collisions_error, 2)
    ),
    "energy": lambda: of_teams(lambda each: interval(each.energy_kj, each.energy_error_kj)),
    "steps": steps,
    "studies": studies,
    "guarantees": guarantees,
}


# Pictures.


def specifications() -> dict[str, Spec]:
    """Return each picture's specification by its name."""
    seconds = "mean time until all is found, s"
    return {
        "times": by_radio(seconds, lambda each: (each.time_s, each.time_error_s), (0.0, 120.0)),
        "collisions": by_radio(
            "collisions of a run", lambda each: (each.collisions, each.collisions_error), (0.0, 4.0)
        ),
    }


def by_radio(
    title: str, number: Callable[[Team], tuple[float, float]], domain: tuple[float, float]
) -> Spec:
    """Return a number by the team's size: alone on the left, with radio on the right."""
    panels = []
    for words, radio in (("alone", "alone"), ("with radio", "radio")):
        # In this order a brain has the same colour on both sides.
        names = (*PLANS, "wanderers", "random_bounce")
        own = [
            each for name in names for each in teams() if (each.brain, each.radio) == (name, radio)
        ]
        some = [Row(each.brain, each.robots, *number(each), None) for each in own]
        layers = [{**line(), "data": {"values": [values(row) for row in some]}}, *points(some)]
        axes = Axes("log", x_ticks=TEAMS, y_domain=domain, y_format="~r")
        panels.append(panel(layers, f"robots, {words}", title, width=300, axes=axes))
    return page_of(side_by_side(*panels))


if __name__ == "__main__":
    main()
