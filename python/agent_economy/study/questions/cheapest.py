"""The question of the cheapest configuration that meets a requirement."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np

from agent_economy import _core
from agent_economy.scenario import Requirement, Scenario
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import (
    Known,
    RequirementEnding,
    RequirementResult,
    results,
)
from agent_economy.study.answer.requirement_words import RequirementWords
from agent_economy.study.arguments import Floats
from agent_economy.study.engine import Engine
from agent_economy.study.progress import MAX_LEADERS, MAX_SHOWN
from agent_economy.study.teams import costs

FINER = 0.25
"""The next smaller tolerance, as a part of one."""


def finer_than(tolerance: float) -> float:
    """Return the tolerance up to which cheaper teams are decided after another one."""
    return float(f"{FINER * tolerance:.12g}")


@dataclass(frozen=True)
class Cheapest:
    """Which is the cheapest configuration that meets a requirement?

    Attributes:
        requirement: What a run must meet, and in which share of runs.
        cost: What the configuration costs, as an expression.
        finer: A smaller tolerance, up to which cheaper configurations are decided afterwards; None
            to stop at that of the requirement.
    """

    requirement: Requirement
    cost: str
    finer: float | None = None

    delta = None
    guarantee = None
    quantity = "met"
    part = 1.0
    typical = "time_s"
    shown_leaders = slice(-MAX_SHOWN, None)
    certifies = True
    counts_quarantined = True

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns that an answer uses besides: also those of the conditions."""
        each = ("time_s", "failed", "robots", "price", *self.requirement.columns)
        return tuple(dict.fromkeys(each))

    def as_dict(self, confidence: float) -> dict[str, Any]:
        """Return the question as study.toml stores it."""
        words: dict[str, Any] = {"requirement": str(self.requirement), "cost": self.cost}
        if self.finer is not None:
            words["finer"] = self.finer
        return {**words, "confidence": confidence}

    def identities(self, scenario: Scenario, confidence: float) -> tuple[dict[str, Any], ...]:
        """Return what distinguishes it from other questions about the same runs.

        A finer tolerance is a second question: which of both is answered depends on the runs.
        """
        first = replace(self, finer=None).as_dict(confidence)
        return (first,) if self.finer is None else (first, self.as_dict(confidence))

    def decided(self, reached: float) -> Self:
        """Return the question that continues until cheaper ones are decided.

        Args:
            reached: The tolerance at which it is answered; a smaller one that is not stays.
        """
        if self.finer is not None and self.finer < reached:
            return self
        return replace(self, finer=finer_than(reached))

    def procedure(self, engine: Engine, confidence: float, runs: int | None) -> _core.Procedure:
        """Return the procedure that certifies configurations, and refutes cheaper ones."""
        return self._search(engine, confidence, self.finer).procedure()

    def _search(
        self, engine: Engine, confidence: float, finer: float | None
    ) -> _core.RequirementSearch:
        return _core.RequirementSearch(
            costs(engine, self.cost),
            probability=self.requirement.probability,
            tolerance=self.requirement.tolerance,
            finer=finer,
            confidence=confidence,
        )

    def sample(self, scenario: Scenario, columns: Mapping[str, Floats]) -> Floats:
        """Return 1 for each run that meets the requirement, else 0; NaN for a quarantined one."""
        return self.requirement.met(columns)

    def limits(self, engine: Engine) -> Floats:
        """Return the range of a share for each configuration."""
        return np.tile([0.0, 1.0], (len(engine.configurations), 1))

    def leaders(self, engine: Engine, procedure: _core.Procedure, sums: Floats) -> dict[int, Known]:
        """Return the dearest that have runs, the cheapest first: cheaper ones are long refuted."""
        cost, sampled = costs(engine, self.cost), np.flatnonzero(procedure.runs)
        shown = sampled[np.argsort(cost[sampled], kind="stable")][-MAX_LEADERS:]
        state = RequirementEnding.of(procedure, cost)
        return {index: state.status(index) for index in shown.tolist()}

    def remaining(
        self, procedure: _core.Procedure, sample: Callable[[int], Sample], confidence: float
    ) -> None:
        """Return None: the number of runs depends on shares that are not known before."""

    def conclude(
        self,
        engine: Engine,
        evidence: Evidence,
        procedure: _core.Procedure,
        runs: int | None,
        obstacle: str,
    ) -> RequirementAnswer:
        """Return the cheapest team that is certified, and what is known of the others."""
        ending = RequirementEnding.of(procedure, costs(engine, self.cost), obstacle)
        found = results(self.requirement, evidence, ending)
        known, confidence = self._known(ending), evidence.confidence
        left = self._runs_to_decide(engine, confidence, ending, found)
        words = RequirementWords(known, self.cost, found, confidence, ending, left)
        return RequirementAnswer(
            scenario=engine.scenario,
            seed=engine.seed,
            verdict=words.verdict(),
            sentence=words.sentence(),
            guarantee=words.guarantee(),
            is_guaranteed=ending.is_over,
            confidence=evidence.confidence,
            requirement=known,
            cost=self.cost,
            selected=ending.selected,
            results=found,
            runs_to_decide=left,
        )

    def _known(self, ending: RequirementEnding) -> Requirement:
        """Return the requirement with the tolerance at which the promise holds."""
        if self.finer is None or not ending.is_finest:
            return self.requirement
        return replace(self.requirement, tolerance=self.finer)

    def _runs_to_decide(
        self,
        engine: Engine,
        confidence: float,
        ending: RequirementEnding,
        found: Sequence[RequirementResult],
    ) -> int | None:
        """Return about how many runs decide the cheaper ones that may meet it; None if none may."""
        limit = math.inf if ending.selected is None else found[ending.selected].cost
        cheaper = [each for each in found if each.cost < limit and each.met]
        if not any(each.status == "may meet" for each in cheaper):
            return None
        is_stopped = self.finer is not None and not ending.is_finest
        finer = self.finer if is_stopped else finer_than(self._known(ending).tolerance)
        search = self._search(engine, confidence, finer)
        left = (
            search.runs_to_decide(each.met.value, each.runs) - each.runs
            for each in cheaper
            if each.met
        )
        return max(1, sum(left))
