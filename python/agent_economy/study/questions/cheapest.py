"""The question of the cheapest configuration that meets a requirement."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.scenario import Requirement, Scenario
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import Known, RequirementEnding, results
from agent_economy.study.answer.requirement_words import RequirementWords
from agent_economy.study.arguments import Floats
from agent_economy.study.engine import Engine
from agent_economy.study.progress import MAX_LEADERS, MAX_SHOWN
from agent_economy.study.teams import costs


@dataclass(frozen=True)
class Cheapest:
    """Which is the cheapest configuration that meets a requirement?

    Attributes:
        requirement: What a run must meet, and in which share of runs.
        cost: What the configuration costs, as an expression.
    """

    requirement: Requirement
    cost: str

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
        words = {"requirement": str(self.requirement), "cost": self.cost}
        return {**words, "confidence": confidence}

    def words(self, scenario: Scenario, confidence: float) -> dict[str, Any]:
        """Return what distinguishes it from other questions about the same runs."""
        return self.as_dict(confidence)

    def procedure(self, engine: Engine, confidence: float, runs: int | None) -> _core.Procedure:
        """Return the procedure that certifies configurations, and refutes cheaper ones."""
        return _core.requirement(
            costs(engine, self.cost),
            probability=self.requirement.probability,
            tolerance=self.requirement.tolerance,
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
        words = RequirementWords(self.requirement, self.cost, found, evidence.confidence, ending)
        return RequirementAnswer(
            scenario=engine.scenario,
            seed=engine.seed,
            verdict=words.verdict(),
            sentence=words.sentence(),
            guarantee=words.guarantee(),
            is_guaranteed=ending.is_over,
            confidence=evidence.confidence,
            requirement=self.requirement,
            cost=self.cost,
            selected=ending.selected,
            results=found,
        )
