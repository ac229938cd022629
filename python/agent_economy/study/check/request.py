"""A study that is requested, and the order of its checks."""

from dataclasses import dataclass

from agent_economy.scenario import Scenario
from agent_economy.scenario.validation import is_whole
from agent_economy.study import design, teams
from agent_economy.study.agents import StudyAgents
from agent_economy.study.arguments import FIRST_ANALYSIS_RUNS, Guarantee
from agent_economy.study.check.arguments import MAX_SEED, check_max_runs, check_question, raise_all
from agent_economy.study.check.expressions import (
    check_conditions,
    error_of,
    expression_errors,
    tolerance_errors,
)
from agent_economy.study.check.prices import price_errors
from agent_economy.study.engine import Engine

PART_OF_RANGE = 0.02
"""Default delta, as a part of the merit's range."""


@dataclass(frozen=True)
class StudyRequest:
    """The arguments of a study of a scenario; None selects the scenario's value or the default."""

    scenario: Scenario
    seed: int
    delta: float | None
    confidence: float | None
    guarantee: Guarantee | None
    runs: int | None
    max_runs: int | None
    finer: float | None = None
    agents: tuple[StudyAgents, ...] = ()

    @property
    def is_about_merit(self) -> bool:
        """Whether the question is the best by merit."""
        given = (self.delta, self.guarantee, self.runs) != (None, None, None)
        return self.scenario.requirement is None or given

    @property
    def used_confidence(self) -> float:
        """The confidence."""
        return self.scenario.confidence if self.confidence is None else self.confidence

    def delta_of(self, engine: Engine, *, is_new: bool) -> float:
        """Return the indifference zone."""
        delta = self.scenario.delta if self.delta is None else self.delta
        if delta is not None or not is_new:
            return 1.0 if delta is None else float(delta)
        limits = engine.merit_limits
        return PART_OF_RANGE * float(limits[:, 1].max() - limits[:, 0].min()) or 1.0

    def checked(self, *, is_new: bool) -> Engine:
        """Return the configurations that are compared, after all checks in this order.

        1. The arguments and the expressions; if one of them is wrong, also the conditions.
        2. The design, and which of its configurations are compared.
        3. The run budget, which must allow their first round.
        4. Of a new study: that each configuration is valid and has a cost; the conditions.

        Raises:
            InputError: If a check fails; it lists all errors of its step.
        """
        scenario = self.scenario
        raise_all(self._first_errors())
        points = teams.compared(scenario, self._points())
        engine = Engine(scenario, points, int(self.seed), agents=self.agents)
        compared = len(engine.configurations) if self.is_about_merit else 1
        check_max_runs(self.max_runs, self.runs, FIRST_ANALYSIS_RUNS * compared)
        if is_new and self.is_about_merit:
            _ = engine.merit_limits
        elif is_new:
            found = error_of(lambda: teams.costs(engine, scenario.cost))
            found = found or price_errors(scenario, engine.configurations)
            found += tolerance_errors(scenario)
            raise_all(found + error_of(lambda: check_conditions(scenario, engine)))
        return engine

    def _first_errors(self) -> list[str]:
        guarantee = self.guarantee or "indifference"
        found = error_of(
            lambda: check_question(
                seed=self.seed,
                delta=self.delta,
                confidence=self.used_confidence,
                guarantee=guarantee,
                runs=self.runs,
            )
        )
        found += expression_errors(self.scenario)
        if found and self.scenario.requirement is not None and is_whole(self.seed, 0, MAX_SEED):
            engine = Engine(self.scenario, self._points(), self.seed)
            found += error_of(lambda: check_conditions(self.scenario, engine))
        return found

    def _points(self) -> list[design.Values]:
        return design.points(self.scenario.factors, self.scenario.design, self.seed)
