"""An address at which no Dask scheduler answers is named in time, and nothing half made remains."""

import os
import socket
import struct
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from functools import partial
from pathlib import Path

import pytest
from dask_cluster import free_port, is_listening, started, wait_until
from synthetic_runs import outcomes, same

from agent_economy import InputError
from agent_economy.study.executors import dask_executor
from agent_economy.study.run_block import RunBlock
from agent_economy.study.workers import Workers

pytest.importorskip("distributed", reason="Dask is an extra")

LIMIT_S = 0.5
MARGIN_S = 5.0
"""A busy machine takes long."""

LENGTH = struct.pack("<Q", 2**40)
"""What a message of a scheduler begins with, here a trillion bytes."""

Answer = Callable[[socket.socket], object]


def slowly(connection: socket.socket) -> None:
    """Send a byte at a time."""
    for _ in range(100):
        connection.sendall(b"\0")
        time.sleep(0.1)


def again(connection: socket.socket) -> None:
    """Send what is received."""
    while data := connection.recv(4096):
        connection.sendall(data)


@contextmanager
def server(answer: Answer) -> Iterator[str]:
    """Serve connections on loopback; return the address."""
    accepted = []

    def accept(listening: socket.socket) -> None:
        with suppress(OSError):
            while True:
                connection, _ = listening.accept()
                accepted.append(connection)
                threading.Thread(target=handle, args=(connection,), daemon=True).start()

    def handle(connection: socket.socket) -> None:
        with suppress(OSError):
            answer(connection)

    with closing(socket.create_server(("127.0.0.1", 0))) as listening:
        threading.Thread(target=accept, args=(listening,), daemon=True).start()
        yield f"tcp://127.0.0.1:{listening.getsockname()[1]}"
    for connection in accepted:
        connection.close()


@contextmanager
def black_hole() -> Iterator[str]:
    """Listen, but accept no connection: the queue is full; return the address."""
    with closing(socket.socket()) as listening, ExitStack() as stack:
        listening.bind(("127.0.0.1", 0))
        listening.listen(0)
        for _ in range(4):
            waiting = stack.enter_context(closing(socket.socket()))
            waiting.setblocking(False)  # noqa: FBT003
            with suppress(BlockingIOError):
                waiting.connect(listening.getsockname())
        yield f"tcp://127.0.0.1:{listening.getsockname()[1]}"


