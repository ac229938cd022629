"""Saving a page's run while the page goes on: one recording at a time."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable
from concurrent.futures import Executor
from typing import Any

from agent_economy import given
from agent_economy._core import InputError
from agent_economy.server.messages import faults_of
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.recordings.writer import Saving

TOLD_S = 0.25
"""Between two words of how far it is."""

Tell = Callable[[dict[str, Any]], Awaitable[None]]


class Saver:
    """What saves the runs of one page."""

    def __init__(self, tell: Tell, shelf: RecordingStore, threads: Executor) -> None:
        """Begin without anything to save."""
        self._tell, self._shelf, self._threads = tell, shelf, threads
        self._saving: Saving | None = None
        self._task: asyncio.Task[None] | None = None

    def begin(self, course: RunHistory) -> None:
        """Save a run.

        Raises:
            InputError: If another is being saved, or there is no place for recordings.
        """
        is_free = self._task is None or self._task.done()
        given.check(
            is_free, "save", None, "one recording at a time: cancel the other, or wait for it"
        )
        self._saving = Saving(course, self._shelf.folder)
        self._task = asyncio.create_task(self._save(self._saving))

    def cancel(self) -> None:
        """Stop what is being saved, if anything is."""
        if self._saving is not None:
            self._saving.stop()

    async def end(self) -> None:
        """Stop, as the page has gone."""
        self.cancel()
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await asyncio.gather(self._task, return_exceptions=True)

    async def _save(self, saving: Saving) -> None:
        loop = asyncio.get_running_loop()
        work = loop.run_in_executor(self._threads, saving.write)
        try:
            while not work.done():
                steps = saving.course.latest_tick
                await self._tell({"type": "saving", "done": saving.done, "steps": steps})
                await asyncio.wait({work}, timeout=TOLD_S)
            file = work.result()
        except InputError as error:
            faults = faults_of(error)
            await self._tell({"type": "refused", "about": "save", "path": None, "faults": faults})
        else:
            row = None if file is None else await asyncio.to_thread(self._shelf.row, file)
            await self._tell({"type": "saved", "recording": row})
        finally:
            saving.stop()
