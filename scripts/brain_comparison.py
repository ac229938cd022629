"""Measure and draw docs/brain-comparison.md: how five brains search, with and without radio.

The measurements are in docs/brain-comparison/*.csv; the tables of the page, and the sentences about
them, are between `<!-- NAME -->` and `<!-- end -->`. Examples:

    python scripts/brain_comparison.py          run everything; write CSVs, pictures and page
    python scripts/brain_comparison.py --draw   only pictures and page, from the CSVs
    python scripts/brain_comparison.py --check  exit with 1 if pictures or page are stale

A sentence that the measurements no longer support is an error.
"""

import sys
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from statistics import fmean
from typing import Any

import brain_claims
import numpy as np
from brain_measurements import Answered, Brain, Measurements, Step, Team
from measured import ROOT, Page, table
from plots import Axes, Row, Spec, connected, interval, page_of, panel, side_by_side
from scipy import stats

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

WANDERING = [{"kind": "cruise"}, {"kind": "avoid"}]
PLANS = ("lawnmower", "frontier", "bayesian_search")
"""Search behaviours; each replaces the first behaviour of scenarios/search-beliefs.toml."""


@dataclass(frozen=True)
class SearchBrain(Brain):
    """A brain that searches."""

    @property
    def scenario(self) -> ae.Scenario:
        """Return the search by robots with this brain."""
        if self.brain in PLANS:
            scenario = ae.Scenario.load(ROOT / "scenarios" / "search-beliefs.toml")
            plan = [{"kind": self.brain}, {"kind": "return_home"}, {"kind": "avoid"}]
            scenario = scenario.replace(BEHAVIOURS, plan)
        else:
            scenario = ae.Scenario.load(ROOT / "scenarios" / "search.toml")
        if self.brain == "wanderers":
            scenario = scenario.replace(BEHAVIOURS, WANDERING)
        return scenario if self.radio == "radio" else scenario.replace(RADIO, 0)


ALONE = [SearchBrain(name, "alone") for name in ("wanderers", "random_bounce", *PLANS)]
WITH_RADIO = [SearchBrain(name, "radio") for name in PLANS]
WANDERERS, BOUNCE, _, FRONTIER, BAYES = ALONE
LAWNMOWER_RADIO, FRONTIER_RADIO, BAYES_RADIO = WITH_RADIO
BRAINS = [*ALONE, *WITH_RADIO]
"""Wanderers and random_bounce send no messages, so radio makes no difference for them."""

STUDIED = [*ALONE, *(brain for brain in WITH_RADIO if brain.brain != "lawnmower")]
"""Radio changes nothing for lawnmower, which the claims of the page verify."""

STEPS = {
    "random_bounce vs wanderers": (WANDERERS, BOUNCE),
    "memory: frontier vs random_bounce": (BOUNCE, FRONTIER),
    "radio: frontier": (FRONTIER, FRONTIER_RADIO),
    "radio: bayesian_search": (BAYES, BAYES_RADIO),
    "rate: bayesian_search vs frontier": (FRONTIER_RADIO, BAYES_RADIO),
    "beliefs: bayesian_search vs lawnmower": (LAWNMOWER_RADIO, BAYES_RADIO),
}
"""The effect of each part: the brains before and after."""


def main() -> None:
    """Measure, draw or check."""
    if not {"--check", "--draw"} & set(sys.argv[1:]):
        measure()
    data = measurements()
    try:
        PAGE.draw(lambda name: BLOCKS[name](data), specifications(data))
    except brain_claims.ClaimError as error:
        sys.exit(
            f"docs/brain-comparison.md: {error}: change the sentence in scripts/brain_claims.py"
        )


# Measured.


def measure() -> None:
    """Run everything, and write what it gave."""
    PAGE.write("teams", Team, (team(brain, robots) for brain in BRAINS for robots in TEAMS))
    PAGE.write("steps", Step, (step(name, robots) for name in STEPS for robots in TEAMS))
    studies = (answered(brain, seed) for seed in STUDY_SEEDS for brain in STUDIED)
    PAGE.write("studies", Answered, studies)


@cache
def runs(brain: SearchBrain, robots: int) -> dict[str, Any]:
    """Return what each run of a team gave, by column."""
    given = ae.replicate(brain.scenario.replace(COUNT, robots), RUNS, SEED)
    return {
        "time_s": given["time_s"].to_numpy(),
        "failed": 1.0 - given["complete"].to_numpy(),
        "collisions": given["collisions"].to_numpy(),
        "energy_kj": given["energy_j"].to_numpy() / 1000,
    }


def team(brain: SearchBrain, robots: int) -> Team:
    """Return the means of a team's runs."""
    columns = runs(brain, robots).values()
    numbers = (part for each in columns for part in (fmean(each), stats.sem(each)))
    return Team(brain.brain, brain.radio, robots, RUNS, *numbers)


