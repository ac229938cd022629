"""A study in words, and its usual folder."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy.study import design
from agent_economy.study.plan import Plan, is_same_data
from agent_economy.study.store.folder import QUESTION, read_bytes

FOLDER = Path("studies")
"""Default folder of studies."""


@dataclass(frozen=True)
class Description:
    """What a study compares, and its question.

    Attributes:
        design: As in `Scenario.design`.
        configurations: Number of configurations.
        question: The question in words.
        confidence: Confidence of the answer.
        delta: Indifference zone; None if the question has none.
        runs: Fixed number of runs per configuration; None to stop when the answer is settled.
    """

    design: str
    configurations: int
    question: str
    confidence: float
    delta: float | None
    runs: int | None

    @classmethod
    def of(cls, plan: Plan) -> "Description":
        """Return the description of a plan."""
        question = plan.question.as_dict(plan.confidence)
        return cls.stored(plan.scenario.design, len(plan.configurations), question, plan.runs)

    @classmethod
    def stored(
        cls, design: str, configurations: int, question: Mapping[str, Any], runs: int | None
    ) -> "Description":
        """Return the description of a study whose question is stored."""
        words, delta = in_words(question), question.get("delta")
        return cls(design, configurations, words, question["confidence"], delta, runs)

    def __str__(self) -> str:
        """Return it in one line."""
        wanted = f"{self.runs:,} runs per configuration" if self.runs is not None else self.question
        return f"{design.describe(self.design, self.configurations)}; {wanted}"


def in_words(question: Mapping[str, Any]) -> str:
    """Return a stored question in words."""
    confidence = f"confidence {question['confidence']:.15g}"
    if "delta" in question:
        return f"delta {question['delta']:g}, {confidence}, {question['guarantee']}"
    finer = f"; then decided at a tolerance of {question['finer']:g}" if "finer" in question else ""
    return f"least {question['cost']} with {question['requirement']}{finer}; {confidence}"


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
