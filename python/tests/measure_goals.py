"""Measures how soon robots give up goals that they cannot reach, and how often goals that they can.

`make goals` runs 200 random worlds of each sort. A goal is given up in time if the clock that its
last discovery restarted runs for at most two minutes. The second table is of worlds that change:
the time from the last change until a goal is reached, and the share of the time before it in which
the robot drives to the goal.
"""

import argparse
import statistics

from goal_attempts import Outcome, outcome
from goal_worlds import CHANGING, REACHABLE, UNREACHABLE, random_world

MAX_PATIENCE_S = 120.0

COLUMNS = [
    "worlds",
    "unreachable",
    "late",
    "restarts without a discovery",
    "max s since the last restart",
    "median s in all",
    "max s in all",
    "reachable",
    "reached",
    "given up",
    "mean end s",
]

CHANGING_COLUMNS = [
    "worlds that change",
    "goals",
    "reached",
    "median s after the last change",
    "max s after it",
    "attempts before",
    "time of these",
]


def changing(name: str, worlds: int) -> str:
    """Return what became of the first goals of worlds that change."""
    outcomes = [outcome(name, number) for number in range(worlds)]
    changes_s = [random_world(name, number)[0].changes[-1][0] for number in range(worlds)]
    goals = list(zip((each.possible[0] for each in outcomes), changes_s, strict=True))
    waits_s = [
        max(goal.reached_s - change_s, 0.0)
        for goal, change_s in goals
        if goal.reached_s is not None
    ]
    before_s = [goal.attempts_s(change_s) for goal, change_s in goals]
    attempts = statistics.fmean(map(len, before_s))
    share = sum(map(sum, before_s)) / sum(changes_s)
    times = f"{statistics.median(waits_s):.0f} | {max(waits_s):.0f}"
    return f"{worlds} | {len(waits_s)} | {times} | {attempts:.1f} | {share:.0%}"


def reachable(outcomes: list[Outcome]) -> str:
    """Return what became of the goals that can be reached."""
    attempts = [attempt for each in outcomes for attempt in each.possible]
    reached = sum(attempt.reached_s is not None for attempt in attempts)
    given_up = sum(len(attempt.given_up_s) for attempt in attempts)
    end_s = statistics.fmean(each.end_s for each in outcomes)
    return f"{len(attempts)} | {reached} | {given_up} | {end_s:.0f}"


def unreachable(outcomes: list[Outcome]) -> str:
    """Return what became of the goals that cannot be reached."""
    attempts = [attempt for each in outcomes for attempt in each.impossible]
    late = sum(attempt.patience_s > MAX_PATIENCE_S for attempt in attempts)
    patience_s = max(attempt.patience_s for attempt in attempts)
    whole_s = [attempt.given_up_s[0] for attempt in attempts if attempt.given_up_s]
    unfounded = sum(attempt.unfounded_restarts for attempt in attempts)
    times = f"{patience_s:.0f} | {statistics.median(whole_s):.0f} | {max(whole_s):.0f}"
    return f"{len(attempts)} | {late} | {unfounded} | {times}"


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=200, help="of each sort")
    worlds: int = parser.parse_args().worlds
    print(f"| {' | '.join(COLUMNS)} |")
    print("|---" * len(COLUMNS) + "|")
    for name in UNREACHABLE:
        outcomes = [outcome(name, number) for number in range(worlds // len(UNREACHABLE))]
        print(f"| {name} | {unreachable(outcomes)} | {reachable(outcomes)} |", flush=True)
    for name in REACHABLE:
        outcomes = [outcome(name, number) for number in range(worlds // len(REACHABLE))]
        print(f"| {name} | | | | | | | {reachable(outcomes)} |", flush=True)
    print(f"\n| {' | '.join(CHANGING_COLUMNS)} |")
    print("|---" * len(CHANGING_COLUMNS) + "|")
    for name in CHANGING:
        print(f"| {name} | {changing(name, worlds // len(CHANGING))} |", flush=True)


if __name__ == "__main__":
    main()
