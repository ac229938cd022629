"""Decides which motor lines are due. Nothing here reads a clock."""

import math
from dataclasses import dataclass

from agent_economy._core import LocalFrame
from agent_economy.live.drivers.driver import Driver, PortLine, Settings
from agent_economy.live.frame import bearing_deg
from agent_economy.live.readings import Motion


@dataclass
class MotorLines:
    """The lines of one robot: each motion when it changes, then repeated.

    A turn of the robot's own coprocessor is requested once for each heading: a repeated line would
    restart it, and a motor line would cancel it. Brains keep the heading during a turn; another
    heading is another turn, which may follow at once.
    """

    driver: Driver
    settings: Settings
    frame: LocalFrame
    repeat_s: float
    _written: tuple[PortLine, ...] = ()
    _at_s: float = float("-inf")

    def due(self, motion: Motion, now_s: float, *, is_empty: bool) -> tuple[PortLine, ...]:
        """Return the lines to write now.

        Args:
            motion: What the robot is allowed to do.
            now_s: The time.
            is_empty: Whether all lines before have been acknowledged. Until then only a stop is
                written, and once: the last line that the robot reads is then a stop.
        """
        lines = self._lines(motion)
        is_same = lines == self._written
        is_turn = motion.heading_rad is not None and len(lines) > 0 and self._is_turn(lines)
        if is_same and (is_turn or now_s - self._at_s < self.repeat_s or not is_empty):
            return ()
        if not is_empty and not motion.is_stop:
            return ()
        self._written, self._at_s = lines, now_s
        return lines

    def forget(self) -> None:
        """Forget what was written: the next lines are due at once."""
        self._written, self._at_s = (), float("-inf")

    def _lines(self, motion: Motion) -> tuple[PortLine, ...]:
        if motion.is_stop:
            return self.driver.stop(self.settings)
        if motion.tracks is not None:
            return self.driver.move(motion, self.settings)
        if motion.heading_rad is not None:
            if not math.isfinite(motion.heading_rad):  # the rules pass no such motion
                return self.driver.stop(self.settings)
            to_deg = bearing_deg(self.frame, motion.heading_rad)
            lines = self.driver.turn_to(to_deg, self.settings)
            if lines:
                return lines
        return self.driver.move(motion, self.settings)

    def _is_turn(self, lines: tuple[PortLine, ...]) -> bool:
        return any(line.port != self.driver.motor_port for line in lines)
