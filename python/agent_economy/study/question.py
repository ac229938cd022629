"""The questions of studies: what is recorded of each run, and what the answer promises."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy.scenario import Requirement, Scenario
from agent_economy.study.arguments import Floats, Guarantee

GOAL_COLUMNS = (
    "served",
    "served_twice",
    "waiting_s",
    "travel_s",
    "blocked_s",
    "service_s",
)
"""Columns that describe goals, of those that the simulator has: NaN in a quarantined run."""

CLEARANCE_COLUMNS = ("declared", "declared_not_clear", "stated_risk", "declared_s")
"""Columns that describe a lane to be cleared, in the same way."""


@dataclass(frozen=True)
class Best:
    """Which configuration has the best mean merit?

    Attributes:
        delta: Indifference zone, in units of merit.
        guarantee: "indifference" or "pgs", as in `select_best`.
    """

    delta: float
    guarantee: Guarantee

    quantity = "merit"
    """The column of what is recorded of each run."""

    part = 1 / 12
    """Part of the allowed error for the intervals of one quantity: see `Evidence`."""

    columns = ("time_s", "failed", "robots", "price")
    """Columns that an answer uses besides, of those that the simulator has."""

    def values(self, scenario: Scenario, columns: Mapping[str, Floats]) -> Floats:
        """Return the merit of each run; NaN for a quarantined one."""
        return scenario.merit.score(columns)

    def as_dict(self, confidence: float) -> dict[str, Any]:
        """Return the question as study.toml stores it."""
        return {"delta": self.delta, "confidence": confidence, "guarantee": self.guarantee}


@dataclass(frozen=True)
class Cheapest:
    """Which is the cheapest configuration that meets a requirement?

    Attributes:
        requirement: What a run must meet, and in which share of runs.
        cost: What the configuration costs, as an expression.
    """

    requirement: Requirement
    cost: str

    quantity = "met"
    """The column of what is recorded of each run."""

    part = 1.0
    """Part of the allowed error for the intervals of one quantity: there is no other."""

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns that an answer uses besides, of those that the simulator has."""
        each = ("time_s", "failed", "robots", "price", *self.requirement.columns)
        return tuple(dict.fromkeys(each))

    def values(self, scenario: Scenario, columns: Mapping[str, Floats]) -> Floats:  # noqa: ARG002
        """Return 1 for each run that meets the requirement, else 0; NaN for a quarantined one."""
        return self.requirement.met(columns)

    def as_dict(self, confidence: float) -> dict[str, Any]:
        """Return the question as study.toml stores it."""
        words = {"requirement": str(self.requirement), "cost": self.cost}
        return {**words, "confidence": confidence}


Question = Best | Cheapest
