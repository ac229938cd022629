"""The state machine of a run that a page watches: it decides where the run goes next.

It has no clock, thread or socket: time is an argument, and its caller advances the
run between `target` and `advanced`.

    Idle --open--> Seeking --arrived--> Paused --play--> Playing --pause, end of run--> Paused
    Paused, Playing, Seeking --step, seek, undo, redo--> Seeking --pause--> Paused
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from agent_economy.scenario import TomlValue, validation
from agent_economy.server.runs.pending import PendingQueue
from agent_economy.server.runs.playback_clock import PlaybackClock
from agent_economy.server.runs.run import FOREVER, Progress
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


class ReversibleRun(Progress, Protocol):
    """What a player needs of a run that can be moved back and forth; see `Timeline`."""

    def change(self, path: str, value: TomlValue, *, replaces_last: bool = False) -> None:
        """Set a value of the scenario from now on."""

    def undo(self) -> None:
        """Return to the version in which the last change was made."""

    def redo(self) -> None:
        """Return to the version that was left by the last `undo`."""

    def choose_version(self, number: int) -> None:
        """Display another version."""


@dataclass(frozen=True)
class Idle:
    """No run is open."""


@dataclass(frozen=True)
class Paused:
    """The run stays at its tick."""


@dataclass(frozen=True)
class Playing:
    """The run follows the playback clock."""


@dataclass(frozen=True)
class Seeking:
    """The run is on its way to a tick, as fast as possible.

    Attributes:
        target: That tick.
        plays_after: Whether playback continues on arrival.
    """

    target: int
    plays_after: bool = False


State = Idle | Paused | Playing | Seeking


class Player:
    """A run and the state of its playback.

    Attributes:
        state: The current state.
        clock: The playback speed that was requested, and the one measured.
    """

    def __init__(self) -> None:
        """Begin without a run."""
        self.state: State = Idle()
        self.clock = PlaybackClock(0.1)
        self._run: ReversibleRun | None = None
        self._pending = PendingQueue()

    @property
    def run(self) -> ReversibleRun:
        """The open run.

        Raises:
            InputError: If no run is open.
        """
        validation.check(self._run is not None, "message", None, "after an open")
        assert self._run is not None  # noqa: S101  (checked above)
        return self._run

    @property
    def is_moving(self) -> bool:
        """Whether the run is to be advanced."""
        return isinstance(self.state, Playing | Seeking)

    @property
    def is_playing(self) -> bool:
        """Whether the run plays, or continues to after a seek."""
        match self.state:
            case Playing() | Seeking(plays_after=True):
                return True
            case _:
                return False

    @property
    def target_tick(self) -> int | None:
        """The tick that the run is on its way to; None unless it is seeking."""
        return self.state.target if isinstance(self.state, Seeking) else None

    @property
    def accepts_messages(self) -> bool:
        """Whether there is room for another message to wait."""
        return not self._pending.is_full

    def defers(self, message: PageMessage) -> bool:
        """Keep a message that has to wait until the run arrives; return whether it does."""
        if not isinstance(self.state, Seeking) or not self._pending.waits(message):
            return False
        self._pending.put(message)
        return True

    def take_ready(self) -> PageMessage | None:
        """Remove and return the next deferred message, once the run has arrived."""
        return self._pending.take() if self._pending and self.target_tick is None else None

    def clear_pending(self) -> None:
        """Forget deferred messages."""
        self._pending.clear()

    def open(self, run: ReversibleRun, tick: int) -> None:
        """Replace the run, and seek a tick."""
        self._run, self.state = run, Seeking(tick)
        self.clock = PlaybackClock(run.step_s)

    def handle(self, message: PageMessage, now_s: float) -> None:
        """Carry out what a page requests of the run; other messages do nothing.

        Raises:
            InputError: If it is not allowed; nothing has changed then.
        """
        match message:
            case Play(speed=speed):
                self.clock.play(speed, now_s, self.run.tick, is_running=self.is_playing)
                self.state = Playing()
            case Pause():
                self._pending.remove_plays()
                self._pause()
            case Step(steps=steps):
                # Steps add up while earlier ones are still pending.
                self.state = Seeking(max(0, self._destination() + steps))
            case Seek(tick=tick):
                self.state = Seeking(min(tick, self.run.latest_tick))
            case Change(path=path, value=value, replaces_last=replaces_last):
                self.run.change(path, value, replaces_last=replaces_last)
            case Undo():
                self._move(self.run.undo)
            case Redo():
                self._move(self.run.redo)
            case ChooseVersion(version=version):
                self._move(lambda: self.run.choose_version(version))

    def _move(self, move: Callable[[], None]) -> None:
        """Display another version of the run, at the same tick."""
        target = self._destination()
        move()
        self.state = Seeking(target, plays_after=self.is_playing)

    def target(self, now_s: float) -> int | None:
        """Return the tick that the run should be advanced towards; None if it stays."""
        match self.state:
            case Seeking(target=target):
                self.clock.set_step(self.run.step_s, now_s, self.run.tick)
                return target
            case Playing():
                self.clock.set_step(self.run.step_s, now_s, self.run.tick)
                due = self.clock.target(now_s, self.run.tick)
                return FOREVER if due is None else due
            case _:
                return None

    def advanced(self, now_s: float, *, has_arrived: bool) -> None:
        """Note that the run was advanced towards `target`."""
        is_playing = self.is_playing
        if is_playing:
            self.clock.measure(now_s, self.run.tick)
        if isinstance(self.state, Seeking) and has_arrived:
            self.state = Playing() if is_playing else Paused()
        if isinstance(self.state, Playing) and self.run.is_finished:
            self._pause()

    def failed(self) -> None:
        """Note that the run could not be advanced."""
        self._pause()

    def wait_s(self, now_s: float) -> float | None:
        """Return the time until the run is to be advanced; None if it stays."""
        match self.state:
            case Seeking():
                return 0.0
            case Playing():
                return self.clock.wait_s(now_s, self.run.tick)
            case _:
                return None

    def _pause(self) -> None:
        self.state = Idle() if self._run is None else Paused()

    def _destination(self) -> int:
        return self.run.tick if self.target_tick is None else self.target_tick
