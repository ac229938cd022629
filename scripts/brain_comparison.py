"""Measure and draw docs/brain-comparison.md: how five brains search, with and without radio.

The measurements are in docs/brain-comparison/*.csv; the tables of the page, and the sentences about
them, are between `<!-- NAME -->` and `<!-- end -->`. Examples:

    python scripts/brain_comparison.py          run everything; write CSVs, pictures and page
    python scripts/brain_comparison.py --draw   only pictures and page, from the CSVs
    python scripts/brain_comparison.py --check  exit with 1 if pictures or page are stale

A sentence that the measurements no longer support is an error.
"""

import csv
import math
import sys
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass, fields
from functools import cache
from typing import Any, TypeVar, get_type_hints

import brain_claims
import numpy as np
from brain_measurements import Answered, Measurements, Step, Team
from numpy.typing import NDArray
from page import ROOT, Page, table
from plots import Z95, Axes, Row, Spec, line, page_of, panel, points, side_by_side, values

import agent_economy as ae
from agent_economy.study import select_best
from agent_economy.study.answer.any_answer import expect_best

PAGE = Page("brain-comparison")

TEAMS = (1, 2, 3, 4, 6, 8, 12, 16, 20)
RUNS = 400
"""Runs per brain and team size, all in the same worlds."""

SEED = 0

STUDY_SEEDS = range(3)
"""Each brain is studied with each: one study selects one of several teams that are about equal."""

STUDY_DELTA = 0.5
"""Indifference zone of these studies; with the scenarios' 0.2, they would take hours."""

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

STUDIED = [*ALONE, *(brain for brain in WITH_RADIO if brain.name != "lawnmower")]
"""Radio changes nothing for lawnmower, which the claims of the page verify."""

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


def main() -> None:
    """Measure, draw or check."""
    if not {"--check", "--draw"} & set(sys.argv[1:]):
        measure()
    try:
        PAGE.draw(lambda name: BLOCKS[name](), specifications())
    except brain_claims.ClaimError as error:
        sys.exit(
            f"docs/brain-comparison.md: {error}: change the sentence in scripts/brain_claims.py"
        )


# Measured.


def measure() -> None:
    """Run everything, and write what it gave."""
    PAGE.folder.mkdir(exist_ok=True)
    given = {brain: {robots: runs(brain, robots) for robots in TEAMS} for brain in BRAINS}
    write(
        "teams", Team, [team(brain, robots, given[brain][robots]) for brain, robots in each_team()]
    )
    write("steps", Step, [step(name, n, given) for name in STEPS for n in TEAMS])
    write("studies", Answered, (answered(brain, seed) for seed in STUDY_SEEDS for brain in STUDIED))


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


def answered(brain: SearchBrain, seed: int) -> Answered:
    """Return how many robots with a brain to send."""
    print(f"{brain.name} {brain.radio}: study {seed}", flush=True)
    answer = expect_best(ae.study.run(brain.scenario, seed=seed, delta=STUDY_DELTA))
    best = answer.results[answer.best]
    return Answered(
        brain=brain.name,
        radio=brain.radio,
        seed=seed,
        robots=int(best.values[COUNT]),
        time_s=short(best.time_s.value),
        failed=short(best.failed.value),
        merit=short(best.merit.value),
        runs=answer.runs,
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


@cache
def measurements() -> Measurements:
    """Return all measurements, by the names of the brains in the tables."""
    by_brain: dict[str, dict[int, Team]] = {label(brain): {} for brain in BRAINS}
    for each in teams():
        by_brain[label(SearchBrain(each.brain, each.radio))][each.robots] = each
    steps: dict[str, dict[int, Step]] = {name: {} for name in STEPS}
    for one in read("steps", Step):
        steps[one.step][one.robots] = one
    answers: dict[str, list[Answered]] = {label(brain): [] for brain in STUDIED}
    for answer in read("studies", Answered):
        answers[label(SearchBrain(answer.brain, answer.radio))].append(answer)
    return Measurements(by_brain, steps, {name: tuple(each) for name, each in answers.items()})


def studies() -> str:
    """Return the teams that the studies of each brain selected."""
    header = ["robots", "team size", "time, s", "failed", "merit", "runs"]
    lines = []
    for name, answers in measurements().studies.items():
        numbers = [
            spread([each.time_s for each in answers], "{:.1f}"),
            spread([100 * each.failed for each in answers], "{:.1f}") + "%",
            spread([each.merit for each in answers], "{:.2f}"),
            f"{sum(each.runs for each in answers) / len(answers):,.0f}",
        ]
        lines.append([name, brain_claims.votes(answers), *numbers])
    return table(header, lines)


def spread(numbers: list[float], form: str) -> str:
    """Return the mean and the standard deviation of some numbers."""
    return f"{form.format(np.mean(numbers))} ± {form.format(np.std(numbers, ddof=1))}"


def settings() -> str:
    """Return with which settings the brains were studied."""
    seeds = sorted({each.seed for each in read("studies", Answered)})
    return (
        f"Each brain's scenario was studied {len(seeds)} times, with the seeds {seeds[0]} to "
        f"{seeds[-1]}: 1 to 20 robots, merit equation-5.2, and an\nindifference zone `delta` of "
        f"{STUDY_DELTA:g}. Two of these studies are\n\n```\n"
        f"agent-economy study scenarios/search.toml --delta {STUDY_DELTA:g} --seed {seeds[0]}\n"
        f"agent-economy study scenarios/search-beliefs.toml --delta {STUDY_DELTA:g} --seed "
        f"{seeds[0]}\n```\n\nThe others set another seed or behaviour, or set "
        "`robots.rover.radio.range_m` to 0. Radio changes nothing for\n`lawnmower`, which was "
        "studied without."
    )


def guarantees() -> str:
    """Return the guarantee of the studies, which the program must still print."""
    (guarantee,) = {each.guarantee for each in read("studies", Answered)}
    # The selection of one of two numbers takes no time, and has the same guarantee.
    selection = select_best(
        lambda which, _, runs: np.repeat(which[:, None], runs, 1),
        2,
        bounds=[0, 1],
        delta=STUDY_DELTA,
        confidence=ALONE[0].scenario.confidence,
    )
    printed = selection.guarantee == guarantee
    brain_claims.verify(printed, f"the program prints {guarantee!r}")
    return f"> {guarantee}"


def claims(of: Callable[[Measurements], str]) -> Callable[[], str]:
    """Return what makes a block of sentences from the measurements."""
    return lambda: of(measurements())


BLOCKS: dict[str, Callable[[], str]] = {
    "short": claims(brain_claims.in_short),
    "helps": claims(brain_claims.helps),
    "does_not_help": claims(brain_claims.does_not_help),
    "settings": settings,
    "needed": claims(brain_claims.needed),
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
