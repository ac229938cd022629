"""A study: as many runs of each configuration as the question needs, and the answer.

The data flows one way: `ask` -> `plan` (what is asked; `design`, `engine`) -> `race` (the loop:
the procedure of `selection` asks, `store` looks up, `engine` or `workers` compute) -> `answer`
(what the runs say for sure) -> `report` and `files`.
"""

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.results import Result
from agent_economy.study.ask import look, plan_of, pursue, rebuild, resume, run
from agent_economy.study.plan import Plan
from agent_economy.study.plan import make as make_plan
from agent_economy.study.progress import Progress
from agent_economy.study.selection import Selection, select_best
from agent_economy.study.store import read as open  # noqa: A004  (ae.study.open)
from agent_economy.study.store.folder import is_worked_on

__all__ = [
    "Answer",
    "Plan",
    "Progress",
    "Result",
    "Selection",
    "is_worked_on",
    "look",
    "make_plan",
    "open",
    "plan_of",
    "pursue",
    "rebuild",
    "resume",
    "run",
    "select_best",
]
