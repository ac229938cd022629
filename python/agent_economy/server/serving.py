"""How the application is served, by whichever program."""

import asyncio
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import uvicorn
from starlette.types import ASGIApp

from agent_economy.server.request_body import MAX_BYTES

GRACE_S = 0.3
"""Time that clients have to take their last answers, and then their tasks to end."""

LAST_S = 1.2
"""Time for the end of everything: a calculation in a thread, or a study, may take longer."""

POLL_S = 0.02

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class Server(uvicorn.Server):
    """A server that ends soon after a signal, whatever its clients do.

    uvicorn would wait for requests that are never complete, and for answers that are never read.
    """

    def __init__(self, config: uvicorn.Config, overdue: Callable[[], None]) -> None:
        """Create it; `overdue` ends the process, when the server does not end in time."""
        super().__init__(config)
        self._overdue = overdue

    @contextmanager
    def capture_signals(self) -> Iterator[None]:
        """End after a signal, without the default reaction to it after that."""
        if threading.current_thread() is not threading.main_thread():
            yield
            return
        before = {each: signal.signal(each, self.handle_exit) for each in SIGNALS}
        try:
            yield
        finally:
            for each, handler in before.items():
                signal.signal(each, handler)

    async def shutdown(self, sockets: list[socket.socket] | None = None) -> None:
        """Close all connections: first those that agree, then the others."""
        timer = threading.Timer(LAST_S, self._overdue)
        timer.daemon = True
        timer.start()
        for listening in (*self.servers, *(sockets or ())):
            listening.close()
        for connection in list(self.server_state.connections):
            connection.shutdown()
        await self._wait_for_clients()
        for connection in list(self.server_state.connections):
            connection.transport.abort()
        await self._wait_for_clients()
        await self.lifespan.shutdown()
        # The threads of requests; asyncio would wait for them without a limit.
        await asyncio.get_running_loop().shutdown_default_executor()
        timer.cancel()

    async def _wait_for_clients(self) -> None:
        state, end_s = self.server_state, time.monotonic() + GRACE_S
        while (state.connections or state.tasks) and time.monotonic() < end_s:
            await asyncio.sleep(POLL_S)


def http_server(application: ASGIApp, overdue: Callable[[], None]) -> Server:
    """Return a server of the application; run it with the sockets that it listens on.

    Args:
        application: What it serves.
        overdue: Ends the process; called in a thread, if the server does not end in time.
    """
    config = uvicorn.Config(
        application,
        # Whatever clients send, nothing of it is printed.
        log_level="error",
        ws="websockets-sansio",
        ws_max_size=MAX_BYTES,
        # Frames are floats, which compress badly: with 10,000 robots it took 7 ms each.
        ws_per_message_deflate=False,
        lifespan="on",
    )
    return Server(config, overdue)
