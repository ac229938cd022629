"""What every peer's script shares: the field it stands on, the clock, and the line it prints."""

import json
import statistics
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import version
from itertools import pairwise
from pathlib import Path

PIECE_S = 0.5
"""The least processor time of a piece of work."""

PIECES = 5
"""Pieces of work that count; one before them warms up."""

STEPS = 20
"""Steps between two looks at the clock."""

RADIUS_M = 0.2
RANGE_M = 3.0
RAYS = 16
NOISE_M = 0.02
STEP_S = 0.1
SPEED_M_S = 0.5
TURN_RAD_S = 1.5
NEAR_M = 0.6
"""A robot turns away from what is nearer ahead."""


@dataclass(frozen=True)
class Field:
    """Where robots start, and what stands around them; lengths in metres.

    Attributes:
        side_m: of the square.
        pillars: x, y and radius.
        boxes: least x and y, greatest x and y.
        robots: x, y and heading in radians.
    """

    side_m: float
    pillars: list[tuple[float, float, float]]
    boxes: list[tuple[float, float, float, float]]
    robots: list[tuple[float, float, float]]

    def walls(self) -> list[tuple[tuple[float, float], tuple[float, float]]]:
        """Return the sides of all boxes and of the square, each by its ends."""
        outlines = [corners(*each) for each in [*self.boxes, (0.0, 0.0, self.side_m, self.side_m)]]
        return [side for outline in outlines for side in pairwise([*outline, outline[0]])]


def corners(x: float, y: float, far_x: float, far_y: float) -> list[tuple[float, float]]:
    """Return the corners of a box, in order."""
    return [(x, y), (far_x, y), (far_x, far_y), (x, far_y)]


def field() -> Field:
    """Return the field in the file that the command names; `speed field` writes it."""
    return Field(**json.loads(Path(sys.argv[1]).read_text(encoding="utf-8")))


Run = Callable[[int], None]
"""Takes so many steps."""


def report(package: str, work: str, robots: int, start: Callable[[], Run]) -> None:
    """Measure and print one line of JSON.

    Args:
        package: as installed, for its version.
        work: what a robot-update is, for people.
        robots: in the team.
        start: makes a new team; each piece of work has its own, so that none is measured only once
            its robots stand in each other's way.
    """
    rates = [robots / step_s(start()) for _ in range(1 + PIECES)]
    line = {
        "peer": package,
        "version": version(package),
        "work": work,
        "robots": robots,
        "updates_per_s": statistics.median(rates[1:]),
    }
    print(json.dumps(line))


def step_s(run: Run) -> float:
    """Return the processor time of a step: of one piece of work, after a few steps to warm up."""
    run(STEPS)
    start = time.process_time()
    pieces = 0
    while (took_s := time.process_time() - start) < PIECE_S:
        run(STEPS)
        pieces += 1
    return took_s / (pieces * STEPS)
