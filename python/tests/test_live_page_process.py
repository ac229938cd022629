"""The server of the page as a child: it gets the run from its start, and may die at any time."""

import asyncio
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any
from urllib.error import HTTPError
from urllib.parse import parse_qs, urlsplit
from urllib.request import urlopen

import pytest
from live_bench import Drive, driving, emulated, fleet_text
from mcap.reader import make_reader

from agent_economy.live.clock import now_s
from agent_economy.live.warden import page_process
from agent_economy.live.warden.page_process import MAX_FAILURES, PageProcess, origins
from agent_economy.recording.reading import Recorded
from agent_economy.recording.stops import Stop

READER = """
import json, os, sys
start = json.loads(sys.stdin.readline())
out = open(sys.argv[1] + f"/{os.getpid()}.jsonl", "w", buffering=1)
print(json.dumps(start), file=out)
import socket
port = socket.socket(fileno=start["listening"]).getsockname()[1]
print(json.dumps({"type": "ready", "url": f"http://127.0.0.1:{port}/"}), flush=True)
for line in sys.stdin:
    out.write(line)
print("end", file=out)
"""

REPLICA = """
import json, os, sys
from agent_economy import Scenario, Simulation
start = json.loads(sys.stdin.readline())
given = start["scenario"]
scenario = Scenario.loads(given["text"], given["file"])
from agent_economy.runs.external import external_body
bodies = {name: external_body(values) for name, values in start["external"].items()}
simulation = Simulation(scenario, seed=start["seed"], external=bodies)
simulation.hash_decisions()
out = open(sys.argv[1] + f"/{os.getpid()}.jsonl", "w", buffering=1)
print(json.dumps(start), file=out)
import socket
url = f"http://127.0.0.1:{socket.socket(fileno=start['listening']).getsockname()[1]}/"
print(json.dumps({"type": "ready", "url": url}), flush=True)
for line in sys.stdin:
    message = json.loads(line)
    assert message["tick"] == simulation.tick, (message["tick"], simulation.tick)
    simulation.step(**message["inputs"])
    print(json.dumps([message["tick"], simulation.decision_hash]), file=out)
"""


def program(folder: Path, text: str) -> tuple[str, ...]:
    """Write a server that is none; return its command."""
    path = folder / "reader.py"
    path.write_text(text, encoding="utf-8")
    return (sys.executable, str(path), str(folder))


def lines(folder: Path, pid: int | None) -> list[str]:
    path = folder / f"{pid}.jsonl"
    return path.read_text().splitlines() if path.exists() else []


async def until(holds: Callable[[], bool], timeout_s: float = 20) -> None:
    deadline_s = now_s() + timeout_s
    while not holds():
        assert now_s() < deadline_s
        await asyncio.sleep(0.02)


def message(tick: int) -> dict[str, Any]:
    inputs = {"bender/0": {"time_s": 0.1 * tick, "random_words": [tick] * 40}}
    return {"type": "input", "tick": tick, "inputs": inputs, "stops": []}


def test_a_page_may_be_opened_by_both_names_of_this_machine() -> None:
    expected = ("http://127.0.0.1:8765", "http://localhost:8765")
    assert origins("http://127.0.0.1:8765/?token=a-_b#/robots") == expected


def test_a_server_that_replaces_a_killed_one_gets_the_whole_run_and_the_same_port(
    tmp_path: Path,
) -> None:
    urls: list[str] = []

    async def story() -> None:
        command = program(tmp_path, READER)
        page = PageProcess({"type": "start", "seed": 7}, urls.append, lambda: None, command)
        page.start()
        for tick in range(3000):
            page.add(message(tick))
        await until(lambda: len(urls) == 1)
        first = page.pid
        await until(lambda: len(lines(tmp_path, first)) == 3001)
        assert first is not None
        os.kill(first, signal.SIGKILL)
        page.add(message(3000))
        await until(lambda: len(urls) == 2)
        second = page.pid
        assert second != first
        await until(lambda: len(lines(tmp_path, second)) == 3002)
        page.add(message(3001))
        await until(lambda: len(lines(tmp_path, second)) == 3003)
        await page.end()
        start, *rest = [json.loads(line) for line in lines(tmp_path, second)[:-1]]
        assert start["seed"] == 7
        assert rest == [message(tick) for tick in range(3002)]
        assert lines(tmp_path, second)[-1] == "end"

    asyncio.run(story())
    assert len(set(urls)) == 1


