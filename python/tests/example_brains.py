"""Python brains for tests, and a scenario with simple robots."""

import math
from typing import Any

import numpy as np
from metric import world

from agent_economy.runs.brain import Body, Command, Percept

SMALL = world("""
clock.time_limit_s = 60
world.size_m = [12, 8]
items.mine.count = 2
[robots.bumper]
radius_m = 0.2
count = 3
drive = { max_speed_m_s = 0.6, max_turn_rate_deg_s = 90, max_acceleration_m_s2 = 0.5 }
radio = { range_m = 5, loss_probability = 0.1, delay_s = 0.3 }
sensors.mates = { kind = "robots", range_m = 4, latency_s = 0.4 }
brain = { rate_hz = 4, behaviours = [{ kind = "cruise" }, { kind = "random_bounce" }] }
sensors.eye = { kind = "items", range_m = 0.5, rate_hz = 2, detection_probability.mine = 0.5,
    false_alarm_rate_per_m2_s.mine = 0.5 }
""")
"""Robots without range sensors that bounce off contacts, with latencies and false alarms."""

AHEAD: Command = {
    "motion": {"speed_m_s": 9.0, "turn_rate_rad_s": 0.1},
    "heading_rad": None,
    "requests": [],
    "outbox": [],
}


class Ahead:
    """Drives along an arc."""

    def __init__(self, body: Body) -> None:
        """Create the brain of a body."""
        self.body = body

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""
        del percept
        return AHEAD


class Talker(Ahead):
    """Reports each contact at a fixed place, turns by its messages, and switches a sensor."""

    def __init__(self, body: Body) -> None:
        """Create the brain of a body."""
        super().__init__(body)
        self.steps = 0

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""
        self.steps += 1
        senders = sum(each["from"]["index"] + 1 for each in percept["inbox"])
        # Without an observation of its own, which a batch cannot send either.
        provenance = {"observer": {"kind": 0, "index": 0}, "track_id": 0, "observations": 0}
        about: Any = {"item": {"kind": 0, "at": [1.0, 2.0], "provenance": provenance}}
        return {
            "motion": {
                "speed_m_s": 0.1 + 0.1 * len(percept["neighbours"]),
                "turn_rate_rad_s": 0.2 * senders + percept["random_words"][0] / 2**33,
            },
            "heading_rad": None,
            "requests": [{"sensor": 1, "on": self.steps % 5 != 0}],
            "outbox": [{"about": about, "confidence": 0.5} for _ in percept["contacts"]],
            "acts": [],
        }


class Bumper:
    """Reproduces `cruise` and `random_bounce` in a body without a range sensor and a compass."""

    def __init__(self, body: Body) -> None:
        """Create the brain of a body."""
        self.body = body
        self.time_s: float | None = None
        self.since_s: np.float32 | None = None
        self.left_rad: np.float32 | None = None
        self.patience_s = np.float32(0)

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""
        touch, wheels = percept["touch"], percept["motion"]
        assert touch is not None
        assert wheels is not None
        self.elapsed_s = self.elapsed(percept["time_s"])
        turned_rad = wheels["value"]["turn_rate_rad_s"] * self.elapsed_s
        left_rad = self.left(percept["random_words"], turned_rad, is_held=touch["value"])
        most = self.body["max_turn_rate_rad_s"]
        turn = left_rad / self.body["period_s"]
        speed_m_s = 0.0 if left_rad else self.body["max_speed_m_s"]
        motion = {"speed_m_s": speed_m_s, "turn_rate_rad_s": min(max(turn, -most), most)}
        return {"motion": motion, "requests": [], "outbox": []}  # type: ignore[typeddict-item]

    def elapsed(self, time_s: float) -> float:
        """Return the time since the previous percept: a step is not always one period long."""
        before_s, self.time_s = self.time_s, time_s
        period_s = self.body["period_s"]
        elapsed_s = period_s if before_s is None else time_s - before_s
        return period_s if math.isclose(elapsed_s, period_s, rel_tol=1e-9) else elapsed_s

    def left(self, random_words: Any, turned_rad: float, *, is_held: bool) -> float:
        """Return the remaining angle of a turn; 0 while it drives straight."""
        if self.left_rad is not None:
            self.left_rad -= np.float32(turned_rad)
            self.patience_s -= np.float32(0 if is_held else self.elapsed_s)
            if abs(self.left_rad) > np.float32(0.02) and self.patience_s > 0:
                return float(self.left_rad)
            self.left_rad, self.since_s = None, None
            return 0.0
        was_s, elapsed_s = self.since_s, np.float32(self.elapsed_s)
        self.since_s = np.float32(0) if was_s is None else was_s + elapsed_s
        if not is_held or self.since_s < 0.5:
            return 0.0
        least = math.pi / 4
        left_rad = least + (math.tau - least - least) * (random_words[1] / 2**32)
        left_rad -= math.tau if left_rad > math.pi else 0.0
        patience_s = 1 + 2 * abs(left_rad) / self.body["max_turn_rate_rad_s"]
        self.left_rad, self.patience_s = np.float32(left_rad), np.float32(min(patience_s, 60))
        return float(left_rad)
