"""The flock of JuliaDynamics/ABMFrameworksComparison on Mesa, by its declaration."""

import json
import math
import statistics
import sys
import time
from importlib.metadata import version

import mesa

BIRDS = int(sys.argv[1])
SIDE = 150 * math.sqrt(BIRDS / 400)
REACH, SEPARATION = 15.0, 1.0
COHERE, SEPARATE, MATCH = 0.03, 0.015, 0.05

STEPS = 10
"""Of each run; it is the beginning that others take a hundred steps from."""

PIECES = 3


def main() -> None:
    """Measure runs from their start, one to warm up, and print a line of JSON."""
    rates = [BIRDS * STEPS / run_s() for _ in range(1 + PIECES)]
    line = {
        "peer": "mesa",
        "version": version("mesa"),
        "work": "Python; the first 10 steps",
        "robots": BIRDS,
        "updates_per_s": statistics.median(rates[1:]),
    }
    print(json.dumps(line))


def run_s() -> float:
    """Return the processor time of a run."""
    sky = Sky()
    start = time.process_time()
    for _ in range(STEPS):
        sky.agents.shuffle_do("step")
    return time.process_time() - start


class Sky(mesa.Model):
    """All birds."""

    def __init__(self) -> None:
        """Put them anywhere."""
        super().__init__(seed=1)
        self.space = mesa.space.ContinuousSpace(SIDE, SIDE, torus=True)
        for _ in range(BIRDS):
            place = (self.random.random() * SIDE, self.random.random() * SIDE)
            self.space.place_agent(Bird(self), place)


class Bird(mesa.Agent):
    """A bird, by the declared rule."""

    def __init__(self, model: Sky) -> None:
        """Begin with any course."""
        super().__init__(model)
        course_rad = model.random.random() * math.tau
        self.course = (math.cos(course_rad), math.sin(course_rad))

    def step(self) -> None:
        """Turn, and go."""
        self.turn(self.model.space.get_neighbors(self.pos, REACH, include_center=False))
        x, y = self.pos[0] + self.course[0], self.pos[1] + self.course[1]
        self.model.space.move_agent(self, (x, y))

    def turn(self, near: list["Bird"]) -> None:
        """Take the course that its own and the three wishes give."""
        wish_x = wish_y = 0.0
        for other in near:
            x, y = self.model.space.get_heading(self.pos, other.pos)
            weight = COHERE - (SEPARATE if math.hypot(x, y) < SEPARATION else 0.0)
            wish_x += weight * x + MATCH * other.course[0]
            wish_y += weight * y + MATCH * other.course[1]
        count = max(len(near), 1)
        x, y = self.course[0] + wish_x / count, self.course[1] + wish_y / count
        length = math.hypot(x, y)
        self.course = (x / length, y / length)


if __name__ == "__main__":
    main()
