"""The sensing team on Mesa: robots in its `ContinuousSpace` that find neighbours within range."""

import math

import mesa

from measure import NEAR_M, RADIUS_M, RANGE_M, SPEED_M_S, STEP_S, TURN_RAD_S, Field, field, report

WORK = "no rays: neighbours within 3 m; reactive brain in Python; no collisions"


def main() -> None:
    """Measure steps of all robots."""
    stands = field()
    report("mesa", WORK, len(stands.robots), lambda: Team(stands).run)


class Team(mesa.Model):
    """All robots."""

    def __init__(self, stands: Field) -> None:
        """Put them where they start."""
        super().__init__(seed=1)
        self.most_m = stands.side_m - RADIUS_M
        self.space = mesa.space.ContinuousSpace(stands.side_m, stands.side_m, torus=False)
        for x, y, heading_rad in stands.robots:
            self.space.place_agent(Robot(self, heading_rad), (x, y))

    def run(self, steps: int) -> None:
        """Take so many steps with every robot."""
        for _ in range(steps):
            self.agents.do("step")


class Robot(mesa.Agent):
    """A robot that turns away from the nearest neighbour ahead."""

    def __init__(self, model: Team, heading_rad: float) -> None:
        """Begin without a turn."""
        super().__init__(model)
        self.heading_rad = heading_rad
        self.turning = 0
        """Steps left of a turn; negative to the right."""

    def step(self) -> None:
        """Sense, decide and drive."""
        reach_m = RANGE_M + RADIUS_M
        near = self.model.space.get_neighbors(self.pos, reach_m, include_center=False)
        if near and self.turning == 0:
            self.decide(min(near, key=lambda other: math.dist(self.pos, other.pos)))
        turn = (self.turning > 0) - (self.turning < 0)
        self.turning -= turn
        self.heading_rad += turn * TURN_RAD_S * STEP_S
        if not turn:
            self.drive()

    def decide(self, nearest: "Robot") -> None:
        """Turn if the nearest is near and ahead."""
        x, y = nearest.pos[0] - self.pos[0], nearest.pos[1] - self.pos[1]
        bearing_rad = math.remainder(math.atan2(y, x) - self.heading_rad, math.tau)
        if math.hypot(x, y) - RADIUS_M < NEAR_M and abs(bearing_rad) < math.pi / 4:
            self.turning = -10 if bearing_rad > 0 else 10

    def drive(self) -> None:
        """Go on, at the edge along it."""
        way_m = SPEED_M_S * STEP_S
        x = self.pos[0] + way_m * math.cos(self.heading_rad)
        y = self.pos[1] + way_m * math.sin(self.heading_rad)
        self.model.space.move_agent(self, (self.inside(x), self.inside(y)))

    def inside(self, place_m: float) -> float:
        """Return the nearest place from which it does not stick out of the field."""
        return min(max(place_m, RADIUS_M), float(self.model.most_m))


if __name__ == "__main__":
    main()
