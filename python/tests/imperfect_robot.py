"""An emulated Bender whose drive and sensors have errors.

The models of these errors are independent of those of the engine, and have their own random
numbers. Lines, tracks and world are the emulator's.
"""

import math
from collections import deque
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from agent_economy.live.drivers import PortLine
from agent_economy.live.emulator.faults import SENDING
from agent_economy.live.emulator.robot import Robot
from agent_economy.live.emulator.settings import Settings
from agent_economy.live.emulator.world import STEP_S, World
from agent_economy.scenario import Override, Scenario, TomlValue

ROBOT = "bender/0"
NEUTRAL = 150
"""The value at which a track is at rest."""

SPEED_LIMITS = (
    "robots.bender.drive.max_speed_m_s",
    "robots.bender.drive.max_reverse_speed_m_s",
)
TURN_RATE_LIMIT, TIME_LIMIT = "robots.bender.drive.max_turn_rate_deg_s", "clock.time_limit_s"
MAX_SPEED_M_S, MAX_TURN_RATE_DEG_S, MAX_TIME_S = 3.0, 360.0, 3600.0
"""Limits of the body in the world, beyond those of the scenario that the brain has."""

TRACK_WIDTH_M = 0.5
SUBSTEP_S = 0.005
"""The filter of the tracks advances by this; commands take effect at its multiples."""

FIX, COMPASS, SLIP, PHASE = range(4)
"""Streams of random numbers of one seed."""

Tracks = tuple[float, float]
"""Speeds of the left and the right track, in m/s."""


@dataclass(frozen=True)
class DriveErrors:
    """How the tracks differ from their commands.

    Attributes:
        delay_s: Dead time of each command.
        lag_s: Time constant of a first-order filter of each track; 0 for none.
        gain: Factor on the speed of both tracks.
        gain_left_right: Ratio of the gains of the left and the right track; their mean is `gain`.
        max_slip: The share of speed and of turn rate that slipping takes: each is redrawn between
            0 and this.
        slip_s: Time between two draws.
        blocked_from_s: Since when the robot is held at its place; infinite for never.
        blocked_s: For how long.
    """

    delay_s: float = 0.05
    lag_s: float = 0.0
    gain: float = 1.0
    gain_left_right: float = 1.0
    max_slip: float = 0.0
    slip_s: float = 10.0
    blocked_from_s: float = math.inf
    blocked_s: float = 10.0


@dataclass(frozen=True)
class SensorErrors:
    """Errors of fixes, along each axis, and of the compass.

    Attributes:
        noise_m: Standard deviation of white noise of each fix.
        noise_deg: Standard deviation of white noise of the compass.
        drift_m: Standard deviation of a slow drift of the fixes, a Gauss-Markov process.
        drift_s: Its correlation time.
        is_drift_stated: Whether the scenario of the brain states the drift; otherwise its noise has
            the standard deviation of both.
    """

    noise_m: float = 0.2
    noise_deg: float = 0.5
    drift_m: float = 0.0
    drift_s: float = 60.0
    is_drift_stated: bool = True

    def stated(self) -> dict[str, float]:
        """Return what the scenario of the brain states of the position sensor, by key."""
        if not self.is_drift_stated:
            return {"noise_m": math.hypot(self.noise_m, self.drift_m)}
        return {"noise_m": self.noise_m, "drift_m": self.drift_m, "drift_s": self.drift_s}


class Drive:
    """Turns commands of the tracks into the mean motion of each step."""

    def __init__(self, errors: DriveErrors, seed: int) -> None:
        """Create it at rest."""
        self._errors = errors
        self._random = np.random.default_rng([seed, SLIP])
        self._queue: deque[tuple[float, Tracks]] = deque()
        self._target: Tracks = (0.0, 0.0)
        self._tracks: Tracks = (0.0, 0.0)
        self._slip = (0.0, 0.0)
        self._slips_until_s = 0.0

    def command(self, time_s: float, speed_m_s: float, turn_rate_rad_s: float) -> None:
        """Take a command at a time, as speed and turn rate of an ideal drive."""
        half_m_s = turn_rate_rad_s * TRACK_WIDTH_M / 2
        tracks = speed_m_s - half_m_s, speed_m_s + half_m_s
        self._queue.append((time_s + self._errors.delay_s, tracks))

    def mean_motion(self, begin_s: float, step_s: float) -> tuple[float, float]:
        """Advance by a step; return its mean speed and turn rate."""
        count = round(step_s / SUBSTEP_S)
        tracks = [self._substep(begin_s + place * SUBSTEP_S) for place in range(count)]
        left, right = (sum(each) / count for each in zip(*tracks, strict=True))
        return self._on_ground(begin_s, left, right)

    def _substep(self, time_s: float) -> Tracks:
        while self._queue and self._queue[0][0] <= time_s + 1e-9:
            self._target = self._queue.popleft()[1]
        lag_s = self._errors.lag_s
        share = 1 - math.exp(-SUBSTEP_S / lag_s) if lag_s > 0 else 1.0
        left, right = self._tracks
        left += share * (self._target[0] - left)
        right += share * (self._target[1] - right)
        self._tracks = left, right
        return self._tracks

    def _on_ground(self, time_s: float, left_m_s: float, right_m_s: float) -> tuple[float, float]:
        errors, ratio = self._errors, self._errors.gain_left_right
        if 0 <= time_s - errors.blocked_from_s < errors.blocked_s:
            return 0.0, 0.0
        left_m_s *= errors.gain * 2 * ratio / (1 + ratio)
        right_m_s *= errors.gain * 2 / (1 + ratio)
        lost, lost_turn = self._slip_at(time_s)
        turn_rate = (right_m_s - left_m_s) / TRACK_WIDTH_M
        return (left_m_s + right_m_s) / 2 * (1 - lost), turn_rate * (1 - lost_turn)

    def _slip_at(self, time_s: float) -> tuple[float, float]:
        if self._errors.max_slip > 0 and time_s >= self._slips_until_s:
            lost, lost_turn = self._random.uniform(0.0, self._errors.max_slip, 2)
            self._slip = float(lost), float(lost_turn)
            self._slips_until_s += self._errors.slip_s
        return self._slip


