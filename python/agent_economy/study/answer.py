"""The answer of a study: whom to send."""

from dataclasses import dataclass

import numpy as np

from agent_economy.scenario import Scenario
from agent_economy.study.runs import Runs
from agent_economy.study.sentence import in_words
from agent_economy.study.teams import PublishedResult, TeamResult, published_teams, team


@dataclass(frozen=True)
class Answer:
    """How many robots to send.

    Attributes:
        scenario: What was asked.
        seed: Of all random starts.
        best: Team size with the highest merit.
        tied: Team sizes that cannot be told apart from it.
        sentence: The answer for people.
        teams: Each team, ascending.
        published: Results of others, with the same merit.
    """

    scenario: Scenario
    seed: int
    best: int
    tied: tuple[int, ...]
    sentence: str
    teams: tuple[TeamResult, ...]
    published: tuple[PublishedResult, ...]


def conclude(runs: Runs) -> Answer:
    """Return the answer that a study's runs give."""
    best = max(runs.teams, key=lambda robots: float(np.mean(runs.teams[robots].merit)))
    teams = tuple(team(runs, robots, best) for robots in runs.teams)
    return Answer(
        scenario=runs.scenario,
        seed=runs.seed,
        best=best,
        tied=tuple(each.robots for each in teams if each.is_tied),
        sentence=in_words(runs.scenario, best, teams),
        teams=teams,
        published=published_teams(runs.scenario),
    )
