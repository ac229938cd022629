"""The connection to a Dask cluster: it is complete within a time limit, or nothing of it remains.

`distributed.Client` waits for ever for what accepts a connection and does not answer, fails with
any error at what is no scheduler, and then leaves a thread with its event loop.
"""

import asyncio
import contextlib
import socket
import struct
import threading
import time
from collections.abc import Iterator, Mapping
from typing import Any
from urllib.parse import urlsplit

from agent_economy._core import InputError
from agent_economy.build import own_build
from agent_economy.scenario.validation import check, is_text
from agent_economy.study.loop_thread import LoopThread

ANSWER_S = 2.0
"""Time limit for the answer of a scheduler that is connected."""

CLOSE_S = 2.0
"""Time limit for a connection to close."""

CONNECTING = 0.9
"""The part of the time limit in which the client itself gives up, with a reason."""

SCHEMES = ("tcp", "tls", "ucx", "inproc")
WITHOUT_PORT = {"inproc"}

OTHER_PROTOCOL = (AssertionError, EOFError, LookupError, MemoryError, ValueError, struct.error)
"""What distributed raises when it reads something else than messages of a scheduler."""

ALLOWED = "must be tcp://HOST:PORT or tls://HOST:PORT, as the scheduler prints it"
ADVICE = "start one with `dask scheduler`, or correct the address"


class Cluster:
    """A connection to a Dask cluster.

    Attributes:
        address: The address of its scheduler.
        client: A `distributed.Client`, whose loop runs in a thread of its own.
    """

    def __init__(self, address: str, client: Any, loop: LoopThread) -> None:
        """Take over a client and its loop."""
        self.address, self.client = address, client
        self._loop = loop

    @property
    def is_lost(self) -> bool:
        """Whether the client has lost its scheduler."""
        return self.client.status in {"closing", "closed"}

    def threads(self) -> int:
        """Return the current number of threads of the cluster's workers.

        Raises:
            Exception: If the scheduler does not answer within `ANSWER_S`.
        """
        return self._loop.call(threads_of(self.client), ANSWER_S)

    def close(self) -> None:
        """Disconnect, also from a scheduler that does not answer any more."""
        end(self.client, self._loop)


def connected(address: str, limit_s: float) -> Cluster:
    """Return the connection to a cluster.

    Raises:
        InputError: If it is not complete within the limit, with the reason and what to do.
    """
    check_address(address)
    try:
        from distributed import Client  # noqa: PLC0415  (an extra, and slow to load)
    except ImportError:
        message = f"{address}: Dask is not installed: pip install 'agent-economy[dask]'"
        raise InputError(message) from None
    end_s = time.monotonic() + limit_s
    check_host(address, limit_s)
    loop, client = LoopThread("Dask connection"), None
    try:
        kind = loop.call(kind_of(address, CONNECTING * limit_s), end_s - time.monotonic())
        check_kind(address, kind)
        client = loop.call(made(Client, address, CONNECTING * limit_s), limit_s)
        loop.call(started(client), end_s - time.monotonic())
        check_workers(address, loop.call(builds_of(client, limit_s), 2 * limit_s))
    except BaseException as error:
        end(client, loop)
        if not isinstance(error, Exception) or isinstance(error, InputError):
            raise
        raise no_scheduler(address, reason(error, limit_s)) from None
    return Cluster(address, client, loop)


def no_scheduler(address: str, why: str, advice: str = ADVICE) -> InputError:
    """Return the error that no scheduler answers at an address."""
    return InputError(f"{address}: no Dask scheduler answers at this address ({why}): {advice}")


def check_address(address: str) -> None:
    """Check the form of an address.

    Raises:
        InputError: If it cannot be that of a scheduler.
    """
    check(is_text(address), "address", address, "the address of a Dask scheduler")
    scheme, separator, rest = address.rpartition("://")
    if scheme in WITHOUT_PORT:
        return
    fault = ""
    if separator and scheme not in SCHEMES:
        fault = f"{scheme} is not the protocol of a scheduler, but may be that of its dashboard"
    elif not is_host_and_port(rest):
        fault = f"{rest!r} is no host with a port"
    if fault:
        raise no_scheduler(address, fault, ALLOWED)