def test_a_suspended_server_delays_nothing_and_is_replaced(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(page_process, "STUCK_S", 1.0)
    urls: list[str] = []

    async def story() -> None:
        page = PageProcess({"type": "start"}, urls.append, lambda: None, program(tmp_path, READER))
        page.start()
        await until(lambda: len(urls) == 1)
        first = page.pid
        assert first is not None
        os.kill(first, signal.SIGSTOP)
        longest_s = 0.0
        for tick in range(2000):
            began_s = time.monotonic()
            page.add(message(tick))
            longest_s = max(longest_s, time.monotonic() - began_s)
        assert longest_s < 0.2
        await until(lambda: len(urls) == 2)
        await until(lambda: len(lines(tmp_path, page.pid)) == 2001)
        await page.end()

    asyncio.run(story())


def test_a_server_that_cannot_start_is_given_up(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(page_process, "MAX_PAUSE_S", 0.05)
    monkeypatch.setattr(page_process, "LOOK_S", 0.01)
    failures: list[int] = []

    async def story() -> None:
        command = program(tmp_path, f"open({str(tmp_path / 'starts')!r}, 'a').write('x')")
        page = PageProcess({}, lambda _: None, lambda: failures.append(1), command)
        page.start()
        await until(lambda: failures == [1])
        page.add(message(0))
        await page.end()

    asyncio.run(story())
    assert len((tmp_path / "starts").read_text()) == MAX_FAILURES


DRIVE = """
import sys
from pathlib import Path
from agent_economy.cli.drive import print_json
from agent_economy.live.warden import page_process
from agent_economy.live.warden.shell import Options, drive_fleet
page_process.COMMAND = tuple(sys.argv[3:])
options = Options(Path(sys.argv[1]), Path(sys.argv[2]), 0, is_headless=False)
sys.exit(drive_fleet(options, print_json).exit_code)
"""


def drive_with_page(folder: Path, fleet: Path, served: str = REPLICA) -> Drive:
    """Start a drive whose page is served by a replica of the run, or another program."""
    record = fleet.with_suffix(".mcap")
    server = program(folder, served)
    command = [sys.executable, "-c", DRIVE, str(fleet), str(record), *server]
    environment = os.environ | {"XDG_RUNTIME_DIR": str(folder)}
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
    drive = Drive(process, record, environment)
    threading.Thread(target=drive.read, daemon=True).start()
    return drive


def servers(folder: Path) -> dict[int, list[list[int]]]:
    """Return the ticks and hashes that each server has, by its process."""
    found = {}
    for path in folder.glob("[0-9]*.jsonl"):
        rows = path.read_text().splitlines()
        found[int(path.stem)] = [json.loads(row) for row in rows[1:]]
    return found


def stop_of(tick: int, robot: str, action: str, reasons: list[str]) -> Stop:
    """Return a stop that the page received."""
    return Stop(tick, robot, action, tuple(reasons))


def arm(drive: Drive) -> None:
    """Arm the robots as soon as that is allowed, and wait until they move."""
    deadline_s = now_s() + 20
    while drive.ask("/arm")[0] != 200:
        assert now_s() < deadline_s
        time.sleep(0.2)
    drive.wait_until_moving()


def test_the_page_receives_the_stops_that_the_recording_has(tmp_path: Path) -> None:
    with emulated(tmp_path) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        drive = drive_with_page(tmp_path, fleet, READER)
        try:
            drive.wait_for(lambda each: each["type"] == "page")
            arm(drive)
            assert drive.ask("/stop")[0] == 200
            drive.wait_for(lambda each: "emergency_stop" in each.get("latched", ()))
            time.sleep(1.0)
            drive.process.send_signal(signal.SIGINT)
            assert drive.wait() == 130
        finally:
            drive.process.kill()
    [path] = tmp_path.glob("[0-9]*.jsonl")
    steps = [json.loads(row) for row in path.read_text().splitlines()[1:-1]]
    received = [stop_of(*each) for step in steps for each in step["stops"]]
    with drive.record.open("rb") as stream:
        (read := Recorded()).read_all(stream)
    assert any("emergency_stop" in stop.reasons for stop in received)
    assert received == [stop for stop in read.stops.all if stop.tick < len(steps)]


def test_killing_the_server_of_the_page_stops_no_robot_and_the_next_one_steps_the_same_run(
    tmp_path: Path,
) -> None:
    with emulated(tmp_path) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        drive = drive_with_page(tmp_path, fleet)
        try:
            drive.wait_for(lambda each: each["type"] == "page")
            arm(drive)
            time.sleep(2.0)
            [first] = servers(tmp_path)
            os.kill(first, signal.SIGKILL)
            killed_s, seen = now_s(), len(drive.events)
            while len(servers(tmp_path)) < 2:
                assert now_s() < killed_s + 20
                time.sleep(0.1)
            time.sleep(2.0)
            assert len(bench.moves_after(0, killed_s)) > 5
            robot_events = [each for each in drive.events[seen:] if each["type"] == "event"]
            assert not [each for each in robot_events if each["action"] != "move"]
            drive.process.send_signal(signal.SIGINT)
            assert drive.wait() == 130
        finally:
            drive.process.kill()
    found = servers(tmp_path)
    before = found.pop(first)
    [after] = found.values()
    assert len(before) > 20
    assert len(after) > len(before)
    assert after[: len(before)] == before


def fetch(url: str, path: str, query: str = "") -> tuple[int, bytes]:
    """Return the status and the content of an address of the server of a page."""
    place = urlsplit(url)
    try:
        with urlopen(f"http://{place.netloc}{path}?{query}", timeout=10) as response:
            return response.status, response.read()
    except HTTPError as error:
        return error.code, error.read()


def published(drive: Drive, page: dict[str, Any]) -> Iterator[tuple[str, str]]:
    """Yield what other users, pages without the secret, and readers of its files get of a drive."""
    pid = drive.process.pid
    children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
    for each in (str(pid), *children):
        yield f"arguments of {each}", Path(f"/proc/{each}/cmdline").read_text()
        yield f"environment of {each}", Path(f"/proc/{each}/environ").read_text()
    yield "state", json.dumps(drive.ask("/state", client="a", since=0)[1])
    for path in ("/", "/drive", "/api/scenarios", "/api/recordings", "/favicon.svg", "/none"):
        yield path, fetch(page["url"], path)[1].decode(errors="replace")
    query = urlsplit(page["url"]).query
    for path in ("/", "/api/scenarios", "/api/recordings", "/none"):
        yield path, fetch(page["url"], path, query)[1].decode(errors="replace")
    yield "other events", json.dumps([each for each in drive.events if each["type"] != "page"])


def recorded(path: Path) -> bytes:
    """Return all that a recording contains."""
    with path.open("rb") as stream:
        reader = make_reader(stream)
        found = [message.data for _, _, message in reader.iter_messages()]
        found += [str(each.metadata).encode() for each in reader.iter_metadata()]
        found += [each.data for each in reader.iter_attachments()]
    return b"".join(found)


def sockets_of(pid: int) -> set[str]:
    """Return the sockets that a process has."""
    links = [str(each.readlink()) for each in Path(f"/proc/{pid}/fd").iterdir()]
    return {each for each in links if each.startswith("socket:")}


def test_only_the_printed_address_has_the_secret_of_the_page_and_restarts_keep_it(
    tmp_path: Path,
) -> None:
    with emulated(tmp_path) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        with driving(fleet, headless=False) as drive:
            first = drive.wait_for(lambda each: each["type"] == "page")
            [secret] = parse_qs(urlsplit(first["url"]).query)["token"]
            assert len(secret) >= 32
            assert fetch(first["url"], "/drive")[0] == 403
            status, content = fetch(first["url"], "/drive", f"token={secret}")
            assert (status, json.loads(content)["warden"]["token"]) == (200, drive.running().token)
            secrets = (secret, drive.running().token)
            for where, text in published(drive, first):
                assert not any(each in text for each in secrets), where
            pid = drive.process.pid
            children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
            assert len(sockets_of(pid) & sockets_of(int(children[-1]))) == 1
            os.kill(int(children[-1]), signal.SIGKILL)
            address = ("127.0.0.1", urlsplit(first["url"]).port)
            seen = len(drive.events)
            while not any(each["type"] == "page" for each in drive.events[seen:]):
                assert drive.process.poll() is None, drive.events[-3:]
                with pytest.raises(OSError, match="in use"):
                    socket.create_server(address)
                time.sleep(0.002)
            assert drive.events[-1]["url"] == first["url"]
            assert fetch(first["url"], "/drive", f"token={secret}")[0] == 200
            drive.process.send_signal(signal.SIGINT)
            assert drive.wait() == 130
            content = recorded(drive.record)
            assert len(content) > 10_000
            assert not any(each.encode() in content for each in secrets)


def test_without_a_server_of_the_page_the_drive_goes_on(tmp_path: Path) -> None:
    with emulated(tmp_path) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        with driving(fleet, headless=False) as drive:
            drive.wait_for(lambda each: each["type"] == "event")
            assert drive.ask("/state", client="a", since=0)[1]["robots"]
