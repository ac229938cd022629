"""The configurations that a progress report shows."""

import numpy as np

from agent_economy import _core
from agent_economy.study.answer.requirement_results import Status
from agent_economy.study.arguments import Floats
from agent_economy.study.plan import Plan
from agent_economy.study.progress import Leader
from agent_economy.study.question import Cheapest
from agent_economy.study.selection import Integers

MAX_LEADERS = 50
"""Maximum number of configurations with intervals in a progress report."""


def leaders(plan: Plan, procedure: _core.Procedure, sums: Floats) -> tuple[Leader, ...]:
    """Return the leading configurations that have runs; `sums` are those of their merits.

    These are the best by merit of those that remain, the best first. With a requirement, they are
    the dearest of all, the cheapest first: cheaper ones were refuted long before.
    """
    runs = procedure.runs
    if isinstance(plan.question, Cheapest):
        sampled = np.flatnonzero(runs)
        shown = sampled[np.argsort(plan.costs[sampled], kind="stable")][-MAX_LEADERS:]
        known = statuses(plan, procedure, shown)
    else:
        sampled = procedure.survivors[runs[procedure.survivors] > 0]
        shown = sampled[np.argsort(-sums[sampled] / runs[sampled], kind="stable")][:MAX_LEADERS]
        known = [None] * len(shown)
    rows = zip(shown, runs[shown], sums[shown] / runs[shown], known, strict=True)
    return tuple(Leader(int(each), int(count), float(mean), of) for each, count, mean, of in rows)


def statuses(plan: Plan, procedure: _core.Procedure, shown: Integers) -> list[Status | None]:
    """Return what is known of configurations in a study of a requirement."""
    certified = set(procedure.certified.tolist())
    refuted = {configuration for configuration, _, _ in procedure.eliminations}
    selected = procedure.selected
    limit = np.inf if selected is None else plan.costs[selected]

    def status(configuration: int) -> Status:
        if configuration in certified:
            return "certified"
        if configuration in refuted:
            return "refuted"
        return "open" if plan.costs[configuration] < limit else "not needed"

    return [status(each) for each in shown.tolist()]