def step(name: str, robots: int) -> Step:
    """Return by how much one brain is sooner than another, world by world."""
    before, after = STEPS[name]
    sooner_s = runs(before, robots)["time_s"] - runs(after, robots)["time_s"]
    return Step(name, robots, fmean(sooner_s), stats.sem(sooner_s))


def answered(brain: SearchBrain, seed: int) -> Answered:
    """Return how many robots with a brain to send."""
    answer = expect_best(ae.study.run(brain.scenario, seed=seed, delta=STUDY_DELTA))
    best = answer.results[answer.best]
    return Answered(
        brain=brain.brain,
        radio=brain.radio,
        seed=seed,
        robots=int(best.values[COUNT]),
        time_s=best.time_s.value,
        failed=best.failed.value,
        merit=best.merit.value,
        runs=answer.runs,
        guarantee=answer.guarantee,
    )


def measurements() -> Measurements:
    """Return all measurements, by the names of the brains in the tables."""
    data = Measurements({}, {}, {})
    for team in PAGE.read("teams", Team):
        data.teams.setdefault(team.label, {})[team.robots] = team
    for step in PAGE.read("steps", Step):
        data.steps.setdefault(step.step, {})[step.robots] = step
    for answer in PAGE.read("studies", Answered):
        data.studies.setdefault(answer.label, []).append(answer)
    return data


# Tables.


def of_teams(data: Measurements, cell: Callable[[Team], str]) -> str:
    """Return a table with a row for each brain and a column for each team."""
    lines = ([name, *map(cell, own.values())] for name, own in data.teams.items())
    return table(["robots", *map(str, data.sizes)], lines)


def failures(each: Team) -> str:
    """Return the share of failures with its 95% interval (Wilson's, which suits shares near 0)."""
    tested = stats.binomtest(round(each.failed * each.runs), each.runs)
    low, high = tested.proportion_ci(method="wilson")
    return f"{each.failed:.0%} ({low:.0%} to {high:.0%})"


def steps(data: Measurements) -> str:
    """Return the effect of each part, in seconds."""
    lines = (
        [name, *(interval(each.sooner_s, each.error_s) for each in own.values())]
        for name, own in data.steps.items()
    )
    return table(["seconds sooner, by robots", *map(str, data.sizes)], lines)


def studies(data: Measurements) -> str:
    """Return the teams that the studies of each brain selected."""
    header = ["robots", "team size", "time, s", "failed", "merit", "runs"]
    lines = []
    for name, answers in data.studies.items():
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


def settings(data: Measurements) -> str:
    """Return with which settings the brains were studied."""
    seeds = sorted({each.seed for answers in data.studies.values() for each in answers})
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


def guarantees(data: Measurements) -> str:
    """Return the guarantee of the studies, which the program must still print."""
    (guarantee,) = {each.guarantee for answers in data.studies.values() for each in answers}
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


BLOCKS: dict[str, Callable[[Measurements], str]] = {
    "short": brain_claims.in_short,
    "helps": brain_claims.helps,
    "does_not_help": brain_claims.does_not_help,
    "settings": settings,
    "needed": brain_claims.needed,
    "times": lambda data: of_teams(data, lambda each: interval(each.time_s, each.time_error_s)),
    "failures": lambda data: of_teams(data, failures),
    "collisions": lambda data: of_teams(
        data, lambda each: interval(each.collisions, each.collisions_error, 2)
    ),
    "energy": lambda data: of_teams(
        data, lambda each: interval(each.energy_kj, each.energy_error_kj)
    ),
    "steps": steps,
    "studies": studies,
    "guarantees": guarantees,
}


# Pictures.


def specifications(data: Measurements) -> dict[str, Spec]:
    """Return each picture's specification by its name."""
    seconds, times = "mean time until all is found, s", (0.0, 120.0)
    return {
        "times": by_radio(data, seconds, times, lambda each: (each.time_s, each.time_error_s)),
        "collisions": by_radio(
            data,
            "collisions of a run",
            (0.0, 4.0),
            lambda each: (each.collisions, each.collisions_error),
        ),
    }


def by_radio(
    data: Measurements,
    title: str,
    domain: tuple[float, float],
    number: Callable[[Team], tuple[float, float]],
) -> Spec:
    """Return a number by the team's size: alone on the left, with radio on the right."""
    panels = []
    for words, radio in (("alone", "alone"), ("with radio", "radio")):
        # In this order a brain has the same colour on both sides.
        names = [Brain(name, radio).label for name in (*PLANS, "wanderers", "random_bounce")]
        own = [each for name in names for each in data.teams.get(name, {}).values()]
        some = [Row(each.brain, each.robots, *number(each), None) for each in own]
        axes = Axes("log", x_ticks=TEAMS, y_domain=domain, y_format="~r")
        panels.append(panel(connected(some), f"robots, {words}", title, width=300, axes=axes))
    return page_of(side_by_side(*panels))


if __name__ == "__main__":
    main()
