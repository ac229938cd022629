"""What a study compares and how sure it must be, in words; and where it is kept."""

from dataclasses import dataclass
from pathlib import Path

from agent_economy.study import design
from agent_economy.study.plan import Plan, is_same_data
from agent_economy.study.store.folder import ASKED

FOLDER = Path("studies")
"""In which studies are kept if nothing else is said."""


@dataclass(frozen=True)
class Question:
    """What a study compares, and how sure it must be.

    Attributes:
        design: As in `Scenario.design`.
        configurations: How many.
        delta: The difference of mean merits worth finding.
        confidence: Of the guarantee.
        guarantee: Which one, as `select_best` has it.
        runs: Of each configuration; None for as few as it takes.
    """

    design: str
    configurations: int
    delta: float
    confidence: float
    guarantee: str
    runs: int | None

    @classmethod
    def of(cls, plan: Plan) -> "Question":
        """Return the question of a plan."""
        return cls(
            plan.scenario.design,
            len(plan.configurations),
            plan.delta,
            plan.confidence,
            plan.guarantee,
            plan.runs,
        )

    def __str__(self) -> str:
        """Return it as it is announced."""
        wanted = (
            f"{self.runs:,} runs of each"
            if self.runs is not None
            else f"delta {self.delta:g}, confidence {self.confidence:g}, {self.guarantee}"
        )
        return f"{design.in_words(self.design, self.configurations)}; {wanted}"


def usual_folder(plan: Plan, below: Path = Path()) -> Path:
    """Return studies/NAME; where that holds other runs, the same with what tells these apart.

    Raises:
        OSError: If what is there cannot be read.
    """
    folder = below / FOLDER / plan.scenario.name
    there = folder / ASKED
    is_other = there.exists() and not is_same_data(there.read_text(errors="replace"), plan.text())
    return folder.with_name(f"{folder.name}-{plan.identity[:8]}") if is_other else folder
