"""What the runs of each team came to, ours and the published ones.

The best team is the one with the highest mean merit. Run r of all teams has the same starts, so it
is compared with each other team by the differences of their runs' merits. Which team is best is
read from the same runs, so the intervals must hold for the differences of all pairs of teams
together (Bonferroni over k (k - 1) / 2). A team whose interval reaches 0 cannot be told apart from
the best: it is a tie, and the answer says so.
"""

from dataclasses import dataclass

import numpy as np

from agent_economy.merit import Merit
from agent_economy.scenario import Scenario
from agent_economy.study import estimate
from agent_economy.study.estimate import Estimate
from agent_economy.study.runs import Outcomes, Runs


@dataclass(frozen=True)
class TeamResult:
    """What the runs of one team came to.

    Attributes:
        robots: Team size.
        runs: How many.
        time_s: Mean time, capped.
        failed: How many runs failed.
        failed_share: Their share.
        merit: Figure of merit.
        behind_best: The best team's merit less this one's, with an interval that holds for all
            pairs of teams together; None for the best itself.
    """

    robots: int
    runs: int
    time_s: Estimate
    failed: int
    failed_share: Estimate
    merit: Estimate
    behind_best: Estimate | None

    @property
    def is_tied(self) -> bool:
        """Whether it cannot be told apart from the best team."""
        return self.behind_best is not None and self.behind_best.low <= 0


@dataclass(frozen=True)
class PublishedResult:
    """What others found of one team.

    Attributes:
        robots: Team size.
        times_s: Time of each run, capped.
        time_s: Their mean.
        failed: How many reached the cap.
        failed_share: Their share.
        merit: Our figure of merit of these runs.
    """

    robots: int
    times_s: list[float]
    time_s: float
    failed: int
    failed_share: float
    merit: Estimate


def team(runs: Runs, robots: int, best: int) -> TeamResult:
    """Return the estimates of one team."""
    outcomes = runs.teams[robots]
    failed = int(np.sum(outcomes.failed))
    pairs = max(1, len(runs.teams) * (len(runs.teams) - 1) // 2)
    return TeamResult(
        robots=robots,
        runs=len(outcomes.time_s),
        time_s=estimate.mean(outcomes.time_s),
        failed=failed,
        failed_share=estimate.share(failed, len(outcomes.failed)),
        merit=estimate.mean(outcomes.merit),
        behind_best=None if robots == best else behind(runs.teams[best], outcomes, pairs),
    )


def behind(best: Outcomes, other: Outcomes, comparisons: int) -> Estimate:
    """Return the best team's merit less another's, as one of so many simultaneous intervals."""
    confidence = 1 - (1 - estimate.CONFIDENCE) / comparisons
    return estimate.mean(best.merit - other.merit, confidence)


def published_teams(scenario: Scenario) -> tuple[PublishedResult, ...]:
    """Return what others found, scored as our runs are; nothing if times do not tell the score."""
    published = scenario.published
    if not published or not {*scenario.merit.columns} <= {"time_s", "robots", "failed"}:
        return ()
    return tuple(
        published_team(scenario.merit, published.cap_s, robots, times_s)
        for robots, times_s in published.times_s.items()
    )


def published_team(
    merit: Merit, cap_s: float, robots: int, times_s: list[float]
) -> PublishedResult:
    """Return one published team, scored; a time at the cap is a failed run."""
    times = np.array(times_s)
    failed = times >= cap_s
    return PublishedResult(
        robots=robots,
        times_s=times_s,
        time_s=float(np.mean(times)),
        failed=int(np.sum(failed)),
        failed_share=float(np.mean(failed)),
        merit=estimate.mean(
            merit.score(
                {
                    "time_s": times,
                    "robots": np.full(len(times), float(robots)),
                    "failed": failed.astype(np.float64),
                }
            )
        ),
    )
