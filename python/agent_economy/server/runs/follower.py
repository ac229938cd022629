"""Moves a live run: it goes where its inputs go, and no page moves it elsewhere."""

from agent_economy._core import InputError
from agent_economy.server.runs.playback_clock import PlaybackClock
from agent_economy.server.runs.run import Run
from agent_economy.types.page import (
    Change,
    ChooseVersion,
    PageMessage,
    Pause,
    Play,
    Redo,
    Seek,
    Step,
    Undo,
)

MOVES = (Play, Pause, Step, Seek, Change, Undo, Redo, ChooseVersion)
"""Messages that move or change a run."""

REASON = (
    "This run is live: all pages display the present of the real robots. It cannot be played, "
    "paused, stepped, moved in time or changed"
)
"""Why messages that move or change the run are refused."""


class Follower:
    """The counterpart of `Player` for a live run, with the same methods.

    Attributes:
        clock: The speed that is measured.
    """

    def __init__(self, run: Run) -> None:
        """Follow a run."""
        self.clock = PlaybackClock(run.step_s)
        self._run = run

    @property
    def is_moving(self) -> bool:
        """Whether inputs can arrive."""
        return not self._run.is_finished

    @property
    def is_playing(self) -> bool:
        """Whether inputs can arrive."""
        return self.is_moving

    @property
    def target_tick(self) -> int | None:
        """None: the run seeks no tick."""
        return None

    @property
    def accepts_messages(self) -> bool:
        """Whether messages are carried out: always, since none has to wait."""
        return True

    def defers(self, message: PageMessage) -> bool:  # noqa: ARG002  (as `Player`)
        """Return False: no message has to wait."""
        return False

    def take_ready(self) -> PageMessage | None:
        """Return None: no message has waited."""
        return None

    def handle(self, message: PageMessage, now_s: float) -> None:  # noqa: ARG002  (as `Player`)
        """Refuse what moves or changes the run; other messages do nothing.

        Raises:
            InputError: If the message moves or changes the run.
        """
        if isinstance(message, MOVES):
            raise InputError(REASON)

    def target(self, now_s: float) -> int | None:  # noqa: ARG002  (as `Player`)
        """Return the tick to which there are inputs; None if the run is there."""
        latest = self._run.latest_tick
        return latest if self._run.tick < latest else None

    def advanced(self, now_s: float, *, has_arrived: bool) -> None:  # noqa: ARG002  (as `Player`)
        """Note that the run was advanced."""
        self.clock.measure(now_s, self._run.tick)

    def failed(self) -> None:
        """Note that the run could not be advanced: it has ended then."""

    def wait_s(self, now_s: float) -> float | None:
        """Return 0 if there are inputs to simulate; otherwise None."""
        return None if self.target(now_s) is None else 0.0
