"""Measures how soon robots give up goals that they cannot reach, and how often goals that they can.

`make goals` runs 200 random worlds of each sort. A goal is given up in time if the clock that its
last discovery restarted runs for at most two minutes.
"""

import argparse
import statistics

from goal_attempts import Outcome, outcome
from goal_worlds import REACHABLE, UNREACHABLE

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
    """Print both tables."""
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


if __name__ == "__main__":
    main()
