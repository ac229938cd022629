"""A study: many runs of every team, and the answer they give.

The data flows one way: `runs` (outcomes of every team) -> `answer` (`teams`: estimates with
intervals; `sentence`: the words) -> `report` and `files` (what is left on disk).
"""

from agent_economy.study.answer import Answer, conclude
from agent_economy.study.runs import Progress, Runs, run_teams
from agent_economy.study.selection import Selection, select_best
from agent_economy.study.teams import TeamResult

__all__ = ["Answer", "Progress", "Runs", "Selection", "TeamResult", "conclude", "run_teams", "select_best"]
