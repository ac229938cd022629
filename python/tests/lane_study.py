"""Studies of a short mined lane, on the runs of a false simulator."""

from pathlib import Path
from typing import Any

import numpy as np

from agent_economy import Scenario, study
from agent_economy.study.plan import Plan
from agent_economy.study.run_block import Columns, RunBlock

FILE = Path(__file__).with_name("short_lane.toml")
OAVS, UGVS = "robots.oav.count", "robots.ugv.count"
LIMIT_S = 200.0

Team = tuple[int, int]
"""Numbers of air and of ground vehicles."""

Lanes = dict[Team, tuple[float, float]]
"""Share of lanes that a team declares clear, and the risk of these."""


def lane(**changes: Any) -> Scenario:
    """Return the scenario of a short mined lane, with changes by path."""
    scenario = Scenario.load(FILE)
    for path, value in changes.items():
        scenario = scenario.replace(path, value)
    return scenario


def simulated(plan: Plan, lanes: Lanes) -> Any:
    """Return a simulator whose teams declare lanes clear in given shares, with a given risk."""

    def compute(block: RunBlock) -> Columns:
        columns: Columns = {
            column.name: np.zeros((len(block.configurations), block.runs))
            for column in plan.engine.columns
        }
        for row, configuration in enumerate(block.configurations):
            values = plan.configurations[configuration]
            oavs, ugvs = int(values[OAVS]), int(values[UGVS])
            for name, found in runs(block, lanes[oavs, ugvs]).items():
                columns[name][row] = found
            columns["robots"][row] = oavs + ugvs
            columns["price"][row] = 15_000 * oavs + 60_000 * ugvs + 5_000
        return columns

    return compute


def runs(block: RunBlock, of: tuple[float, float]) -> dict[str, Any]:
    """Return the columns of the runs of a team."""
    share, risk = of
    numbers = range(block.first_run, block.first_run + block.runs)
    # Common random numbers: the same for all teams.
    one, two = np.array([np.random.default_rng(number).random(2) for number in numbers]).T
    is_declared = one < share
    return {
        "declared": is_declared,
        "declared_clear": is_declared & (two >= risk),
        "declared_not_clear": is_declared & (two < risk),
        "stated_risk": np.where(is_declared, 0.04, 1.0),
        "declared_s": np.where(is_declared, 100.0, LIMIT_S),
        "time_s": np.where(is_declared, 100.0, LIMIT_S),
        "failed": ~is_declared,
    }


def answered(plan: Plan, lanes: Lanes, out: Path) -> study.AnyAnswer:
    """Return the answer of a study of the false simulator."""
    return study.run_plan(plan, out, compute=simulated(plan, lanes))
