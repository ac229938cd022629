"""How drives are found: their sockets and files, and programs that pretend, flood or are silent."""

import asyncio
import json
import os
import socket
import stat
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path

import pytest
from bare_timer import repeated_if_late
from other_programs import OTHER_UID, needs_abstract, needs_root, program

from agent_economy.live import local_socket
from agent_economy.live.discovery import contact, entry_file, running_drive, search
from agent_economy.live.discovery.publication import published
from agent_economy.live.discovery.running_drive import RunningDrive, drive_of
from agent_economy.live.discovery.search import NO_ENTRY, Search, Stopped
from agent_economy.live.discovery.stopping import (
    MAX_SILENT,
    _not_stopped,
    _sentence,
    nothing_found,
    options_of,
)


class Warden(BaseHTTPRequestHandler):
    """Accepts every stop, as the endpoint of a drive does."""

    def do_POST(self) -> None:
        """Answer."""
        body = json.dumps({"message": "emergency stop"}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Print nothing."""


@pytest.fixture
def drive() -> Iterator[RunningDrive]:
    """Serve the endpoint of a drive that has this process."""
    with ThreadingHTTPServer(("127.0.0.1", 0), Warden) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        port = int(server.server_address[1])
        yield RunningDrive(os.getpid(), "fleet.toml", "127.0.0.1", port, os.urandom(8).hex())
        server.shutdown()


@contextmanager
def serving(drive: RunningDrive) -> Iterator[list[str]]:
    """Publish a drive in an event loop of its own; return the warnings."""
    warnings, entered, ended = list[str](), threading.Event(), asyncio.Event()
    loop = asyncio.new_event_loop()

    async def run() -> None:
        with published(drive, warnings.append):
            entered.set()
            await ended.wait()

    thread = threading.Thread(target=lambda: loop.run_until_complete(run()), daemon=True)
    thread.start()
    try:
        assert entered.wait(5)
        yield warnings
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(5)
        loop.close()


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Let drives of this test be listed in a folder of its own only."""
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    own = tmp_path / f"agent-economy-{os.geteuid()}"
    monkeypatch.setattr(entry_file, "folders_to_read", lambda: [own])
    return own


def stopped() -> list[Stopped]:
    """Stop the drive of this process alone."""
    return Search(os.geteuid(), os.getpid()).stop()


def eventually(path: Path) -> None:
    deadline_s = time.monotonic() + 5
    while not path.exists():
        assert time.monotonic() < deadline_s, path
        time.sleep(0.02)


def drives_named(pid: int) -> list[str]:
    return [each.name for each in contact.named_sockets() if each.pid == pid]


@needs_abstract
def test_a_drive_is_found_without_any_file_and_stopped_once(
    drive: RunningDrive, monkeypatch: pytest.MonkeyPatch
) -> None:
    with serving(drive):
        expected = [Stopped(os.getpid(), os.geteuid(), "fleet.toml", True, "emergency stop")]  # noqa: FBT003
        assert stopped() == expected
        monkeypatch.setattr(entry_file, "folders_to_read", list)
        assert stopped() == expected
    assert not drives_named(os.getpid())
    assert stopped() == []


def test_a_drive_is_found_by_its_file_where_there_are_no_abstract_sockets(
    drive: RunningDrive, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(local_socket, "HAS_ABSTRACT", False)
    monkeypatch.setattr("agent_economy.live.discovery.publication.HAS_ABSTRACT", False)
    with serving(drive):
        assert [each.is_stopped for each in stopped()] == [True]


def test_the_file_of_a_drive_can_be_read_by_its_user_only_and_ends_with_it(
    drive: RunningDrive, folder: Path
) -> None:
    path = folder / "drives" / f"{drive.pid}.json"
    with serving(drive) as warnings:
        assert drive_of(path.read_bytes()) == drive
        assert stat.S_IMODE(path.stat().st_mode) == 0o600
        assert stat.S_IMODE(path.parent.stat().st_mode) == 0o700
        assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert not list(path.parent.iterdir())
    assert not warnings


def remove(folder: Path) -> None:
    for path in sorted(folder.rglob("*"), reverse=True):
        path.rmdir() if path.is_dir() else path.unlink()
    folder.rmdir()


def test_a_file_that_is_removed_with_its_folder_is_written_again(
    drive: RunningDrive, folder: Path
) -> None:
    path = folder / "drives" / f"{drive.pid}.json"
    with serving(drive) as warnings:
        for _ in range(2):
            began_s = time.monotonic()
            remove(folder)
            eventually(path)
            assert time.monotonic() - began_s < 2
            assert drive_of(path.read_bytes()) == drive
    assert not path.exists()
    assert not warnings


@pytest.mark.parametrize("kind", ["link", "file", "pipe"])
def test_what_takes_the_place_of_the_folder_is_reported_once_and_not_followed(
    drive: RunningDrive, folder: Path, tmp_path: Path, kind: str
) -> None:
    elsewhere = tmp_path / "elsewhere"
    (elsewhere / "drives").mkdir(parents=True)
    with serving(drive) as warnings:
        remove(folder)
        if kind == "link":
            folder.symlink_to(elsewhere)
        elif kind == "file":
            folder.write_text("")
        else:
            os.mkfifo(folder)
        time.sleep(1.6)
        if local_socket.HAS_ABSTRACT:
            assert [each.is_stopped for each in stopped()] == [True]
    assert len(warnings) == 1
    assert str(folder / "drives") in warnings[0]
    assert not list((elsewhere / "drives").iterdir())


@pytest.mark.parametrize("variable", ["/proc/none", "/dev/null"])
def test_a_drive_whose_folder_cannot_be_created_runs_and_warns(
    drive: RunningDrive, monkeypatch: pytest.MonkeyPatch, variable: str
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", variable)
    with serving(drive) as warnings:
        time.sleep(0.3)
    assert len(warnings) == 1
    assert variable in warnings[0]


@needs_root
def test_a_folder_of_another_user_gets_no_token_and_lists_no_drive(
    drive: RunningDrive, folder: Path
) -> None:
    (folder / "drives").mkdir(parents=True)
    os.chown(folder, OTHER_UID, OTHER_UID)
    with serving(drive) as warnings:
        time.sleep(0.3)
        assert not list((folder / "drives").iterdir())
        forged = folder / "drives" / "1.json"
        forged.write_bytes(RunningDrive(1, "forged", "127.0.0.1", 1, "x").encoded())
        os.chown(forged, OTHER_UID, OTHER_UID)
        assert not list(entry_file.read_all([folder]))
    assert "another user" in warnings[0]


def test_files_of_killed_drives_are_removed_also_if_their_process_number_is_used_again(
    drive: RunningDrive, folder: Path
) -> None:
    (folder / "drives").mkdir(parents=True)
    path = folder / "drives" / f"{drive.pid}.json"
    path.write_bytes(drive.encoded())
    assert not list(entry_file.read_all([folder]))
    assert not path.exists()


@pytest.mark.parametrize(
    "data",
    [
        *(b"", b"{}", b"[]", b"1", b"[" * 60_000, b"\xff", b'{"pid": "1"}', b"nul"),
        RunningDrive(1, "fleet.toml", "192.0.2.1", 80, "").encoded(),
        RunningDrive(1, "fleet.toml", "127.0.0.1", 0, "").encoded(),
    ],
)
def test_what_is_no_entry_is_none(data: bytes) -> None:
    assert drive_of(data) is None


def test_what_another_user_writes_cannot_control_the_terminal_of_root() -> None:
    text = _sentence(Stopped(1, OTHER_UID, "\x1b[2Jfleet\n", is_stopped=True, message="\x9b2J"))
    assert text.isprintable()


@pytest.mark.parametrize("answer", [b"[" * 100, b"HTTP/1.1 200 OK\r\n\r\n{", b"\r\n\r\n1", b""])
def test_an_endpoint_that_answers_garbage_or_without_end_is_reported_in_time(
    answer: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(running_drive, "TIMEOUT_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:

        def serve() -> None:
            link = server.accept()[0]
            with link, suppress(OSError):
                for _ in range(1 if b"{" in answer else 40):
                    link.sendall(answer)
                    time.sleep(0.05)

        threading.Thread(target=serve, daemon=True).start()
        drive = RunningDrive(1, "fleet.toml", "127.0.0.1", server.getsockname()[1], "")
        began_s = time.monotonic()
        accepted, text = drive.request("/stop")
        assert time.monotonic() - began_s < 1.0
    assert not accepted
    assert text


LISTENER = """
link = socket.socket(socket.AF_UNIX)
link.bind("\\0" + sys.argv[1])
link.listen(4)
print(flush=True)
accepted = []
while True:
    if sys.argv[2] == "silent":
        time.sleep(1)
        continue
    accepted.append(link.accept()[0])
    try:
        if sys.argv[2] == "garbage":
            accepted[-1].sendall(b"\\xff{" * 1000)
            accepted[-1].close()
        while sys.argv[2] == "endless":
            accepted[-1].sendall(b"[" * 100)
            time.sleep(0.01)
    except OSError:
        pass
"""


@needs_abstract
@pytest.mark.parametrize("kind", ["silent", "garbage", "endless"])
def test_a_drive_that_sends_no_entry_is_reported_with_its_process(kind: str) -> None:
    # The name has another process: in a container, it is not that which this machine knows.
    name = f"{contact.PREFIX}/{os.geteuid()}/1-{os.urandom(16).hex()}"
    with program(LISTENER, name, kind) as listener:
        began_s = time.monotonic()
        [answer] = Search(os.geteuid(), listener.pid).stop()
        assert time.monotonic() - began_s < 3
    assert (answer.pid, answer.is_stopped, answer.message) == (listener.pid, False, NO_ENTRY)


@needs_abstract
@needs_root
@pytest.mark.parametrize("kind", ["silent", "garbage", "endless"])
def test_a_program_of_another_user_with_a_forged_name_is_ignored(
    drive: RunningDrive, kind: str
) -> None:
    names = [f"{contact.PREFIX}/0/{os.getpid()}-{os.urandom(16).hex()}" for _ in range(2)]
    with (
        program(LISTENER, names[0], kind, uid=OTHER_UID),
        serving(drive),
        program(LISTENER, names[1], kind, uid=OTHER_UID),
    ):
        assert set(names) < set(drives_named(os.getpid()))
        began_s = time.monotonic()
        assert [each.is_stopped for each in stopped()] == [True]
        assert time.monotonic() - began_s < 1


@needs_abstract
def test_names_with_line_ends_and_spaces_forge_nothing_that_is_not_verified() -> None:
    real = f"{contact.PREFIX}/{os.geteuid()}/7-{'0' * 32}"
    with program(LISTENER, f"x\n0: 0 0 0 0 0 0 @{real}\n", "silent"):
        named = [each for each in contact.named_sockets() if each.name == real]
        assert [contact.contact(each, 0.0) for each in named] == [None] * len(named)


@needs_abstract
def test_a_drive_in_a_container_where_its_user_has_another_number_is_found() -> None:
    name = contact.new_name(4242, 1)
    with program(LISTENER, name, "garbage") as listener:
        [answer] = Search(os.geteuid(), listener.pid).stop()
    assert (answer.pid, answer.uid) == (listener.pid, os.geteuid())


FORGER = """
links = []
for number in range(int(sys.argv[2])):
    links.append(socket.socket(socket.AF_UNIX))
    links[-1].bind("\\0" + sys.argv[1] + format(number, "032x"))
    links[-1].listen(4)
print(flush=True)
time.sleep(60)
"""


@needs_abstract
@needs_root
@repeated_if_late
def test_a_user_with_hundreds_of_silent_sockets_delays_neither_the_answers_nor_the_end(
    drive: RunningDrive, monkeypatch: pytest.MonkeyPatch
) -> None:
    prefix, number = f"{contact.PREFIX}/{OTHER_UID}/1-", 900
    monkeypatch.setattr(entry_file, "folders_to_read", list)
    times_s = []
    with program(FORGER, prefix, str(number), uid=OTHER_UID) as forger, serving(drive):
        # Only these: root would stop the drives of all users of this machine.
        found = [
            each
            for each in contact.named_sockets()
            if each.name.startswith(prefix) or each.pid == os.getpid()
        ]
        assert len(found) == number + 1
        monkeypatch.setattr(search, "named_sockets", lambda: found)
        began_s = time.monotonic()
        query = Search(0)
        answers = query.stop(lambda _: times_s.append(time.monotonic() - began_s))
        assert time.monotonic() - began_s < search.TOTAL_S
    assert [each.pid for each in answers if each.is_stopped] == [os.getpid()]
    assert len(times_s) == 1
    assert times_s[0] < 1.0
    assert len([each for each in answers if each.pid == forger.pid]) == search.MAX_PER_USER
    assert query.not_requested == {OTHER_UID: number - search.MAX_PER_USER}
    silent = [each for each in answers if not each.is_stopped]
    *lines, rest = _not_stopped(silent, query.not_requested)
    assert len(lines) == MAX_SILENT
    assert rest.startswith(f"{number - MAX_SILENT} more programs of user ")


@needs_abstract
@needs_root
def test_what_has_not_answered_in_time_is_counted(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    prefix = f"{contact.PREFIX}/{OTHER_UID}/1-"
    monkeypatch.setattr(entry_file, "folders_to_read", list)
    monkeypatch.setattr(search, "TOTAL_S", 0.3)
    with program(FORGER, prefix, "100", uid=OTHER_UID):
        found = [each for each in contact.named_sockets() if each.name.startswith(prefix)]
        monkeypatch.setattr(search, "named_sockets", lambda: found)
        query = Search(0)
        assert query.stop() == []
    assert query.not_requested == {OTHER_UID: 100}


READER = """
link = socket.socket(socket.AF_UNIX)
link.connect("\\0" + sys.argv[1])
link.settimeout(5)
print(link.recv(1000), flush=True)
time.sleep(60)
"""


@needs_abstract
@needs_root
def test_another_user_does_not_get_the_token_and_is_reported_as_the_driver(
    drive: RunningDrive, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(entry_file, "folders_to_read", list)
    with serving(drive):
        [name] = drives_named(os.getpid())
        code = f"print()\n{READER}"
        with program(code, name, uid=OTHER_UID) as reader:
            assert reader.stdout is not None
            assert reader.stdout.readline() == "b''\n"
        search = Search(OTHER_UID, os.getpid())
        assert search.stop() == []
        assert (os.getpid(), 0) in search.others


@needs_abstract
@needs_root
def test_root_finds_the_drives_of_other_users() -> None:
    name = f"{contact.PREFIX}/{OTHER_UID}/1-{os.urandom(16).hex()}"
    with program(LISTENER, name, "silent", uid=OTHER_UID) as listener:
        [answer] = Search(0, listener.pid).stop()
        assert (answer.pid, answer.uid) == (listener.pid, OTHER_UID)


FLOOD = """
print(flush=True)
kept = []
while True:
    link = socket.socket(socket.AF_UNIX)
    link.setblocking(sys.argv[2] == "waiting")
    try:
        link.connect("\\0" + sys.argv[1])
    except OSError:
        pass
    if sys.argv[2] == "kept" and len(kept) < 500:
        kept.append(link)
    else:
        link.close()
"""


@needs_abstract
@repeated_if_late
@pytest.mark.parametrize("kind", ["dropped", "kept", "waiting"])
def test_a_flood_of_connections_delays_neither_the_warden_nor_a_stop(
    drive: RunningDrive, kind: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(entry_file, "folders_to_read", list)
    uid = OTHER_UID if os.geteuid() == 0 else None
    with serving(drive):
        [name] = drives_named(os.getpid())
        with program(FLOOD, name, kind, uid=uid), program(FLOOD, name, kind, uid=uid):
            delays_s = []
            for _ in range(10):
                began_s = time.monotonic()
                assert [each.is_stopped for each in stopped()] == [True]
                delays_s.append(time.monotonic() - began_s)
    assert max(delays_s) < 0.5


@needs_abstract
def test_many_readers_at_once_all_get_the_entry(drive: RunningDrive) -> None:
    def read(named: contact.NamedSocket) -> RunningDrive | None:
        found = contact.contact(named, 5.0)
        assert found is not None
        assert found.link is not None
        return contact.entry_of(found.link)

    with serving(drive):
        [named] = [each for each in contact.named_sockets() if each.pid == os.getpid()]
        with ThreadPoolExecutor(50) as pool:
            assert list(pool.map(read, [named] * 500)) == [drive] * 500


def test_a_search_without_a_result_states_where_it_looked_and_what_remains() -> None:
    text = "\n".join(nothing_found(OTHER_UID, None, [(1234, 0)]))
    assert f"({OTHER_UID}) was found. Looked at:" in text
    assert "agent-economy" in text
    assert "press Ctrl-C in its terminal, or use the robot's own switch" in text
    assert "Process 1234 is a drive of user root (0)" in text
    assert "runs" not in text


@pytest.mark.parametrize(
    ("words", "options"),
    [
        ([], (None, False)),
        (["--json"], (None, True)),
        (["--process", "12", "--json"], (12, True)),
        (["--process=12"], (12, False)),
        (["--help"], None),
        (["--process"], None),
        (["--process", "0"], None),
        (["--process", "-1"], None),
        (["--process", "1" * 5000], None),
        (["--process=x"], None),
        (["bender"], None),
    ],
)
def test_the_short_way_takes_right_options_only(
    words: list[str], options: tuple[int | None, bool] | None
) -> None:
    assert options_of(words) == options


@pytest.mark.parametrize("variable", [None, "", "/run/user/1/snap.code"])
def test_every_folder_that_a_drive_writes_is_one_in_which_stop_looks(
    variable: str | None, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.undo()
    monkeypatch.delenv("XDG_RUNTIME_DIR", raising=False)
    if variable is not None:
        monkeypatch.setenv("XDG_RUNTIME_DIR", variable)
    assert set(entry_file.folders_to_write()) <= set(entry_file.folders_to_read())
    monkeypatch.setattr("sys.platform", "darwin")
    fixed = set(entry_file.folders_to_write())
    monkeypatch.setenv("XDG_RUNTIME_DIR", "/other")
    monkeypatch.setenv("TMPDIR", "/other")
    monkeypatch.setenv("HOME", "/other")
    assert fixed & set(entry_file.folders_to_read())