ANSWERS: list[tuple[Answer, str]] = [
    (lambda _: time.sleep(60), "what accepts the connection there does not answer within 0.5 s"),
    (lambda it: it.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n"), "has another protocol"),
    (lambda it: it.sendall(b"SSH-2.0-OpenSSH_9.0\r\n"), "has another protocol"),
    (lambda it: it.sendall(LENGTH), r"another protocol|does not answer"),
    (lambda it: it.sendall(bytes(64)), "has another protocol"),
    (slowly, r"another protocol|does not answer"),
    (again, "has another protocol"),
    (lambda it: it.close(), "reset|closed|end of file"),
]


@pytest.fixture(autouse=True)
def short_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    """Wait for a second only, and load Dask before."""
    import distributed  # noqa: F401, PLC0415

    monkeypatch.setattr("agent_economy.study.executors.CONNECT_S", LIMIT_S)


def check_refused(address: str, words: str) -> None:
    """Check that an address is refused in time, and that no thread remains."""
    before = set(threading.enumerate())
    begin_s = time.monotonic()
    with pytest.raises(InputError, match=f"no Dask scheduler answers .*({words}).*: ") as caught:
        dask_executor(address)
    assert time.monotonic() - begin_s < LIMIT_S + MARGIN_S
    assert str(caught.value).startswith(f"{address}: ")
    remaining = {each.name for each in set(threading.enumerate()) - before}
    assert not {name for name in remaining if "Dask" in name or "IO loop" in name}


@pytest.mark.parametrize(("answer", "words"), ANSWERS)
def test_what_is_no_scheduler_is_named_in_time(answer: Answer, words: str) -> None:
    with server(answer) as address:
        check_refused(address, words)


def test_an_address_where_nothing_accepts_a_connection_is_named_in_time() -> None:
    with black_hole() as address:
        check_refused(address, "nothing accepts a connection within 0.5 s")


ADDRESSES = [
    ("http://127.0.0.1:8787", "http is not the protocol of a scheduler"),
    ("https://127.0.0.1:8787", "https is not"),
    ("ws://127.0.0.1:8786", "ws is not"),
    ("tcp://127.0.0.1", "'127.0.0.1' is no host with a port"),
    ("127.0.0.1", "no host with a port"),
    ("tcp://127.0.0.1:0", "no host with a port"),
    ("tcp://127.0.0.1:99999", "no host with a port"),
    ("tcp://127.0.0.1:8786/status", "no host with a port"),
    ("tcp://", "'' is no host with a port"),
    ("", "'' is no host with a port"),
    ("tcp://nowhere.invalid:8786", "the host nowhere.invalid is unknown"),
    (f"tcp://{'x' * 300}:8786", "the host x+ is unknown"),
    ("tls://127.0.0.1:8786", "TLS expects"),
]


@pytest.mark.parametrize(("address", "words"), ADDRESSES)
def test_an_address_that_cannot_be_a_schedulers_is_named(address: str, words: str) -> None:
    check_refused(address, words)


def test_a_lookup_of_a_name_that_takes_long_is_not_waited_for(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(socket, "getaddrinfo", lambda *_: time.sleep(60))
    check_refused("tcp://somewhere:8786", "the lookup of its name takes more than 0.5 s")


FAILS = """
import sys
from agent_economy import InputError
from agent_economy.study import executors
executors.CONNECT_S = 0.5
for address in sys.argv[1:]:
    try:
        executors.dask_executor(address)
    except InputError as error:
        print(error)
"""


def test_a_failed_connection_prints_nothing_and_does_not_delay_the_end() -> None:
    answers = [answer for answer, _ in ANSWERS[:3]]
    with ExitStack() as stack:
        addresses = [stack.enter_context(server(answer)) for answer in answers]
        addresses += ["nowhere.invalid:8786"]
        done = subprocess.run(
            [sys.executable, "-c", FAILS, *addresses],
            capture_output=True,
            text=True,
            check=True,
            timeout=60,
        )
    assert done.stderr == ""
    assert [line.split(": ")[0] for line in done.stdout.splitlines()] == addresses


@pytest.fixture(scope="module")
def scheduler() -> Iterator[tuple[str, ExitStack]]:
    """Start a scheduler without workers; return its address."""
    with ExitStack() as stack:
        port = free_port()
        options = ("--host", "127.0.0.1", "--port", str(port), "--no-dashboard", "--no-show")
        started(stack, "distributed.cli.dask_scheduler", *options)
        wait_until(lambda: is_listening(port))
        yield f"tcp://127.0.0.1:{port}", stack


WORKER = ("distributed.cli.dask_worker", "--nthreads", "1", "--no-nanny", "--no-dashboard")


def test_runs_wait_for_the_first_worker_and_that_is_reported(
    scheduler: tuple[str, ExitStack], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("agent_economy.study.executors.CONNECT_S", 30)
    address, stack = scheduler
    port, block, reported = free_port(), RunBlock((0, 1), 0, 10), list[str]()

    def start(sentence: str) -> None:
        reported.append(sentence)
        started(stack, *WORKER, address, "--worker-port", str(port))

    with Workers(partial(dask_executor, address, start), 1, outcomes) as workers:
        assert same(workers.columns(block), outcomes(block))
    assert len(reported) == 1
    assert reported[0].startswith(f"{address}: the cluster has no workers: the study waits for one")
    with pytest.raises(InputError, match="it is the address of a Worker"):
        dask_executor(f"tcp://127.0.0.1:{port}")


def connect_until_refused(address: str) -> None:
    """Connect again and again, until a worker is registered that is refused."""
    for _ in range(100):
        dask_executor(address).shutdown()
        time.sleep(0.1)


def test_a_worker_without_this_program_is_named(
    scheduler: tuple[str, ExitStack], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("agent_economy.study.executors.CONNECT_S", 30)
    address, _ = scheduler
    package = tmp_path / "agent_economy"
    package.mkdir()
    (package / "__init__.py").write_text("raise ModuleNotFoundError('agent_economy')")
    port = free_port()
    with ExitStack() as stack:
        process = subprocess.Popen(
            [sys.executable, "-m", *WORKER, address, "--worker-port", str(port)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            env=os.environ | {"PYTHONPATH": str(tmp_path)},
        )
        stack.callback(process.wait)
        stack.callback(process.kill)
        words = f"the worker tcp://127.0.0.1:{port} does not have this program .*: install the same"
        with pytest.raises(InputError, match=words):
            connect_until_refused(address)
