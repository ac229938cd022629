"""Samples the signals that a page has selected, beside the run that it displays."""

import asyncio
import time
from collections.abc import Awaitable, Callable, Sequence
from concurrent.futures import Executor
from functools import partial
from typing import TypeVar

from agent_economy._core import InputError
from agent_economy.server.messages import refused
from agent_economy.server.runs.run import Run
from agent_economy.server.runs.signals.sampler import Sampler
from agent_economy.types.page import ServerMessage

T = TypeVar("T")

SLICE_S = 0.02
"""The run is sampled for this long before other work is done."""

SEND_S = 0.25
"""Time between two messages, and until a sampled run is checked for new steps."""


class Sampling:
    """The sampling of one page."""

    def __init__(
        self, threads: Executor, post: Callable[[ServerMessage], None], has_room: Callable[[], bool]
    ) -> None:
        """Begin without signals.

        Args:
            threads: Where runs are simulated.
            post: Sends a message when the page has room for it.
            has_room: Returns whether it has room now.
        """
        self._threads, self._post, self._has_room = threads, post, has_room
        self._run: Run | None = None
        self._signals: tuple[str, ...] = ()
        self._sampler: Sampler | None = None
        self._news = asyncio.Event()

    def open(self, run: Run) -> None:
        """Sample another run."""
        self._run = run
        self._renew()

    def select(self, signals: Sequence[str]) -> None:
        """Sample these signals from now on."""
        self._signals = tuple(dict.fromkeys(signals))
        self._renew()

    async def drive(self) -> None:
        """Sample until this task is cancelled."""
        while True:
            run, signals = self._run, self._signals
            if run is None or not signals:
                self._news.clear()
                await self._news.wait()
                continue
            begun_s = time.monotonic()
            try:
                await self._sample_until(begun_s + SEND_S, run)
            except InputError as error:
                self._signals = ()
                self._post(refused("chart", error))
                continue
            if not self._is_behind:
                await asyncio.sleep(max(0.0, begun_s + SEND_S - time.monotonic()))

    def _renew(self) -> None:
        self._sampler = None
        self._news.set()

    @property
    def _is_behind(self) -> bool:
        return self._sampler is None or self._sampler.is_behind

    async def _sample_until(self, end_s: float, run: Run) -> None:
        """Sample until a time, or until nothing is left to sample, and send the samples."""
        signals = self._signals
        sampler = self._sampler
        if sampler is None:
            sampler = await self._in_thread(lambda: Sampler(run, signals))
        advance = partial(sampler.advance, SLICE_S)
        while time.monotonic() < end_s:
            await self._in_thread(advance)
            if not sampler.is_behind:
                break
        # Other signals or another run may have been selected meanwhile.
        if (self._run, self._signals) != (run, signals):
            return
        self._sampler = sampler
        if self._has_room() and (message := sampler.take()) is not None:
            self._post(message)

    def _in_thread(self, work: Callable[[], T]) -> Awaitable[T]:
        return asyncio.get_running_loop().run_in_executor(self._threads, work)
