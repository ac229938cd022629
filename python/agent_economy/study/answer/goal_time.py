"""Where the time of a goal goes: its parts, in the mean over the goals that were served."""

from dataclasses import dataclass

import numpy as np

from agent_economy.study.answer.evidence import Sample

GOAL_COLUMNS = (
    "served",
    "served_twice",
    "waiting_s",
    "travel_s",
    "blocked_s",
    "service_s",
)
"""Columns that describe goals, of those that the simulator has: NaN in a quarantined run."""

PARTS = ("waiting_s", "travel_s", "blocked_s", "service_s")
"""The columns of the parts, each a mean over the goals served in a run."""


@dataclass(frozen=True)
class GoalTime:
    """The goals served in a run, and the parts of the time from the issue of a goal to its service.

    Attributes:
        served: Mean number of goals served in a run.
        served_twice: Mean number of them that several robots served.
        waiting_s: From the issue of the goal until its robot sets out.
        travel_s: From there to its arrival, without the time in which it stood.
        blocked_s: Time in which it stood under way.
        service_s: From its arrival until the goal is served.
    """

    served: float
    served_twice: float
    waiting_s: float
    travel_s: float
    blocked_s: float
    service_s: float

    @property
    def total_s(self) -> float:
        """Time from the issue of a goal until it is served."""
        return self.waiting_s + self.travel_s + self.blocked_s + self.service_s


def goal_time(sample: Sample) -> GoalTime | None:
    """Return where the time of a goal goes in a configuration; None if no goal was served.

    Runs count by the goals that they served; quarantined runs are left out.
    """
    columns = sample.columns
    if not set(GOAL_COLUMNS) <= columns.keys():
        return None
    is_outcome = np.isfinite([columns[name] for name in GOAL_COLUMNS]).all(axis=0)
    is_outcome &= columns.get("quarantined", np.zeros(sample.runs)) == 0
    served = columns["served"][is_outcome]
    if not served.any():
        return None
    waiting_s, travel_s, blocked_s, service_s = (
        float(np.average(columns[name][is_outcome], weights=served)) for name in PARTS
    )
    return GoalTime(
        served=float(served.mean()),
        served_twice=float(columns["served_twice"][is_outcome].mean()),
        waiting_s=waiting_s,
        travel_s=travel_s,
        blocked_s=blocked_s,
        service_s=service_s,
    )


def in_words(time: GoalTime) -> str:
    """Return where the time of a goal goes: "a goal is served 86 s after its issue ..."."""
    return (
        f"a goal is served {time.total_s:,.3g} s after its issue on average: "
        f"waiting {share(time.waiting_s, time)}, travel {share(time.travel_s, time)}, "
        f"blocked {share(time.blocked_s, time)}, service {share(time.service_s, time)}."
    )


def share(part_s: float, time: GoalTime) -> str:
    """Return the share of a part of the time of a goal."""
    return f"{part_s / time.total_s if time.total_s else 0.0:.0%}"
