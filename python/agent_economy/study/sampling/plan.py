"""The question of a selection, and the runs that answer it."""

from dataclasses import dataclass

from agent_economy import _core
from agent_economy.study.questions.best import Best
from agent_economy.study.sampling.sampler import SampledRuns


@dataclass(frozen=True)
class SelectionPlan:
    """A selection that is requested; all of it is checked.

    Attributes:
        sampled: The runs.
        question: Which configuration is the best, and how that is guaranteed.
        confidence: Confidence of the guarantee.
        max_runs: Run budget of all configurations together; None for no limit.
    """

    sampled: SampledRuns
    question: Best
    confidence: float
    max_runs: int | None

    @property
    def k(self) -> int:
        """Number of configurations."""
        return len(self.sampled.limits)

    def procedure(self) -> _core.Procedure:
        """Return the procedure that requests the runs."""
        return _core.selection(
            self.sampled.limits,
            delta=self.question.delta,
            confidence=self.confidence,
            guarantee=self.question.guarantee,
        )
