"""Published results, scored with the merit of the study."""

from dataclasses import dataclass

import numpy as np

from agent_economy.scenario import Scenario
from agent_economy.study.answer import estimate
from agent_economy.study.answer.evidence import Interval


@dataclass(frozen=True)
class PublishedResult:
    """The published result of one team.

    Attributes:
        robots: Team size.
        times_s: Time of each run, capped.
        time_s: Their mean.
        failed: Number of runs that reached the cap.
        failed_share: Their share, with an exact 95% interval.
        merit: The study's figure of merit of these runs, with Student's 95% interval.
    """

    robots: int
    times_s: list[float]
    time_s: float
    failed: int
    failed_share: Interval
    merit: Interval


def results(scenario: Scenario) -> tuple[PublishedResult, ...]:
    """Return the published results, if they include all columns of the merit."""
    published = scenario.published
    known = {"time_s", "failed", "robots"}
    if not published or not set(scenario.merit.columns) <= known:
        return ()
    return tuple(
        result(scenario, published.time_limit_s, robots, times_s)
        for robots, times_s in published.times_s.items()
    )


def result(
    scenario: Scenario, time_limit_s: float, robots: int, times_s: list[float]
) -> PublishedResult:
    """Return one published team, scored; a time at the cap is a failed run."""
    times = np.array(times_s)
    failed = times >= time_limit_s
    columns = {"time_s": times, "failed": failed * 1.0, "robots": np.full(len(times), robots * 1.0)}
    count = int(np.sum(failed))
    return PublishedResult(
        robots=robots,
        times_s=times_s,
        time_s=float(np.mean(times)),
        failed=count,
        failed_share=estimate.share(count, len(times)),
        merit=estimate.mean(scenario.merit.score(columns)),
    )
