"""An event loop in a thread of its own: what it runs has a time limit, and ends with it."""

import asyncio
import contextlib
import threading
from collections.abc import Coroutine
from typing import Any, TypeVar

END_S = 2.0
"""Time limit for what a loop runs to end after it was cancelled."""

T = TypeVar("T")


class LoopThread:
    """A running event loop. Coroutines run in it until they end, are late, or the loop ends."""

    def __init__(self, name: str) -> None:
        """Start it."""
        self._loop = asyncio.new_event_loop()
        # What fails after its caller has stopped waiting concerns no caller.
        self._loop.set_exception_handler(lambda *_: None)
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def thread(self) -> int | None:
        """The identity of its thread."""
        return self._thread.ident

    def call(self, coroutine: Coroutine[Any, Any, T], limit_s: float) -> T:
        """Run a coroutine and return its result; it is cancelled when its caller stops waiting.

        Raises:
            TimeoutError: If it takes longer than its limit.
            RuntimeError: If the loop has ended; or any error that the coroutine raises.
        """
        try:
            future = asyncio.run_coroutine_threadsafe(coroutine, self._loop)
        except RuntimeError:  # It has ended.
            coroutine.close()
            raise
        try:
            return future.result(limit_s)
        except BaseException:
            future.cancel()
            raise

    def end(self) -> None:
        """Cancel all that runs in it, and end it."""
        with contextlib.suppress(RuntimeError):  # It has ended.
            self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join(2 * END_S)

    def _run(self) -> None:
        asyncio.set_event_loop(self._loop)
        try:
            self._loop.run_forever()
        finally:
            tasks = asyncio.all_tasks(self._loop)
            for task in tasks:
                task.cancel()
            if tasks:
                self._loop.run_until_complete(asyncio.wait(tasks, timeout=END_S))
            self._loop.run_until_complete(self._loop.shutdown_asyncgens())
            self._loop.close()
