"""A study: as many runs of each configuration as the question needs, and the answer they give.

The data flows one way: `ask` -> `plan` (what is asked; `design`, `engine`) -> `race` (the loop: the race of
`selection` asks, `store` looks up, `engine` computes) -> `evidence` (what the runs say for sure) ->
`answer` (`ties`, `front`, `saturation`, `sensitivity`, `effort`, `sentence`) -> `report` and `files`.
"""

from agent_economy.study.answer import Answer, Result
from agent_economy.study.ask import answer, plan_of, pursue, resume, run
from agent_economy.study.plan import Plan
from agent_economy.study.plan import make as plan
from agent_economy.study.race import Progress
from agent_economy.study.selection import Selection, select_best
from agent_economy.study.store import read as open  # noqa: A004  (ae.study.open)

__all__ = [
    "Answer",
    "Plan",
    "Progress",
    "Result",
    "Selection",
    "answer",
    "open",
    "plan",
    "plan_of",
    "pursue",
    "resume",
    "run",
    "select_best",
]