class Sensors:
    """Adds the errors of a position sensor and of a compass to true values."""

    def __init__(self, errors: SensorErrors, seed: int) -> None:
        """Create them; the drift begins at a random value of its distribution."""
        self._errors = errors
        self._fix = np.random.default_rng([seed, FIX])
        self._compass = np.random.default_rng([seed, COMPASS])
        self._drift_m = self._fix.normal(0.0, errors.drift_m, 2)
        self._time_s = 0.0

    def position(self, at_m: tuple[float, float], time_s: float) -> tuple[float, float]:
        """Return a fix at a time, which is later than that of the fix before."""
        errors = self._errors
        kept = math.exp(-(time_s - self._time_s) / errors.drift_s)
        self._time_s = time_s
        new_m = self._fix.normal(0.0, errors.drift_m * math.sqrt(1 - kept * kept), 2)
        self._drift_m = kept * self._drift_m + new_m
        x_m, y_m = at_m + self._drift_m + self._fix.normal(0.0, errors.noise_m, 2)
        return float(x_m), float(y_m)

    def heading_rad(self, heading_rad: float) -> float:
        """Return a measured heading."""
        return heading_rad + math.radians(self._compass.normal(0.0, self._errors.noise_deg))


def phases(seed: int, count: int) -> list[float]:
    """Return shares of periods by which periodic events are offset."""
    return [float(each) for each in np.random.default_rng([seed, PHASE]).random(count)]


def overrides(values: Mapping[str, TomlValue]) -> tuple[Override, ...]:
    """Return changes of a scenario, by path."""
    return tuple(Override.at(path, value, "measurement") for path, value in values.items())


IDEAL: dict[str, Any] = {
    "gps_noise_m": 0.0,
    "gps_drift_m": 0.0,
    "compass_noise_deg": 0.0,
    "lag_s": 0.0,
    "delay_s": 0.0,
    "gain_left_right": 1.0,
}
"""Settings of the emulator without errors: those of a case are added here."""


class EmulatedRobot:
    """The robot in its world; its lines have the errors of a case."""

    def __init__(
        self, scenario: Scenario, drive: DriveErrors, sensors: SensorErrors, seed: int
    ) -> None:
        """Create it at rest, in the world of the scenario that the brain has."""
        settings = Settings(**IDEAL)
        # The drive errors may exceed the limits that the brain knows.
        free = dict.fromkeys(SPEED_LIMITS, MAX_SPEED_M_S)
        free |= {TURN_RATE_LIMIT: MAX_TURN_RATE_DEG_S, TIME_LIMIT: MAX_TIME_S}
        self._world = World(scenario.changed(overrides(free)), 1, seed, settings)
        self._robot = Robot(ROBOT, self._world.frame, self._world.max_range_m, settings)
        self._drive = Drive(drive, seed)
        self._sensors = Sensors(sensors, seed)
        rates = {port: getattr(settings, f"{port}_hz") for port in SENDING}
        self._period = {port: round(1 / (rate * STEP_S)) for port, rate in rates.items()}
        shares = phases(seed, len(SENDING))
        self._first = {
            port: int(share * period)
            for share, (port, period) in zip(shares, self._period.items(), strict=True)
        }
        self._settings, self._steps = settings, 0
        self._before = self._pose = self._world.pose(ROBOT)

    @property
    def time_s(self) -> float:
        """The time of the world."""
        return self._steps * STEP_S

    @property
    def contacts(self) -> int:
        """The number of contacts with walls until now."""
        return self._world.collisions

    def tracks(self) -> tuple[int, int]:
        """Return the values of both tracks, relative to their neutral value."""
        return self._robot.tracks.left - NEUTRAL, self._robot.tracks.right - NEUTRAL

    def obey(self, line: PortLine, time_s: float) -> None:
        """Obey a line at a time."""
        self._robot.obey(line.port, line.data.strip(), time_s)
        self._drive.command(time_s, *self._robot.tracks.motion(self._settings))

    def step(self) -> None:
        """Advance the world by one step."""
        motion = self._drive.mean_motion(self.time_s, STEP_S)
        self._world.step({ROBOT: motion})
        self._steps += 1
        self._robot.senses = self._world.senses(ROBOT, self._robot.senses)
        self._before, self._pose = self._pose, self._world.pose(ROBOT)

    def place(self, time_s: float) -> tuple[float, float]:
        """Return its true position at a time within the next step."""
        share = (time_s - self.time_s) / STEP_S
        x_m = self._pose.x_m + share * (self._pose.x_m - self._before.x_m)
        return x_m, self._pose.y_m + share * (self._pose.y_m - self._before.y_m)

    def lines(self) -> Iterator[tuple[str, bytes]]:
        """Yield the lines that are due after a step, with their ports."""
        senses = self._robot.senses
        for port in SENDING:
            if self._steps % self._period[port] != self._first[port]:
                continue
            if port == "gps" and senses.at_m is not None:
                at_m = self._sensors.position(senses.at_m, self.time_s)
                self._robot.senses = replace(senses, at_m=at_m)
            elif port == "compass" and senses.heading_rad is not None:
                heading_rad = self._sensors.heading_rad(senses.heading_rad)
                self._robot.senses = replace(senses, heading_rad=heading_rad)
            line = self._robot.line(port)
            self._robot.senses = senses
            if line is not None:
                yield port, line