def is_host_and_port(rest: str) -> bool:
    """Return whether the part of an address after its scheme is a host and a port."""
    try:
        parts = urlsplit(f"//{rest}")
        return bool(parts.hostname and parts.port) and parts.netloc == rest and rest.isprintable()
    except ValueError:
        return False


def check_host(address: str, limit_s: float) -> None:
    """Look up the host of an address, in a thread that may outlast the limit: nothing can end it.

    Raises:
        InputError: If its name is unknown.
    """
    scheme, _, rest = address.rpartition("://")
    if scheme in WITHOUT_PORT:
        return
    host, found = urlsplit(f"//{rest}").hostname, list[str]()
    fault = f"the lookup of its name takes more than {limit_s:g} s"

    def look_up() -> None:
        try:
            socket.getaddrinfo(host, None)
        except (OSError, UnicodeError) as error:
            found.append(str(getattr(error, "strerror", None) or error))
        else:
            found.append("")

    thread = threading.Thread(target=look_up, daemon=True)
    thread.start()
    thread.join(limit_s)
    if not found or found[0]:
        raise no_scheduler(address, f"the host {host} is unknown: {found[0] if found else fault}")


async def kind_of(address: str, limit_s: float) -> str:
    """Return what kind of server of Dask answers: `Client` takes each for a scheduler."""
    from distributed import Security, rpc  # noqa: PLC0415  (an extra, and slow to load)

    options = Security().get_connection_args("client")  # type: ignore[no-untyped-call]
    server = rpc(address, timeout=limit_s, connection_args=options)  # type: ignore[no-untyped-call]
    async with server:
        return str((await server.identity())["type"])


def check_kind(address: str, kind: str) -> None:
    """Check that what answers is a scheduler.

    Raises:
        InputError: If it is not, but a worker or a nanny.
    """
    if kind != "Scheduler":
        raise no_scheduler(address, f"it is the address of a {kind}")


async def made(kind: Any, address: str, limit_s: float) -> Any:
    """Return a client that connects in the running loop."""
    return kind(address, asynchronous=True, set_as_default=False, timeout=limit_s)


async def started(client: Any) -> None:
    """Wait until a client is connected."""
    await client


async def closing(client: Any) -> None:
    """Close a client."""
    await client.close()


async def threads_of(client: Any) -> int:
    """Return the number of threads of a client's workers."""
    return sum((await client.nthreads()).values())


async def builds_of(client: Any, limit_s: float) -> dict[str, Any]:
    """Return the build of this program on each worker, or its error; none if a worker is busy."""
    try:
        async with asyncio.timeout(limit_s):
            return dict(await client.run(own_build, on_error="return"))
    except TimeoutError:
        return {}


def check_workers(address: str, builds: Mapping[str, Any]) -> None:
    """Check that workers have the build of this process. Chunks check it again.

    Raises:
        InputError: If one has not; it names the first.
    """
    own = str(own_build())
    for worker, found in builds.items():
        if str(found) != own:
            has = f"does not have this program ({found})"
            if not isinstance(found, BaseException):
                has = f"has another build of this program ({found}) than this computer ({own})"
            message = f"{address}: the worker {worker} {has}: install the same build on both"
            raise InputError(message)


def reason(error: Exception, limit_s: float) -> str:
    """Return why a connection was not made."""
    if isinstance(error, TimeoutError):
        return f"what accepts the connection there does not answer within {limit_s:g} s"
    causes = list(causes_of(error))
    if texts := [cause.strerror for cause in causes if isinstance(cause, OSError)]:
        if any(isinstance(cause, TimeoutError) for cause in causes):
            return f"nothing accepts a connection within {limit_s:g} s"
        return next(filter(None, texts), None) or str(causes[-1])
    if isinstance(error, OTHER_PROTOCOL):
        return f"what answers there has another protocol: {type(error).__name__}"
    return f"{type(error).__name__}: {error}"


def causes_of(error: BaseException) -> Iterator[BaseException]:
    """Yield an error and its causes, the first cause last."""
    cause: BaseException | None = error
    while cause is not None:
        yield cause
        cause = cause.__cause__ or cause.__context__


def end(client: Any, loop: LoopThread) -> None:
    """End a connection, also one that is not complete."""
    if client is not None:
        with contextlib.suppress(Exception):  # The scheduler does not answer any more.
            loop.call(closing(client), CLOSE_S)
        # Otherwise it would wait for its loop when it is deleted.
        client.status = "closed"
    loop.end()
