"""The sensing team on IR-SIM: differential drives with its `lidar2d`, and a brain in Python."""

import math
import tempfile
from pathlib import Path
from typing import Any

import irsim
import yaml

from measure import (
    NEAR_M,
    NOISE_M,
    RADIUS_M,
    RANGE_M,
    RAYS,
    SPEED_M_S,
    STEP_S,
    TURN_RAD_S,
    Field,
    Run,
    corners,
    field,
    report,
)

WORK = "16 rays with noise; reactive brain in Python; collisions"


def main() -> None:
    """Measure steps of all robots."""
    stands = field()
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "world.yaml"
        file.write_text(yaml.safe_dump(world(stands)), encoding="utf-8")
        report("ir-sim", WORK, len(stands.robots), lambda: start(file))


def start(file: Path) -> Run:
    """Return a new team."""
    made = irsim.make(str(file), display=False, headless=True, log_level="ERROR", seed=1)
    return Team(made).run


def world(stands: Field) -> dict[str, Any]:
    """Return the world as IR-SIM reads it."""
    pillars = [still({"name": "circle", "radius": r}, [x, y, 0]) for x, y, r in stands.pillars]
    boxes = [polygon("polygon", corners(*each)) for each in stands.boxes]
    room = corners(0.0, 0.0, stands.side_m, stands.side_m)
    return {
        "world": {
            "width": stands.side_m,
            "height": stands.side_m,
            "step_time": STEP_S,
            "sample_time": STEP_S,
            "collision_mode": "contact",
        },
        "robot": [robot(*each) for each in stands.robots],
        "obstacle": [*pillars, *boxes, polygon("linestring", [*room, room[0]])],
    }


def robot(x: float, y: float, heading_rad: float) -> dict[str, Any]:
    """Return a robot with its ring of rays."""
    lidar = {
        "name": "lidar2d",
        "range_min": 0,
        "range_max": RANGE_M,
        "angle_range": math.tau * (RAYS - 1) / RAYS,
        "number": RAYS,
        "noise": True,
        "std": NOISE_M,
    }
    return {
        "kinematics": {"name": "diff"},
        "shape": {"name": "circle", "radius": RADIUS_M},
        "state": [x, y, heading_rad],
        "vel_max": [SPEED_M_S, TURN_RAD_S],
        "vel_min": [-SPEED_M_S, -TURN_RAD_S],
        "sensors": [lidar],
    }


def polygon(name: str, vertices: list[tuple[float, float]]) -> dict[str, Any]:
    """Return something with corners."""
    return still({"name": name, "vertices": [list(each) for each in vertices]}, [0, 0, 0])


def still(shape: dict[str, Any], state: list[float]) -> dict[str, Any]:
    """Return an obstacle that stands still."""
    return {"shape": shape, "state": state, "static": True}


class Team:
    """All robots, each with the steps that are left of its turn; negative to the right."""

    def __init__(self, environment: Any) -> None:
        """Begin with none turning."""
        self.environment = environment
        self.turning = [0] * len(environment.robot_list)

    def run(self, steps: int) -> None:
        """Take so many steps."""
        for _ in range(steps):
            robots = enumerate(self.environment.robot_list)
            commands = [self.decide(number, robot) for number, robot in robots]
            self.environment.step(commands, action_id=list(range(len(commands))))

    def decide(self, number: int, robot: Any) -> list[float]:
        """Return speed and rate of turn: away from what is near ahead."""
        ranges = robot.lidar.range_data
        middle = RAYS // 2
        right, left = ranges[middle - 3 : middle].min(), ranges[middle : middle + 3].min()
        if self.turning[number] == 0 and min(left, right) < NEAR_M:
            self.turning[number] = 10 if left > right else -10
        turn = (self.turning[number] > 0) - (self.turning[number] < 0)
        self.turning[number] -= turn
        return [0.0 if turn else SPEED_M_S, turn * TURN_RAD_S]


if __name__ == "__main__":
    main()
