"""Saves the run of a page in the background, one recording at a time."""

import asyncio
import contextlib
from collections.abc import Awaitable, Callable
from concurrent.futures import Executor

from agent_economy._core import InputError
from agent_economy.scenario import validation
from agent_economy.server.messages import refused
from agent_economy.server.recordings.history import RunHistory
from agent_economy.server.recordings.store import RecordingStore
from agent_economy.server.recordings.writer import RecordingWriter
from agent_economy.types.page import ServerMessage

PROGRESS_S = 0.25
"""Time between two progress messages."""

Send = Callable[[ServerMessage], Awaitable[None]]


class Saver:
    """Saves the runs of one page."""

    def __init__(self, send: Send, store: RecordingStore, threads: Executor) -> None:
        """Begin with nothing to save."""
        self._send, self._store, self._threads = send, store, threads
        self._writer: RecordingWriter | None = None
        self._task: asyncio.Task[None] | None = None

    def begin(self, history: RunHistory) -> None:
        """Save a run.

        Raises:
            InputError: If another recording is being saved, or the folder of recordings is not
                allowed.
        """
        is_free = self._task is None or self._task.done()
        validation.check(
            is_free, "save", None, "one recording at a time: cancel the other, or wait for it"
        )
        self._writer = RecordingWriter(history, self._store.folder)
        self._task = asyncio.create_task(self._save(self._writer))

    def cancel(self) -> None:
        """Cancel the recording that is being saved, if there is one."""
        if self._writer is not None:
            self._writer.cancel()

    async def end(self) -> None:
        """Cancel, since the page has disconnected."""
        self.cancel()
        if self._task is not None:
            self._task.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await asyncio.gather(self._task, return_exceptions=True)

    async def _save(self, writer: RecordingWriter) -> None:
        loop = asyncio.get_running_loop()
        work = loop.run_in_executor(self._threads, writer.write)
        try:
            while not work.done():
                steps = writer.history.latest_tick
                await self._send({"type": "saving", "done": writer.done, "steps": steps})
                await asyncio.wait({work}, timeout=PROGRESS_S)
            file = work.result()
        except InputError as error:
            await self._send(refused("save", error))
        else:
            row = None if file is None else await asyncio.to_thread(self._store.row, file)
            await self._send({"type": "saved", "recording": row})
        finally:
            writer.cancel()
