"""A study: configurations are run until its question is answered.

The data flows one way: `api` -> `plan` (`check`, `questions`, `engine`) -> `race` (the loop: the
procedure of `selection` requests runs, `store` reads them, `engine` or `workers` compute missing
ones) -> `answer` (what the runs prove) -> `report` and `files`. `sampling` is the race of
`select_best`, of runs that a user's function computes.
"""

from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.answer.requirement_results import RequirementResult
from agent_economy.study.answer.results import Result
from agent_economy.study.api import load_answer, load_plan, rebuild, resume, run, run_plan
from agent_economy.study.plan import Plan
from agent_economy.study.plan import make as make_plan
from agent_economy.study.progress import Progress
from agent_economy.study.sampling.result import Selection
from agent_economy.study.sampling.select_best import select_best
from agent_economy.study.store import read as open  # noqa: A004  (ae.study.open)
from agent_economy.study.store.folder import is_locked

__all__ = [
    "Answer",
    "AnyAnswer",
    "Plan",
    "Progress",
    "RequirementAnswer",
    "RequirementResult",
    "Result",
    "Selection",
    "is_locked",
    "load_answer",
    "load_plan",
    "make_plan",
    "open",
    "rebuild",
    "resume",
    "run",
    "run_plan",
    "select_best",
]


def __dir__() -> list[str]:
    """Return the public names."""
    return sorted(__all__)
