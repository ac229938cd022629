"""A small study, for processes that are killed while they run it."""

from pathlib import Path

from agent_economy import Scenario, study
from agent_economy.study.report.page import template
from agent_economy.study.versions import versions

ROOT = Path(__file__).resolve().parents[2]

# Cached before the server process forks, so that not every process that is killed computes them.
template()
versions()


def plan(delta: float = 0.3) -> study.Plan:
    """Return the plan of the small study: one to five wanderers."""
    scenario = Scenario.load(ROOT / "scenarios" / "classic.toml")
    return study.make_plan(
        scenario.replace("study.vary.robots.wanderer.count", "1..5"), delta=delta
    )


def run_plan(folder: Path) -> None:
    """Run or resume the small study."""
    study.run_plan(plan(), folder)
