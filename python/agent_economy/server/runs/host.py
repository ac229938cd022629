"""A run, the player that moves it, and the pages that display it.

One task drives a host, and only this task uses its run: it carries out the messages of the pages,
advances the run in a thread for a short time, and gives each page what is due. Pages send by
themselves: a slow page gets fewer frames, costs no memory and delays no other page.
"""

import asyncio
import contextlib
import time
from collections.abc import Callable
from concurrent.futures import Executor
from typing import Protocol, TypeVar

from agent_economy._core import InputError
from agent_economy.scenario import validation
from agent_economy.server import messages
from agent_economy.server.runs.follower import Follower
from agent_economy.server.runs.live_run import LiveRun
from agent_economy.server.runs.player import Player
from agent_economy.server.runs.run import Run
from agent_economy.server.runs.timeline import Timeline
from agent_economy.types.page import PageMessage, ServerMessage

SLICE_S = 0.025
"""A run is advanced for this long before messages are read again."""

T = TypeVar("T")


class HostedPage(Protocol):
    """What a host needs of a page. Nothing of it waits for the page."""

    def has_messages(self) -> bool:
        """Return whether a message can be carried out now."""

    async def carry_out_messages(self, host: "RunHost") -> None:
        """Carry out the messages that have arrived."""

    async def carry_out(self, message: PageMessage) -> None:
        """Carry out a message that had to wait."""

    def post(self, message: ServerMessage) -> None:
        """Send a message when the page has room for it."""

    def refresh(self) -> None:
        """Note that the page has not been sent the current moment."""

    def wait_s(self, host: "RunHost", now_s: float) -> float | None:
        """Return the time until the page is due to be sent something; None if it is not."""

    async def show(self, host: "RunHost") -> None:
        """Send what is due."""


class RunHost:
    """A run with its player and its pages.

    A run with a past belongs to one page, which moves it; a live run is shared by all its pages.

    Attributes:
        player: What moves the run.
    """

    player: Player | Follower

    def __init__(self, threads: Executor) -> None:
        """Begin without a run and without pages."""
        self._threads = threads
        self._run: Run | None = None
        self._pages: list[HostedPage] = []
        self._news = asyncio.Event()
        self._was_moving = False
        self.close()

    @property
    def run(self) -> Run:
        """The run.

        Raises:
            InputError: If none is open.
        """
        validation.check(self._run is not None, "message", None, "after an open")
        assert self._run is not None  # noqa: S101  (checked above)
        return self._run

    @property
    def has_run(self) -> bool:
        """Whether a run is open."""
        return self._run is not None

    def open(self, timeline: Timeline, tick: int) -> None:
        """Replace the run, and move to a tick."""
        self._run, self.player = timeline, Player()
        self.player.open(timeline, tick)

    def follow(self, run: LiveRun) -> None:
        """Replace the run by a live one."""
        self._run, self.player = run, Follower(run)

    def close(self) -> None:
        """Forget the run."""
        self._run, self.player = None, Player()

    def join(self, page: HostedPage) -> None:
        """Begin to serve a page."""
        self._pages.append(page)
        self.wake()

    def leave(self, page: HostedPage) -> None:
        """No longer serve a page."""
        if page in self._pages:
            self._pages.remove(page)

    def wake(self) -> None:
        """Note that there may be something to do."""
        self._news.set()

    async def drive(self) -> None:
        """Serve the pages until this task is cancelled."""
        while True:
            await self._wait()
            await self._carry_out_messages()
            await self._advance()
            for page in tuple(self._pages):
                await page.show(self)

    async def in_thread(self, work: Callable[[], T]) -> T:
        """Return what a function returns, without blocking other hosts."""
        return await asyncio.get_running_loop().run_in_executor(self._threads, work)

    async def _wait(self) -> None:
        """Wait until there is something to do."""
        self._news.clear()
        if any(page.has_messages() for page in self._pages):
            return
        now_s = time.monotonic()
        waits_s = [self.player.wait_s(now_s), *(page.wait_s(self, now_s) for page in self._pages)]
        wait_s = min((each for each in waits_s if each is not None), default=None)
        if wait_s == 0 or self._was_moving != self.player.is_moving:
            return
        # `wait_for` may lose the cancellation of this task when the page disconnects.
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(wait_s):
                await self._news.wait()

    async def _carry_out_messages(self) -> None:
        while (ready := self.player.take_ready()) is not None:
            # Only a run with a past keeps messages, and it has one page.
            for page in tuple(self._pages):
                await page.carry_out(ready)
        for page in tuple(self._pages):
            await page.carry_out_messages(self)

    async def _advance(self) -> None:
        """Advance the run for a short time, if it moves."""
        run, player = self._run, self.player
        if run is not None and (target := player.target(time.monotonic())) is not None:
            await self._advance_towards(target, run)
        if self._was_moving != player.is_moving:
            self._was_moving = player.is_moving
            self._refresh()

    async def _advance_towards(self, target: int, run: Run) -> None:
        before, is_seeking = run.tick, self.player.target_tick is not None
        try:
            has_arrived = await self.in_thread(lambda: run.seek(target, SLICE_S))
        except InputError as error:
            self.player.failed()
            for page in self._pages:
                page.post(messages.refused("seek", error))
            return
        self.player.advanced(time.monotonic(), has_arrived=has_arrived)
        if is_seeking or run.tick != before:
            self._refresh()

    def _refresh(self) -> None:
        for page in self._pages:
            page.refresh()
