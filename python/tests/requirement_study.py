"""Studies of a requirement on the runs of a false simulator."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from agent_economy import Scenario, study
from agent_economy.study import RequirementAnswer
from agent_economy.study.plan import Plan
from agent_economy.study.run_block import Columns, RunBlock

TEAM = "robots.wanderer.count"

LATE_S = 60.0
"""Runs of the false simulator take this long if they do not meet the requirement."""

REQUIRE = """
[require]
all = ["time_s <= 50"]
probability = 0.9
tolerance = 0.05
"""

RISING = {1: 0.2, 2: 0.6, 3: 0.8, 4: 0.98, 5: 0.99, 6: 1.0}
"""Shares of runs that meet the requirement, by team size."""


def required(classic_toml: Path, more: str = REQUIRE, vary: str = "1..6") -> Scenario:
    text = classic_toml.read_text("utf-8") + more
    return Scenario.loads(text).replace(f"study.vary.{TEAM}", vary)


def simulated(plan: Plan, shares: dict[int, float]) -> Any:
    """Return a simulator whose runs meet the requirement in these shares, by team size."""

    def compute(block: RunBlock) -> Columns:
        columns: Columns = {
            column.name: np.zeros((len(block.configurations), block.runs))
            for column in plan.engine.columns
        }
        for row, configuration in enumerate(block.configurations):
            size = int(plan.configurations[configuration][TEAM])
            numbers = np.arange(block.first_run, block.first_run + block.runs)
            # Common random numbers: the same for all teams.
            uniform = np.array([np.random.default_rng(int(each)).random() for each in numbers])
            columns["time_s"][row] = np.where(uniform < shares[size], 10.0, LATE_S)
            columns["robots"][row] = size
        return columns

    return compute


def answered(plan: Plan, shares: dict[int, float], out: Path) -> RequirementAnswer:
    answer = study.run_plan(plan, out, compute=simulated(plan, shares))
    assert isinstance(answer, RequirementAnswer)
    return answer


def quarantined(compute: Any, is_bad: Callable[[int, int], bool]) -> Any:
    """Return a simulator whose runs of a team size and run number may be quarantined."""

    def changed(block: RunBlock) -> Columns:
        columns: Columns = compute(block)
        for row, configuration in enumerate(block.configurations):
            bad = [is_bad(configuration + 1, block.first_run + run) for run in range(block.runs)]
            for values in columns.values():
                values[row, bad] = np.nan
        return columns

    return changed
