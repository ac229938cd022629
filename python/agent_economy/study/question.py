"""A study's question in words, and the folder of the study."""

from dataclasses import dataclass
from pathlib import Path

from agent_economy.study import design
from agent_economy.study.plan import Plan, is_same_data
from agent_economy.study.store.folder import QUESTION, read_bytes

FOLDER = Path("studies")
"""Default folder of studies."""


@dataclass(frozen=True)
class Question:
    """The configurations that a study compares, and its guarantee.

    Attributes:
        design: As in `Scenario.design`.
        configurations: Number of configurations.
        delta: Indifference zone, in units of merit.
        confidence: Confidence of the guarantee.
        guarantee: "indifference" or "pgs", as in `select_best`.
        runs: Fixed number of runs per configuration; None to stop when the answer is settled.
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
        """Return it in one line."""
        wanted = (
            f"{self.runs:,} runs per configuration"
            if self.runs is not None
            else f"delta {self.delta:g}, confidence {self.confidence:g}, {self.guarantee}"
        )
        return f"{design.describe(self.design, self.configurations)}; {wanted}"


def usual_folder(plan: Plan, below: Path = Path()) -> Path:
    """Return studies/NAME, or studies/NAME-DIGEST if the former contains other runs.

    Raises:
        InputError: If an existing study.toml cannot be read.
    """
    folder = below / FOLDER / plan.scenario.name
    existing = read_bytes(folder / QUESTION)
    is_other = existing is not None and not is_same_data(
        existing.decode(errors="replace"), plan.text()
    )
    return folder.with_name(f"{folder.name}-{plan.identity[:8]}") if is_other else folder
