"""The two tracks: their latched values, and the motion that follows from them."""

from agent_economy.live.emulator.lines import BOTH, LEFT, RIGHT, STOP, MotorCommand
from agent_economy.live.emulator.settings import Settings

NEUTRAL = 150
"""The value at which a track is at rest."""

Motion = tuple[float, float]
"""Forward speed in m/s, and anticlockwise turn rate in rad/s."""


class Tracks:
    """The values of both tracks. Each stays in force until the next command for it."""

    def __init__(self) -> None:
        """Start at rest."""
        self.left = self.right = NEUTRAL

    @property
    def is_neutral(self) -> bool:
        """Whether both are at rest."""
        return self.left == self.right == NEUTRAL

    def stop(self) -> None:
        """Stop both."""
        self.left = self.right = NEUTRAL

    def obey(self, command: MotorCommand) -> None:
        """Take over the value of a command."""
        if command.channel == STOP or command.value is None:
            self.stop()
        if command.channel in (LEFT, BOTH) and command.value is not None:
            self.left = command.value
        if command.channel in (RIGHT, BOTH) and command.value is not None:
            self.right = command.value

    def motion(self, settings: Settings) -> Motion:
        """Return the motion before the limits and the errors of the drive."""
        left, right = (speed_m_s(value, settings) for value in (self.left, self.right))
        turn_rate = (right - left) / settings.track_width_m
        return (left + right) / 2, turn_rate * (1 - settings.turn_slip)


def speed_m_s(value: int, settings: Settings) -> float:
    """Return the speed of a track for its value; it differs between forward and reverse."""
    is_forward = value >= NEUTRAL
    unit = settings.forward_m_s_per_unit if is_forward else settings.reverse_m_s_per_unit
    return (value - NEUTRAL) * unit
