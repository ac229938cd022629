"""How far a run should have come by now."""

import math
from dataclasses import dataclass, field

BEHIND_S = 0.25
"""What a run is behind by more than so much, by the clock on the wall, is not made up for."""

REMEMBERED_S = 1.0
"""The speed that is reached is that of about so long."""


@dataclass
class PlaybackClock:
    """The speed that is wanted, and what is reached of it.

    Attributes:
        step_s: Time in the world that a step takes.
        speed: Times real time; None as fast as it can.
        is_playing: Whether the run goes on.
        reached: Times real time that it went of late.
    """

    step_s: float
    speed: float | None = 1.0
    is_playing: bool = False
    reached: float = 0.0
    _since: tuple[float, int] = field(default=(0.0, 0), repr=False)
    _last: tuple[float, int] = field(default=(0.0, 0), repr=False)

    def play(self, speed: float | None, now_s: float, tick: int) -> None:
        """Go on from a tick."""
        if not self.is_playing:
            self.reached, self._last = 0.0, (now_s, tick)
        self.speed, self.is_playing = speed, True
        self._since = (now_s, tick)

    def measure(self, step_s: float, now_s: float, tick: int) -> None:
        """Go on with steps that take so long."""
        if step_s != self.step_s:
            self.step_s = step_s
            self._since = self._last = (now_s, tick)

    def pause(self) -> None:
        """Stand."""
        self.is_playing = False

    def target(self, now_s: float, tick: int) -> int | None:
        """Return to which tick the run should have come; None if as far as it can."""
        if self.speed is None:
            return None
        since_s, first = self._since
        due = first + math.floor((now_s - since_s) * self.speed / self.step_s + 1e-9)
        most = tick + max(1, math.ceil(BEHIND_S * self.speed / self.step_s))
        if due > most:
            self._since = (now_s, most)
            return most
        return due

    def wait_s(self, now_s: float, tick: int) -> float:
        """Return how long it is until the next step is due."""
        if self.speed is None:
            return 0.0
        since_s, first = self._since
        due_s = since_s + (tick + 1 - first) * self.step_s / self.speed
        return max(0.0, due_s - now_s)

    def note(self, now_s: float, tick: int) -> None:
        """Note how far the run has come."""
        last_s, last = self._last
        took_s = now_s - last_s
        if took_s < REMEMBERED_S / 10:
            return
        speed = (tick - last) * self.step_s / took_s
        weight = min(1.0, took_s / REMEMBERED_S) if self.reached else 1.0
        self.reached += weight * (speed - self.reached)
        self._last = (now_s, tick)
