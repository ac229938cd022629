"""Measure the speed of brains in Python, compared with the bundled brain.

Example: python scripts/brain_speed.py
"""

import time
from statistics import median
from typing import Any

import numpy as np

from agent_economy import Batch, Scenario, Simulation
from agent_economy.runs.batch import Commands, Percepts
from agent_economy.runs.brain import Body, Command, Percept

FIELD = """
engine = "metric"
summary = "Robots with sixteen sonars each among pillars, a hundred on each 20 m by 20 m."
merit = "equation-5.2"
[clock]
time_limit_s = 1e6
[world]
size_m = [{side_m}, {side_m}]
obstacles = [{pillars}]
[items.mine]
target = false
count = 1
[robots.rover]
count = {robots}
radius_m = 0.2
drive = {{ max_speed_m_s = 0.5, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 90 }}
battery = {{ idle_w = 10, move_w = 5, move_j_per_m = 10 }}
[robots.rover.sensors.sonar]
kind = "range"
rays = 16
range_m = 3
noise_m = 0.02
"""
PILLAR_M = 5.0
"""Distance between pillars."""

TEAMS = (100, 10_000)
UPDATES = {"bundled": 400_000, "batch": 200_000, "class": 40_000}
"""Robot updates per measurement, with a minimum of one step."""

MEASUREMENTS = 5
NEAR_M, LOOKS_RAD, TURN_RAD_S = 0.6, 0.5, 1.5


class Turner:
    """Drives straight, and turns on the spot while an obstacle is near."""

    def __init__(self, body: Body) -> None:
        """Store what it needs of the body."""
        self.speed_m_s = body["max_speed_m_s"]
        bearings_rad = body["rings"][0]["bearings_rad"]
        self.ahead = [ray for ray, rad in enumerate(bearings_rad) if abs(rad) < LOOKS_RAD]

    def step(self, percept: Percept) -> Command:
        """Return the command."""
        ranges_m = percept["scans"][0]["ranges_m"]
        ahead = (ranges_m[ray] for ray in self.ahead)
        if any(range_m is not None and range_m < NEAR_M for range_m in ahead):
            motion = {"speed_m_s": 0.0, "turn_rate_rad_s": TURN_RAD_S}
        else:
            motion = {"speed_m_s": self.speed_m_s, "turn_rate_rad_s": 0.0}
        return {"motion": motion, "requests": [], "outbox": []}  # type: ignore[typeddict-item]


def turn(percepts: Percepts, memory: dict[str, Any]) -> Commands:
    """Return the commands of `Turner` for all robots at once."""
    body = percepts["body"]
    if not memory:
        memory["ahead"] = np.abs(body["rings"][0]["bearings_rad"]) < LOOKS_RAD
    ahead = percepts["scans"][0]["ranges_m"][:, memory["ahead"]]
    is_near = (ahead < NEAR_M).any(axis=1)
    return {
        "motion": {
            "speed_m_s": np.where(is_near, 0.0, body["max_speed_m_s"]),
            "turn_rate_rad_s": np.where(is_near, TURN_RAD_S, 0.0),
        }
    }


WAYS: dict[str, Any] = {
    "bundled": None,
    "batch": {"rover": Batch(turn)},
    "class": {"rover": Turner},
}


def main() -> None:
    """Print a table of robot updates per second of processor time, on one thread."""
    print("| robots | bundled brain | function on arrays | class per robot |")
    print("|---|---|---|---|")
    for robots in TEAMS:
        scenario = field(robots)
        runs = {way: Simulation(scenario, threads=1, brains=WAYS[way]) for way in WAYS}
        rates: dict[str, list[float]] = {way: [] for way in WAYS}
        for _ in range(1 + MEASUREMENTS):  # alternating; the first round warms up
            for way, run in runs.items():
                rates[way].append(rate(run, robots, max(1, UPDATES[way] // robots)))
        print(
            "|",
            " | ".join([f"{robots:,}", *(rounded(median(rates[way][1:])) for way in WAYS)]),
            "|",
        )


def rounded(number: float) -> str:
    """Return a number with three significant digits; further ones are noise."""
    return f"{float(f'{number:.3g}'):,.0f}"


def field(robots: int) -> Scenario:
    """Return a field for a number of robots, at a constant density."""
    side_m = 20 * (robots / 100) ** 0.5
    places = np.arange(PILLAR_M / 2, side_m, PILLAR_M)
    pillars = [
        f"{{ circle = {{ at_m = [{x_m}, {y_m}], radius_m = 0.4 }} }}"
        for x_m in places
        for y_m in places
    ]
    return Scenario.loads(FIELD.format(side_m=side_m, pillars=", ".join(pillars), robots=robots))


def rate(run: Simulation, robots: int, steps: int) -> float:
    """Return the robot updates per second over a number of steps."""
    begin = time.process_time()
    run.step(steps)
    return robots * steps / (time.process_time() - begin)


if __name__ == "__main__":
    main()
