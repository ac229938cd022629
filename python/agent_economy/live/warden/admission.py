"""Lets a bounded number of requests pass in each turn, in the order in which they came."""

import asyncio
from collections import deque

WINDOW_S, MAX_REQUESTS = 0.02, 25
"""Requests that pass in such a time: the warden has turns to take, whatever programs that have no
token send."""


class Admission:
    """A queue of requests that are to be read."""

    def __init__(self) -> None:
        """Let requests pass until there are too many of them."""
        self._waiting: deque[asyncio.Future[None]] = deque()
        self._left, self._is_counting = MAX_REQUESTS, False

    async def wait(self) -> None:
        """Return when another request may be read."""
        loop = asyncio.get_running_loop()
        if not self._is_counting:
            self._is_counting = True
            loop.call_later(WINDOW_S, self._next_window)
        if self._left > 0 and not self._waiting:
            self._left -= 1
            return
        turn = loop.create_future()
        self._waiting.append(turn)
        await turn

    def _next_window(self) -> None:
        self._left, self._is_counting = MAX_REQUESTS, bool(self._waiting)
        while self._waiting and self._left > 0:
            turn = self._waiting.popleft()
            if not turn.done():  # its connection has not ended meanwhile
                turn.set_result(None)
                self._left -= 1
        if self._is_counting:
            asyncio.get_running_loop().call_later(WINDOW_S, self._next_window)
