"""A small study, for processes that are killed while they work on it."""

from pathlib import Path
from typing import Self

from agent_economy import Scenario, study
from agent_economy.study import ask

ROOT = Path(__file__).resolve().parents[2]


class NoScript:
    """Stands for the charts' JavaScript, which takes two seconds to make."""

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def text(self) -> str:
        """Return nothing."""
        return ""


def plan(delta: float = 0.3) -> study.Plan:
    """Return what the small study asks: one to five wanderers."""
    scenario = Scenario.load(ROOT / "scenarios" / "classic.toml")
    return study.make_plan(
        scenario.replace("study.vary.robots.wanderer.count", "1..5"), delta=delta
    )


def pursue(folder: Path) -> None:
    """Run the small study, or go on with it."""
    ask.ChartScript = NoScript  # type: ignore[assignment,attr-defined]
    study.pursue(plan(), folder)
