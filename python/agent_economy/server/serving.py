"""How the application is served, by whichever program."""

import asyncio
import signal
import socket
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import uvicorn
from starlette.types import ASGIApp

from agent_economy.server.limits import ConnectionLimits, Limited, protocol_within
from agent_economy.server.request_body import MAX_BYTES

GRACE_S = 0.3
"""Time that clients have to take their last answers, and then their tasks to end."""

LAST_S = 1.2
"""Time for the end of everything: a calculation in a thread, or a study, may take longer."""

POLL_S = 0.02

AT_ONCE, QUEUE = 16, 1024
"""Connections that are accepted in one turn of the event loop, and those that wait for that. Few at
once: until they are counted they have descriptors, and one turn must not take all that are left."""

OF_CONNECTIONS = frozenset({"socket", "transport", "protocol"})
"""What asyncio reports with errors of a connection, or of accepting one."""

SIGNALS = (signal.SIGINT, signal.SIGTERM)


class HttpServer(uvicorn.Server):
    """A server that ends soon after a signal, and prints nothing of what its clients do.

    uvicorn would wait for requests that are never complete, and for answers that are never read;
    asyncio would print an error for each connection while no descriptor is left.
    """

    def __init__(
        self, config: uvicorn.Config, limits: ConnectionLimits, overdue: Callable[[], None]
    ) -> None:
        """Create it; `overdue` ends the process, when the server does not end in time."""
        super().__init__(config)
        self._limits, self._overdue = limits, overdue

    async def startup(self, sockets: list[socket.socket] | None = None) -> None:
        """Start to accept connections."""
        asyncio.get_running_loop().set_exception_handler(report_error)
        await super().startup(sockets)
        for listening in sockets or ():
            listening.listen(QUEUE)  # asyncio has reduced it to the number that it accepts at once

    async def on_tick(self, counter: int) -> bool:
        """Close what waits for too long; called ten times per second."""
        self._limits.close_late()
        return await super().on_tick(counter)

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


def report_error(loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
    """Report an error of the event loop, unless a client has caused it."""
    if not OF_CONNECTIONS & context.keys():
        loop.default_exception_handler(context)


def http_server(application: ASGIApp, overdue: Callable[[], None]) -> HttpServer:
    """Return a server of the application; run it with the sockets that it listens on.

    Args:
        application: What it serves.
        overdue: Ends the process; called in a thread, if the server does not end in time.
    """
    limits = ConnectionLimits()
    config = uvicorn.Config(
        Limited(application, limits),
        http=protocol_within(limits),
        backlog=AT_ONCE,
        # A field of a request must not replace the address of its connection.
        proxy_headers=False,
        # Whatever clients send, nothing of it is printed.
        log_level="error",
        ws="websockets-sansio",
        ws_max_size=MAX_BYTES,
        # Frames are floats, which compress badly: with 10,000 robots it took 7 ms each.
        ws_per_message_deflate=False,
        lifespan="on",
    )
    return HttpServer(config, limits, overdue)
