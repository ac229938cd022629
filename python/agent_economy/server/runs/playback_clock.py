"""The tick that a run should have reached by now, at the playback speed."""

import math
from dataclasses import dataclass, field

MAX_LAG_S = 0.25
"""A run that is further behind, in wall-clock time, does not catch up the rest."""

AVERAGING_S = 1.0
"""Time constant of the average of the measured speed."""


@dataclass
class PlaybackClock:
    """The requested playback speed, and the one measured.

    Attributes:
        step_s: The simulated duration of a step.
        speed: The requested speed as a multiple of real time; None for as fast as possible.
        measured_speed: The recent speed as a multiple of real time.
    """

    step_s: float
    speed: float | None = 1.0
    measured_speed: float = 0.0
    _since: tuple[float, int] = field(default=(0.0, 0), repr=False)
    _last: tuple[float, int] = field(default=(0.0, 0), repr=False)

    def play(self, speed: float | None, now_s: float, tick: int, *, is_running: bool) -> None:
        """Play from a tick on; restart the measurement unless the run is already playing."""
        if not is_running:
            self.measured_speed, self._last = 0.0, (now_s, tick)
        self.speed = speed
        self._since = (now_s, tick)

    def set_step(self, step_s: float, now_s: float, tick: int) -> None:
        """Set the duration of the steps that follow a tick."""
        if step_s != self.step_s:
            self.step_s = step_s
            self._since = self._last = (now_s, tick)

    def target(self, now_s: float, tick: int) -> int | None:
        """Return the tick that the run should have reached; None for as far as possible."""
        if self.speed is None:
            return None
        since_s, first = self._since
        due = first + math.floor((now_s - since_s) * self.speed / self.step_s + 1e-9)
        last = tick + max(1, math.ceil(MAX_LAG_S * self.speed / self.step_s))
        if due > last:
            self._since = (now_s, last)
            return last
        return due

    def wait_s(self, now_s: float, tick: int) -> float:
        """Return the time until the next step is due."""
        if self.speed is None:
            return 0.0
        since_s, first = self._since
        due_s = since_s + (tick + 1 - first) * self.step_s / self.speed
        return max(0.0, due_s - now_s)

    def measure(self, now_s: float, tick: int) -> None:
        """Update the measured speed."""
        last_s, last = self._last
        elapsed_s = now_s - last_s
        if elapsed_s < AVERAGING_S / 10:
            return
        speed = (tick - last) * self.step_s / elapsed_s
        weight = min(1.0, elapsed_s / AVERAGING_S) if self.measured_speed else 1.0
        self.measured_speed += weight * (speed - self.measured_speed)
        self._last = (now_s, tick)
