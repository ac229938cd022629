"""Studies in memory: a race over simulated runs, without a plan and a store."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from agent_economy import Scenario, _core
from agent_economy.study.answer import published
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.effort import efforts
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.results import Ending, results
from agent_economy.study.answer.saturation import saturations
from agent_economy.study.answer.sensitivity import sensitivity
from agent_economy.study.answer.sentence import sentence
from agent_economy.study.answer.side_statements import SideStatements
from agent_economy.study.answer.verdict import verdict
from agent_economy.study.selection import Elimination, drive, guarantee_text, leading

Floats = NDArray[np.float64]
Values = dict[str, float | str]
Columns = dict[str, Floats]
Simulator = Callable[[Values, int, int], Columns]

WANDERERS = "robots.wanderer.count"
CLASSIC = Path(__file__).resolve().parents[2] / "scenarios/classic.toml"
LONGEST_S = 120.0
WEIGHTS = {"time_s": -0.03, "robots": -0.2, "failed": -5.0}


def classic(values: Values, first_run: int, runs: int) -> Columns:
    """Return runs of the classic simulator."""
    configuration = Scenario.load(CLASSIC).configuration(values)
    block = _core.run_block([configuration], seed=0, first_run=first_run, runs=runs, threads=None)
    return {name: block[name][0] for name in ("time_s", "failed", "robots")}


def synthetic(values: Values, first_run: int, runs: int) -> Columns:
    """Return runs of a synthetic search: larger teams are faster to a point, mixes slower."""
    robots, mix = float(values.get("robots.rover.count", 4)), float(values.get("mix", 0))
    one, two = np.random.default_rng(first_run).uniform(size=(2, runs))
    times = 10 + 0.4 * mix + 60 / robots**0.5 - (260 * (1 + 0.03 * mix) / robots) * np.log(one)
    failed = (two < 0.25 ** min(robots, 6)) | (times > LONGEST_S)
    return {
        "time_s": np.where(failed, LONGEST_S, times),
        "failed": failed * 1.0,
        "robots": np.full(runs, robots),
    }


def merit(columns: Columns) -> Floats:
    """Return the merit of each run, as in the classic scenario."""
    return sum((weight * columns[name] for name, weight in WEIGHTS.items()), np.zeros(1))


def limits(robots: float) -> dict[str, tuple[float, float]]:
    """Return the bounds of the columns of a configuration."""
    worst = WEIGHTS["time_s"] * LONGEST_S + WEIGHTS["failed"]
    price = WEIGHTS["robots"] * robots
    return {
        "merit": (price + worst, price),
        "time_s": (0.0, LONGEST_S),
        "failed": (0.0, 1.0),
        "robots": (robots, robots),
    }


def study(
    configurations: list[Values], simulator: Simulator, delta: float = 0.05, runs: int | None = None
) -> tuple[Answer, Evidence]:
    """Return the answer and evidence of a race, or of `runs` runs per configuration."""
    blocks: list[list[Columns]] = [[] for _ in configurations]

    def block(index: int, first_run: int, count: int) -> Floats:
        columns = simulator(configurations[index], first_run, count)
        columns["merit"] = merit(columns)
        blocks[index].append(columns)
        return columns["merit"]

    def sample(
        indices: NDArray[np.int64], first_run: int, count: int
    ) -> tuple[Floats, NDArray[np.int64]]:
        merits = np.stack([block(index, first_run, count) for index in indices.tolist()])
        return merits, np.zeros(len(merits), dtype=np.int64)

    teams = [float(simulator(each, 0, 1)["robots"][0]) for each in configurations]
    bounds = np.array([limits(robots)["merit"] for robots in teams])
    procedure = _core.selection(bounds, delta=delta, confidence=0.95, guarantee="indifference")
    if runs is None:
        for _ in drive(procedure, sample):
            pass
    else:
        sample(np.arange(len(configurations)), 0, runs)
    samples = tuple(
        Sample(
            values,
            {name: np.concatenate([each[name] for each in made]) for name in made[0]},
            limits(robots),
            quarantined=0,
        )
        for values, made, robots in zip(configurations, blocks, teams, strict=True)
    )
    evidence = Evidence(samples, 0.95)
    if runs is None:
        gone = tuple(Elimination(*each) for each in procedure.eliminations)
        words = guarantee_text(procedure, delta, 0.95, "indifference")
        ending = Ending(leading(procedure), gone, words, is_guaranteed=True)
    else:
        best = int(np.argmax([sample.mean("merit") for sample in samples]))
        ending = Ending(
            best, (), "No guarantee: the number of runs was fixed.", is_guaranteed=False
        )
    return conclude(evidence, ending, delta), evidence


def conclude(evidence: Evidence, ending: Ending, delta: float = 0.05) -> Answer:
    """Return the answer that follows from evidence."""
    scenario = Scenario.load(CLASSIC)
    found = results(evidence, ending, delta)
    return Answer(
        scenario=scenario,
        seed=0,
        verdict=verdict(scenario, ending, found, delta, evidence.confidence),
        sentence=sentence(scenario, delta, ending, found, has_prices=False),
        guarantee=ending.guarantee,
        is_guaranteed=ending.is_guaranteed,
        delta=delta,
        confidence=evidence.confidence,
        best=ending.best,
        results=found,
        saturations=saturations(evidence, ending.best, delta),
        sensitivity=SideStatements().make("sensitivity", lambda: sensitivity(evidence)),
        efforts=efforts(evidence, ending.best, delta),
        published=published.results(scenario),
    )
