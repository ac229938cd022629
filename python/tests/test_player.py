"""What a player does with a run: whole stories, in fake time and without sockets."""

from dataclasses import dataclass, field

import pytest

from agent_economy import InputError
from agent_economy.server.runs.player import Idle, Paused, Player, Playing, Seeking
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

STEP_S = 0.1
SLICE_STEPS = 40
"""Steps that the fake run takes each time that it is advanced, at most."""


@dataclass
class FakeRun:
    """A run that is over after its last tick, and whose changes are named by their ticks."""

    last_tick: int = 1000
    tick: int = 0
    latest_tick: int = 0
    step_s: float = STEP_S
    changes: list[int] = field(default_factory=list)
    undone: list[int] = field(default_factory=list)

    @property
    def is_finished(self) -> bool:
        """Whether it is over."""
        return self.tick >= self.last_tick

    def change(self, path: str, value: object, *, replaces_last: bool = False) -> None:
        """Note the tick; 'refused' is not allowed."""
        if value == "refused":
            raise InputError(path)
        if replaces_last:
            self.changes.pop()
        self.changes.append(self.tick)
        self.latest_tick = self.tick

    def undo(self) -> None:
        """Forget the last change, at its tick."""
        self.undone.append(self.changes.pop())
        self.tick = self.latest_tick = self.undone[-1]

    def redo(self) -> None:
        """Make the change again that was undone last."""
        self.changes.append(self.undone.pop())

    def choose_version(self, number: int) -> None:
        """Keep only the first changes."""
        del self.changes[number:]

    def seek(self, tick: int) -> bool:
        """Move towards a tick; return whether it has arrived."""
        if tick < self.tick:
            self.tick = max(0, tick)
        self.tick = min(tick, self.tick + SLICE_STEPS, self.last_tick)
        self.latest_tick = max(self.latest_tick, self.tick)
        return self.tick >= tick or self.is_finished


class Story:
    """A player that is driven in fake time, as the session drives it in real time."""

    def __init__(self, run: FakeRun | None = None, tick: int = 0) -> None:
        """Open a run, and wait until it is at a tick."""
        self.run, self.player, self.now_s = run or FakeRun(), Player(), 100.0
        self.player.open(self.run, tick)
        self.settle()

    def say(self, *messages: PageMessage) -> None:
        """Hand messages to the player."""
        for message in messages:
            if not self.player.defers(message):
                self.player.handle(message, self.now_s)

    def advance(self) -> None:
        """Go once through the loop of the session."""
        while (ready := self.player.take_ready()) is not None:
            self.player.handle(ready, self.now_s)
        if (target := self.player.target(self.now_s)) is not None:
            self.player.advanced(self.now_s, has_arrived=self.run.seek(target))

    def settle(self) -> None:
        """Advance until the run has arrived, and deferred messages are carried out."""
        for _ in range(100):
            self.advance()
            if not isinstance(self.player.state, Seeking):
                self.advance()
                return
        pytest.fail("the run does not arrive")

    def wait(self, seconds: float) -> None:
        """Let time pass, in as many slices as the session would take."""
        end_s = self.now_s + seconds
        while self.now_s < end_s:
            self.now_s += 0.025
            self.advance()

    def at(self) -> tuple[int, object]:
        """Return the tick and the state."""
        return self.run.tick, self.player.state


def test_a_player_without_a_run_can_be_paused_and_nothing_else() -> None:
    player = Player()
    player.handle(Pause(), 0.0)
    assert player.state == Idle()
    assert player.wait_s(0.0) is player.target(0.0) is None
    for message in (
        Play(1.0),
        Step(1),
        Seek(1),
        Change("a", 1, replaces_last=False),
        Undo(),
        Redo(),
    ):
        with pytest.raises(InputError, match="after an open"):
            player.handle(message, 0.0)
    assert player.state == Idle()


def test_an_opened_run_seeks_its_tick_and_pauses_there() -> None:
    story = Story(tick=100)
    assert story.at() == (100, Paused())
    assert story.player.wait_s(story.now_s) is None


def test_a_playing_run_follows_the_clock_until_it_is_paused() -> None:
    story = Story()
    story.say(Play(2.0))
    story.wait(3.0)
    assert story.at() == (60, Playing())
    assert story.player.clock.measured_speed == pytest.approx(2.0, rel=0.1)
    story.say(Pause())
    story.wait(3.0)
    assert story.at() == (60, Paused())


def test_a_playing_run_waits_for_its_next_step() -> None:
    story = Story()
    story.say(Play(1.0))
    assert story.player.wait_s(story.now_s) == pytest.approx(STEP_S)
    assert story.player.wait_s(story.now_s + 0.07) == pytest.approx(STEP_S - 0.07)
    story.say(Play(None))
    assert story.player.wait_s(story.now_s) == 0.0


def test_a_run_at_full_speed_uses_its_time_slices_and_pauses_at_its_end() -> None:
    story = Story(FakeRun(last_tick=100))
    story.say(Play(None))
    story.advance()
    assert story.at() == (SLICE_STEPS, Playing())
    story.wait(1.0)
    assert story.at() == (100, Paused())


