"""The result of a selection."""

from dataclasses import dataclass

import numpy as np

from agent_economy import _core
from agent_economy.study.arguments import Floats
from agent_economy.study.equality import EqualByValue
from agent_economy.study.sampling.plan import SelectionPlan
from agent_economy.study.sampling.samples import Samples
from agent_economy.study.selection import (
    Elimination,
    Integers,
    eliminations,
    guarantee_text,
    leading,
)


@dataclass(frozen=True, eq=False)
class Selection(EqualByValue):
    """The best configuration, and estimates of all; two of them are equal if all values are.

    Attributes:
        best: Index of the selected configuration.
        runs: Number of runs per configuration; shape (k,).
        mean: Mean merit of each; shape (k,).
        lower: Lower bounds of the true means, shape (k,). All bounds hold simultaneously and at any
            time, with the stated confidence.
        upper: Upper bounds of the true means, in the same way.
        eliminations: The eliminated configurations, in the order of their elimination.
        survivors: The remaining configurations: only `best`, unless stopped.
        quarantined: Number of runs without a finite merit, which count as the worst; shape (k,).
        stopped: Whether the run budget was reached first; then there is no guarantee.
        guarantee: The guarantee in words.
    """

    best: int
    runs: Integers
    mean: Floats
    lower: Floats
    upper: Floats
    eliminations: tuple[Elimination, ...]
    survivors: tuple[int, ...]
    quarantined: Integers
    stopped: bool
    guarantee: str


def result(plan: SelectionPlan, procedure: _core.Procedure, samples: Samples) -> Selection:
    """Return the result of a procedure and its samples."""
    question, intervals = plan.question, [samples.interval(each) for each in range(plan.k)]
    return Selection(
        best=leading(procedure),
        runs=samples.runs,
        mean=np.array([each.value for each in intervals]),
        lower=np.array([each.low for each in intervals]),
        upper=np.array([each.high for each in intervals]),
        eliminations=eliminations(procedure),
        survivors=tuple(procedure.survivors.tolist()),
        quarantined=samples.quarantined,
        stopped=procedure.next() is not None,
        guarantee=guarantee_text(procedure, question.delta, plan.confidence, question.guarantee),
    )
