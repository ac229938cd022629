"""Makes percepts of the readings of one robot. It reads no clock, so that a replay is exact."""

import hashlib
import math
from collections.abc import Mapping, Sequence
from typing import Any

from agent_economy.live.readings import COUNTS, Quantity, Reading
from agent_economy.runs.brain import Percept


class Percepts:
    """The newest readings of a robot, and its percepts.

    Attributes:
        is_driving: Whether the brain steps: the robot is armed, in automatic mode, and not held.
    """

    def __init__(self, name: str, base: Mapping[str, Any], seed: int, start_s: float) -> None:
        """Create it without readings.

        Args:
            name: The name of the robot.
            base: The parts of a percept that never change.
            seed: Seed of the random bits of percepts.
            start_s: The time at which the drive started, by the clock of the time stamps.
        """
        self.is_driving, self._is_moving = False, False
        self._name, self._base = name, base
        self._seed, self._start_s = seed, start_s
        self._readings: dict[Quantity, tuple[Any, float]] = {}
        self._ranges: dict[int, tuple[float, float]] = {}

    def add_reading(self, reading: Reading, at_s: float) -> None:
        """Take a reading, with its time stamp."""
        if reading.quantity is Quantity.RANGES:
            for sonar, range_m in enumerate(reading.values):
                if range_m is not None:
                    self._ranges[sonar] = (range_m, at_s)
            return
        value = _value(reading)
        if value is not None:
            self._readings[reading.quantity] = (value, at_s)

    def add_event(self, event: Any) -> None:
        """Take a change of the robot's state that the warden reports."""
        is_held = "held" in event.get("faults", ())
        is_auto = event.get("mode", "auto") == "auto"
        self.is_driving = event["is_armed"] and is_auto and not is_held
        self._is_moving = event["action"] == "move"

    def percept(self, tick: int, now_s: float, sonars: Sequence[int | None]) -> Percept:
        """Return the percept of a tick at a time; `sonars` has the sonar of each scan, if any."""
        percept: dict[str, Any] = {
            **self._base,
            "time_s": now_s - self._start_s,
            "random_words": random_words(self._seed, self._name, tick),
            "scans": [self._scan(sonar, now_s) for sonar in sonars],
        }
        for quantity, key in KEYS.items():
            if quantity in self._readings:
                value, at_s = self._readings[quantity]
                percept[key] = {"value": value, "age_s": now_s - at_s}
        if not self._is_moving:
            # The robot has no odometry, but stop has been commanded.
            percept["motion"] = {"value": {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}, "age_s": 0.0}
        return percept  # type: ignore[return-value]  # built by its keys

    def _scan(self, sonar: int | None, now_s: float) -> dict[str, Any]:
        missing = (math.nan, now_s)
        range_m, at_s = missing if sonar is None else self._ranges.get(sonar, missing)
        if math.isnan(range_m) or range_m < 0:
            return {"age_s": None, "ranges_m": []}
        return {"age_s": now_s - at_s, "ranges_m": [None if math.isinf(range_m) else range_m]}


def _value(reading: Reading) -> Any:
    """Return the value of a percept; None if the reading is impossible."""
    numbers = [value for value in reading.values if value is not None and math.isfinite(value)]
    if not len(numbers) == len(reading.values) == COUNTS.get(reading.quantity):
        return None
    match reading.quantity:
        case Quantity.POSITION:
            return numbers
        case Quantity.BATTERY:
            return min(1.0, max(0.0, *numbers))
    return numbers[0]


KEYS = {
    Quantity.POSITION: "position",
    Quantity.HEADING: "heading_rad",
    Quantity.BATTERY: "battery",
}


def random_words(seed: int, robot: str, tick: int) -> list[int]:
    """Return the random bits of a tick: the same on every machine."""
    digest = hashlib.blake2b(f"{seed} {robot} {tick}".encode(), digest_size=16).digest()
    return [int.from_bytes(digest[at : at + 4], "little") for at in range(0, 16, 4)]