def test_a_run_that_lags_does_not_catch_up_more_than_a_quarter_of_a_second() -> None:
    story = Story()
    story.say(Play(1.0))
    story.now_s += 60
    story.advance()
    assert story.run.tick == 3
    story.wait(1.0)
    assert story.run.tick == 13


def test_a_change_of_speed_continues_from_the_current_tick() -> None:
    story = Story()
    story.say(Play(1.0))
    story.wait(2.0)
    story.say(Play(10.0))
    story.wait(1.0)
    assert story.run.tick == 120


def test_pending_steps_add_up_and_end_playback() -> None:
    story = Story()
    story.say(Play(1.0), *[Step(30)] * 5)
    assert story.at() == (0, Seeking(150))
    story.settle()
    assert story.at() == (150, Paused())
    story.say(Step(-1000))
    story.settle()
    assert story.at() == (0, Paused())


def test_a_seek_goes_no_further_than_the_latest_tick_and_replaces_another() -> None:
    story = Story(tick=300)
    story.say(Seek(50), Seek(900))
    assert story.player.target_tick == 300
    story.say(Seek(20))
    story.settle()
    assert story.at() == (20, Paused())


def test_what_is_requested_during_a_seek_is_carried_out_on_arrival() -> None:
    story = Story()
    story.say(Step(100), Change("a", 1, replaces_last=False), Play(1.0))
    story.advance()
    assert (story.run.changes, story.player.is_playing) == ([], False)
    story.settle()
    assert (story.run.changes, story.at()) == ([100], (100, Playing()))


def test_a_step_or_seek_behind_a_deferred_message_waits_too() -> None:
    story = Story()
    story.say(Step(100), Change("a", 1, replaces_last=False), Step(50), Seek(20))
    story.settle()
    story.settle()
    story.settle()
    assert (story.run.changes, story.at()) == ([100], (20, Paused()))


def test_pausing_ends_a_seek_and_cancels_deferred_playback_but_no_change() -> None:
    story = Story()
    story.say(Step(500), Play(1.0), Change("a", 1, replaces_last=False))
    story.advance()
    story.say(Pause())
    story.advance()
    assert (story.run.changes, story.at()) == ([SLICE_STEPS], (SLICE_STEPS, Paused()))


def test_of_deferred_changes_that_replace_each_other_only_the_last_is_made() -> None:
    story = Story()
    changes = [Change("a", value, replaces_last=value > 1) for value in (1, 2, 3)]
    story.say(Step(100), *changes)
    story.settle()
    assert story.run.changes == [100]


def test_undoing_returns_to_the_tick_and_continues_playback() -> None:
    story = Story(tick=100)
    story.say(Change("a", 1, replaces_last=False), Play(1.0))
    story.wait(10.0)
    tick = story.run.tick
    story.say(Undo())
    assert story.at() == (100, Seeking(tick, plays_after=True))
    assert story.player.is_playing
    story.settle()
    assert (story.run.changes, story.player.state) == ([], Playing())
    assert story.run.tick >= tick


def test_undoing_and_redoing_during_a_seek_is_immediate_unless_a_message_waits() -> None:
    story = Story(tick=200)
    story.say(Change("a", 1, replaces_last=False), Step(100), Undo())
    assert (story.run.changes, story.at()) == ([], (200, Seeking(300)))
    story.say(Redo())
    assert story.run.changes == [200]
    story.say(ChooseVersion(0))
    assert story.run.changes == []
    story.settle()
    story.say(Step(1000), Change("b", 1, replaces_last=False), Undo())
    assert story.run.changes == []
    story.settle()
    story.settle()
    assert (story.run.changes, story.at()) == ([], (1000, Paused()))


def test_a_change_that_is_refused_changes_no_state() -> None:
    story = Story(tick=10)
    story.say(Play(1.0))
    with pytest.raises(InputError):
        story.say(Change("a", "refused", replaces_last=False))
    assert story.at() == (10, Playing())


def test_a_run_that_cannot_be_advanced_pauses_and_the_rest_is_carried_out() -> None:
    story = Story()
    story.say(Step(500), Change("a", 1, replaces_last=False))
    story.player.failed()
    assert story.player.state == Paused()
    story.advance()
    assert story.run.changes == [0]


def test_opening_another_run_begins_with_its_own_clock() -> None:
    story = Story()
    story.say(Play(100.0))
    story.wait(1.0)
    story.player.clear_pending()
    story.player.open(FakeRun(), 5)
    assert story.player.state == Seeking(5)
    assert (story.player.clock.speed, story.player.clock.measured_speed) == (1.0, 0.0)


def test_messages_are_accepted_until_the_queue_is_full() -> None:
    story = Story()
    story.say(Step(500))
    for value in range(256):
        assert story.player.accepts_messages
        story.say(Change("a", value, replaces_last=False))
    assert not story.player.accepts_messages
