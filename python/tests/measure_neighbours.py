"""Measures how true stated risks are where mines lie beside each other or beside scrap.

Lanes of 60 m x 20 m with the vehicles of the bundled scenario. The controllers expect the right
numbers of items, and no neighbours.
"""

import argparse
import math
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

from agent_economy import Scenario, replicate
from agent_economy.scenario import Override

MINES = Path(__file__).parents[2] / "scenarios" / "mines.toml"

Place = tuple[float, float]
Places = list[Place]

LOW, HIGH = (8.0, 4.0), (68.0, 24.0)
"""The corners of the lane, in metres."""

INSIDE_M = 2.0
"""Distance of random places from the border of the lane."""


class Items(NamedTuple):
    """The places of mines and of scrap, in metres."""

    mines: Places
    scrap: Places


def apart(random: Random, count: int, gap_m: float) -> Places:
    """Return random places that are at least a distance from each other."""
    places: Places = []
    while len(places) < count:
        place = (
            random.uniform(LOW[0] + INSIDE_M, HIGH[0] - INSIDE_M),
            random.uniform(LOW[1] + INSIDE_M, HIGH[1] - INSIDE_M),
        )
        if all(math.dist(place, other) > gap_m for other in places):
            places.append(place)
    return places


def beside(random: Random, place: Place, gap_m: float) -> Place:
    """Return a place at a distance from another, in a random direction."""
    angle_rad = random.uniform(0, math.tau)
    return (place[0] + gap_m * math.cos(angle_rad), place[1] + gap_m * math.sin(angle_rad))


def ten_apart(random: Random) -> Items:
    """Return ten mines without neighbours."""
    return Items(apart(random, 10, 4), apart(random, 4, 3))


def pairs(gap_m: float) -> Callable[[Random], Items]:
    """Return five pairs of mines with a gap."""

    def items(random: Random) -> Items:
        first = apart(random, 5, 6)
        mines = [each for place in first for each in (place, beside(random, place, gap_m))]
        return Items(mines, apart(random, 4, 3))

    return items


def scrap(count: int) -> Callable[[Random], Items]:
    """Return five mines, each with pieces of scrap 0.1 m away."""

    def items(random: Random) -> Items:
        mines = apart(random, 5, 6)
        return Items(mines, [beside(random, mine, 0.1) for mine in mines for _ in range(count)])

    return items


def on_border(random: Random) -> Items:
    """Return eight mines on the long sides of the lane."""
    sides = [LOW[1], HIGH[1]]
    mines: Places = [
        (random.uniform(LOW[0] + 7 * number, LOW[0] + 7 * number + 4), random.choice(sides))
        for number in range(8)
    ]
    return Items(mines, apart(random, 4, 3))


CASES: dict[str, Callable[[Random], Items]] = {
    "ten mines, apart": ten_apart,
    "five pairs of mines, 0.27 m apart": pairs(0.27),
    "five pairs of mines, 0.6 m apart": pairs(0.6),
    "five pairs of mines, 1 m apart": pairs(1.0),
    "five mines, each with a piece of scrap at 0.1 m": scrap(1),
    "five mines, each with three pieces of scrap at 0.1 m": scrap(3),
    "eight mines on the border": on_border,
}


def lane(items: Items) -> Scenario:
    """Return the bundled scenario with a lane of 60 m x 20 m and items at fixed places."""
    counts = {"mine": len(items.mines), "clutter": len(items.scrap)}
    start = {"kind": "uniform", "within_m": [[1, 4], [5, 24]]}
    changes: dict[str, Any] = {
        "world.size_m": [76, 28],
        "clock.time_limit_s": 1200,
        "controllers.station.clearance.lane_m": [list(LOW), list(HIGH)],
        "robots.oav.count": 2,
        "robots.ugv.count": 4,
    }
    for name, places in (("mine", items.mines), ("clutter", items.scrap)):
        changes[f"items.{name}.count"] = counts[name]
        changes[f"items.{name}.number"] = "fixed"
        at_m = [list(place) for place in places]
        changes[f"items.{name}.placement"] = {"kind": "fixed", "at_m": at_m}
    for kind in ("robots.oav", "robots.ugv"):
        changes[f"{kind}.brain.beliefs.prior_count"] = counts
    for kind in ("robots.oav", "robots.ugv", "controllers.station"):
        changes[f"{kind}.start"] = start
    each = changes.items()
    overrides = tuple(Override.at(path, value, "measurement") for path, value in each)
    return Scenario.load(MINES).changed(overrides)


def row(case: str, worlds: int, runs: int) -> str:
    """Return the results of a case as a row of a table."""
    rows: list[dict[str, Any]] = []
    for world in range(worlds):
        items = CASES[case](Random(world))  # noqa: S311
        rows += replicate(lane(items), runs, world).to_pylist()
    declared = [each for each in rows if each["declared"]]

    def total(column: str) -> float:
        return float(sum(each[column] for each in declared))

    stated = total("stated_risk") / max(1, len(declared))
    wrong = f"{total('declared_not_clear'):.0f} of {len(declared)}"
    parts = [
        f"{total(f'stated_{part}'):.1f}, {total(f'left_{part}'):.1f}"
        for part in ("unmarked", "marked")
    ]
    cells = [case, str(len(rows)), f"{stated:.1%}", wrong, *parts]
    return f"| {' | '.join(cells)} |"


def main() -> None:
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worlds", type=int, default=6, help="random places per case")
    parser.add_argument("--runs", type=int, default=20, help="runs per world")
    options = parser.parse_args()
    print("| | runs | stated | not clear | unmarked: stated, left | marked: stated, left |")
    print("| --- | --- | --- | --- | --- | --- |")
    for case in CASES:
        print(row(case, options.worlds, options.runs), flush=True)


if __name__ == "__main__":
    main()
