"""How a drive can end."""

from enum import Enum


class End(Enum):
    """Why a drive ended: its exit code, and the reason in words."""

    DONE = (0, "all waypoints and goals were reached")
    UNFINISHED = (1, "some waypoints or goals cannot be reached")
    INVALID = (2, "the fleet file or an argument is not valid")
    STOPPED = (3, "a robot was stopped and has to be armed again")
    NOT_READY = (4, "a robot could not be armed")
    INTERRUPTED = (130, "it was interrupted")

    @property
    def exit_code(self) -> int:
        """The exit code."""
        return int(self.value[0])

    @property
    def reason(self) -> str:
        """The reason."""
        return str(self.value[1])
