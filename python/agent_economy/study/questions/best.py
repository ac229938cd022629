"""The question of the configuration with the best mean merit."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.scenario import Scenario
from agent_economy.study.answer import published
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.effort import efforts, remaining_runs
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.results import Ending, results
from agent_economy.study.answer.saturation import saturations
from agent_economy.study.answer.sensitivity import sensitivity
from agent_economy.study.answer.sentence import sentence
from agent_economy.study.answer.side_statements import SideStatements
from agent_economy.study.answer.verdict import verdict
from agent_economy.study.arguments import Floats, Guarantee
from agent_economy.study.engine import Engine
from agent_economy.study.progress import MAX_LEADERS, MAX_SHOWN
from agent_economy.study.selection import eliminations, guarantee_text, leading

ONE = "There is only one configuration"
ONLY = "{}, so nothing was selected; the intervals are valid."
FIXED = (
    "The selection carries no guarantee, because the number of runs was fixed beforehand; the "
    "intervals are valid."
)


@dataclass(frozen=True)
class Best:
    """Which configuration has the best mean merit?

    Attributes:
        delta: Indifference zone, in units of merit.
        guarantee: "indifference" or "pgs", as in `select_best`.
    """

    delta: float
    guarantee: Guarantee

    requirement = None
    quantity = "merit"
    columns = ("time_s", "failed", "robots", "price")
    part = 1 / 12
    typical = "merit"
    shown_leaders = slice(MAX_SHOWN)
    certifies = False
    counts_quarantined = False

    def as_dict(self, confidence: float) -> dict[str, Any]:
        """Return the question as study.toml stores it."""
        return {"delta": self.delta, "confidence": confidence, "guarantee": self.guarantee}

    def identities(self, scenario: Scenario, confidence: float) -> tuple[dict[str, Any], ...]:
        """Return what distinguishes it from other questions about the same runs."""
        return ({**self.as_dict(confidence), "merit": scenario.merit.name},)

    def procedure(self, engine: Engine, confidence: float, runs: int | None) -> _core.Procedure:
        """Return the procedure that selects the best, or that allots a fixed number of runs."""
        if runs is not None:
            return _core.equal_allocation(len(engine.configurations), runs)
        limits, delta, guarantee = self.limits(engine), self.delta, self.guarantee
        return _core.selection(limits, delta=delta, confidence=confidence, guarantee=guarantee)

    def sample(self, scenario: Scenario, columns: Mapping[str, Floats]) -> Floats:
        """Return the merit of each run; NaN for a quarantined one."""
        return scenario.merit.score(columns)

    def limits(self, engine: Engine) -> Floats:
        """Return the range of the merit of each configuration."""
        return engine.merit_limits

    def leaders(self, engine: Engine, procedure: _core.Procedure, sums: Floats) -> dict[int, None]:
        """Return the best of those that remain, the best first; `sums` of their merits."""
        return dict.fromkeys(leaders(procedure, sums))

    def remaining(
        self, procedure: _core.Procedure, sample: Callable[[int], Sample], confidence: float
    ) -> float:
        """Return the expected number of runs until the others are eliminated."""
        survivors = procedure.survivors.tolist()
        evidence = Evidence(tuple(map(sample, survivors)), confidence)
        best, rivals = survivors.index(leading(procedure)), len(procedure.runs) - 1
        return remaining_runs(evidence, best, self.delta, rivals)

    def conclude(
        self,
        engine: Engine,
        evidence: Evidence,
        procedure: _core.Procedure,
        runs: int | None,
        obstacle: str,
    ) -> Answer:
        """Return which team to send, with which guarantee, and further results."""
        ending = self.ending(evidence, procedure, obstacle, is_fixed=runs is not None)
        best, delta, scenario = ending.best, self.delta, engine.scenario
        found = results(evidence, ending, delta)
        side = SideStatements()
        saturated = side.make("saturations", lambda: saturations(evidence, best, delta))
        influences = side.make(
            "sensitivity", lambda: sensitivity(evidence, scenario.design, scenario.where)
        )
        predicted = None
        if runs is None:
            predicted = side.make("efforts", lambda: efforts(evidence, best, delta))
        theirs = side.make("published", lambda: published.results(scenario))
        return Answer(
            scenario=scenario,
            seed=engine.seed,
            verdict=verdict(scenario, ending, found, delta, evidence.confidence),
            sentence=sentence(scenario, delta, ending, found, has_prices=evidence.has_prices),
            guarantee=ending.guarantee,
            is_guaranteed=ending.is_guaranteed,
            delta=delta,
            confidence=evidence.confidence,
            best=best,
            results=found,
            saturations=saturated or (),
            sensitivity=influences,
            efforts=predicted or (),
            published=theirs or (),
            omissions=tuple(side.omissions),
        )

    def ending(
        self, evidence: Evidence, procedure: _core.Procedure, obstacle: str, *, is_fixed: bool
    ) -> Ending:
        """Return the end of a race, with its guarantee in words."""
        impossible = sum(not sample.is_possible for sample in evidence.samples)
        words = FIXED
        if len(evidence.samples) - impossible == 1:
            words = ONLY.format("Only one configuration can be run" if impossible else ONE)
        elif not is_fixed:
            words = guarantee_text(procedure, self.delta, evidence.confidence, self.guarantee)
        if impossible and len(evidence.samples) - impossible > 1:
            words += " Configurations that cannot be run were not compared."
        return Ending(
            leading(procedure),
            eliminations(procedure),
            words,
            not is_fixed and procedure.next() is None,
            obstacle,
        )


def leaders(procedure: _core.Procedure, sums: Floats) -> list[int]:
    """Return the configurations that remain with the best means; `sums` of their merits."""
    runs = procedure.runs
    sampled = procedure.survivors[runs[procedure.survivors] > 0]
    order = np.argsort(-sums[sampled] / runs[sampled], kind="stable")
    best: list[int] = sampled[order][:MAX_LEADERS].tolist()
    return best
