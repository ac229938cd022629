"""Locks on robots: two programs of a machine never drive one, whatever their environments are."""

import os
import signal
import socket
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import pytest
from live_bench import driving, emulated, fleet_text
from other_programs import OTHER_UID, needs_abstract, needs_root, program

from agent_economy.live import local_socket
from agent_economy.live.local_socket import HAS_ABSTRACT, user_name
from agent_economy.live.locks import BACKLOG, PREFIX, Address, AddressLocks, LockedError
from agent_economy.live.loop.last_resort import LAST_S

HOLDER = """
lock = socket.socket(socket.AF_UNIX)
lock.bind("\\0" + sys.argv[1])
lock.listen()
print(flush=True)
time.sleep(60)
"""


@pytest.fixture
def address() -> Address:
    """Return an address of this machine that no other test has: locks hold for all of them."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        return "127.0.0.1", int(server.getsockname()[1])


def test_a_lock_holds_in_every_environment(
    address: Address, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    first, second = AddressLocks(), AddressLocks()
    for name in ("XDG_RUNTIME_DIR", "TMPDIR", "HOME"):
        monkeypatch.setenv(name, str(tmp_path))
    first.take([address])
    for name in ("XDG_RUNTIME_DIR", "TMPDIR", "HOME"):
        monkeypatch.delenv(name)
    with pytest.raises(LockedError, match=f"127.0.0.1:{address[1]} is being driven by another"):
        second.take([address])
    first.close()
    second.take([address])
    second.close()


def test_no_file_keeps_a_robot_from_being_driven(
    address: Address, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("XDG_RUNTIME_DIR", str(tmp_path))
    (tmp_path / f"agent-economy-{os.geteuid()}").write_text("")
    locks = AddressLocks()
    locks.take([address])
    assert locks.holds(address)
    locks.close()


@needs_abstract
@pytest.mark.parametrize("uid", [None, pytest.param(OTHER_UID, marks=needs_root)])
def test_a_refusal_names_the_process_and_the_user_that_drive(
    address: Address, uid: int | None
) -> None:
    name = f"{PREFIX}/{address[0]}:{address[1]}"
    with program(HOLDER, name, uid=uid) as holder, pytest.raises(LockedError) as refused:
        AddressLocks().take([address])
    user = user_name(os.geteuid() if uid is None else uid)
    assert f"another program (process {holder.pid} of user {user})" in str(refused.value)


@needs_abstract
def test_a_robot_that_is_tried_again_and_again_names_its_driver_to_the_end(
    address: Address,
) -> None:
    with program(HOLDER, f"{PREFIX}/{address[0]}:{address[1]}") as holder:
        locks = AddressLocks()
        for _ in range(BACKLOG + 200):
            with pytest.raises(LockedError) as refused:
                locks.take([address])
        assert f"process {holder.pid} " in str(refused.value)


def test_two_robots_of_a_fleet_at_one_address_are_refused(address: Address) -> None:
    first, second = AddressLocks(), AddressLocks()
    first.take([address])
    words = "robot of this fleet" if HAS_ABSTRACT else "program"
    with pytest.raises(LockedError, match=f"another {words}"):
        second.take([address])
    first.close()


@needs_abstract
@pytest.mark.parametrize(
    ("first", "second", "is_same"),
    [
        ("127.0.0.1", "::ffff:127.0.0.1", True),
        ("::ffff:7f00:1", "127.0.0.1", True),
        ("0:0:0:0:0:0:0:1", "::1", True),
        ("FE80::1%lo", "fe80::1%1", True),
        ("fe80::1%1", "fe80::1%2", False),
        ("127.0.0.1", "::1", False),
        ("127.0.0.1", "127.0.0.2", False),
    ],
)
def test_forms_of_one_address_are_one_lock(
    first: str, second: str, *, is_same: bool, address: Address
) -> None:
    one, two = AddressLocks(), AddressLocks()
    one.take([(first, address[1])])
    assert one.holds((second, address[1])) is is_same
    if is_same:
        with pytest.raises(LockedError):
            two.take([(second, address[1])])
    else:
        two.take([(second, address[1])])
    one.close()
    two.close()


def test_a_lock_is_taken_once_however_often_it_is_requested(address: Address) -> None:
    locks = AddressLocks()
    for _ in range(3):
        locks.take([address, address])
    locks.close()
    AddressLocks().take([address])


TAKER = """
import subprocess, sys, time
from agent_economy.live.locks import AddressLocks
locks = AddressLocks()
locks.take([("127.0.0.1", int(sys.argv[1]))])
child = subprocess.Popen(["sleep", "30"])
print(child.pid, flush=True)
time.sleep(60)
"""


def test_a_lock_vanishes_with_its_program_also_if_a_child_of_it_lives_on(address: Address) -> None:
    command = [sys.executable, "-c", TAKER, str(address[1])]
    holder = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert holder.stdout is not None
    child = int(holder.stdout.readline())
    try:
        locks = AddressLocks()
        with pytest.raises(LockedError):
            locks.take([address])
        holder.send_signal(signal.SIGKILL)
        holder.wait(10)
        locks.take([address])
        locks.close()
    finally:
        holder.kill()
        with suppress(ProcessLookupError):
            os.kill(child, signal.SIGKILL)


def taken_after_s(address: Address, limit_s: float) -> float | None:
    """Return when another program that tries all the time gets a lock; None if it does not."""
    began_s = time.monotonic()
    while (elapsed_s := time.monotonic() - began_s) < limit_s:
        with suppress(OSError):
            local_socket.listen(f"{PREFIX}/{address[0]}:{address[1]}").close()
            return elapsed_s
    return None


@needs_abstract
def test_when_the_warden_is_killed_the_loop_has_the_lock_without_a_gap(tmp_path: Path) -> None:
    with emulated(tmp_path) as bench:
        fleet = tmp_path / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        with driving(fleet) as drive:
            drive.wait_until_moving()
            loop = drive.loop_pid()
            address = ("127.0.0.1", bench.robots[0]["motors"])
            drive.process.kill()
            killed_s = time.monotonic()
            assert taken_after_s(address, 1.0) is None
            with pytest.raises(LockedError, match=f"process {loop} "):
                AddressLocks().take([address])
            assert taken_after_s(address, 20.0) is not None
            assert LAST_S <= time.monotonic() - killed_s < LAST_S + 5


def test_of_programs_that_start_at_once_one_gets_all_addresses(address: Address) -> None:
    addresses = [("127.0.0.1", address[1]), ("::1", address[1]), ("10.0.0.1", address[1])]
    start, got = threading.Barrier(8), list[AddressLocks]()

    def take(number: int) -> None:
        locks = AddressLocks()
        start.wait()
        with suppress(LockedError):
            locks.take(addresses[number % 3 :] + addresses[: number % 3])
            got.append(locks)

    threads = [threading.Thread(target=take, args=(number,)) for number in range(8)]
    for each in threads:
        each.start()
    for each in threads:
        each.join()
    assert len(got) == 1
    got[0].close()


def test_without_abstract_sockets_a_lock_is_a_port_of_the_loopback_interface(
    address: Address, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(local_socket, "HAS_ABSTRACT", False)
    first, second = AddressLocks(), AddressLocks()
    first.take([address])
    with pytest.raises(LockedError, match=r"another program, or one has UDP port 2\d{4} of"):
        second.take([address])
    first.close()
    second.take([address])
    second.close()
