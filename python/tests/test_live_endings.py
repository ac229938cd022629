"""Drives that end badly: whatever ends the warden or its reader, stop is the last motor line."""

import asyncio
import socket
import threading
import time
from collections.abc import Mapping
from typing import Any

import pytest

from agent_economy.live import fleet
from agent_economy.live.frame import frame_of
from agent_economy.live.locks import AddressLocks, LockedError
from agent_economy.live.loop import last_resort
from agent_economy.live.plan import FleetPlan
from agent_economy.live.readings import STOP, Motion
from agent_economy.live.warden.reporter import MAX_EVENTS, Reporter
from agent_economy.live.warden.robot import DriveContext, Robot
from agent_economy.live.warden.warden import Warden


@pytest.fixture
def plan() -> FleetPlan:
    return fleet.load("bender").plan


def warden() -> Warden:
    return Warden(lambda _: None, is_headless=True)


def test_a_reader_that_does_not_read_holds_nothing_up_and_the_drive_goes_on() -> None:
    reads, closed, printed = threading.Event(), list[bool](), list[Any]()

    def print_event(event: Mapping[str, Any]) -> None:
        reads.wait(10)
        printed.append(event)

    reporter = Reporter(print_event, lambda: closed.append(True))
    began_s = time.monotonic()
    for number in range(2 * MAX_EVENTS):
        reporter({"number": number})
    assert time.monotonic() - began_s < 1.0
    reads.set()
    reporter.close()
    assert [each["number"] for each in printed[:100]] == list(range(100))
    assert MAX_EVENTS <= len(printed) <= MAX_EVENTS + 1
    assert not closed


def test_a_reader_that_is_gone_is_reported_once() -> None:
    closed: list[bool] = []

    def print_event(_: Mapping[str, Any]) -> None:
        raise BrokenPipeError

    reporter = Reporter(print_event, lambda: closed.append(True))
    for _ in range(10):
        reporter({})
    reporter.close()
    assert closed == [True]


def test_a_loop_that_ends_before_it_has_read_the_fleet_ends_the_drive() -> None:
    async def load() -> FleetPlan | None:
        async with asyncio.timeout(20):
            return await warden().load(["--no-such-option"])

    assert asyncio.run(load()) is None


def test_an_error_in_the_warden_stops_and_closes_all_robots(
    plan: FleetPlan, monkeypatch: pytest.MonkeyPatch
) -> None:
    ended: list[str] = []

    async def end(self: Robot) -> None:
        ended.append(self.plan.name)

    async def turns(*_: Any) -> None:
        await asyncio.sleep(0.1)
        raise ZeroDivisionError

    monkeypatch.setattr(Robot, "end", end)
    monkeypatch.setattr(Warden, "_turns", turns)
    with pytest.raises(ExceptionGroup):
        asyncio.run(warden().drive(plan))
    assert ended == [robot.name for robot in plan.robots]


def test_a_robot_that_moved_has_no_stop_while_its_motor_port_is_down(plan: FleetPlan) -> None:
    robot = Robot(plan.robots[0], DriveContext(frame_of(plan.origin), lambda: 1.0, lambda *_: None))
    robot.command(STOP, 1.0)
    assert robot.has_stop()
    robot.command(Motion(0.5, 0.0), 1.1)
    robot.command(STOP, 1.2)
    assert not robot.has_stop()


def test_the_last_resort_keeps_other_drives_from_its_robots(
    plan: FleetPlan, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(last_resort, "LAST_S", 0.5)
    with socket.create_server(("127.0.0.1", 0)) as server:
        address = server.getsockname()[:2]
        arguments = (plan, {plan.robots[0].name: address}, -1)
        stopping = threading.Thread(target=last_resort.stop_all, args=arguments)
        stopping.start()
        link, _ = server.accept()
        assert link.recv(100).startswith(b"x,3,\n")
        with pytest.raises(LockedError):
            AddressLocks().take([address])
        stopping.join()
        link.close()
    AddressLocks().take([address])


def test_an_interrupt_stops_in_the_next_turn() -> None:
    interrupted = warden()
    interrupted.interrupt()
    assert interrupted.operator.take().stop


def test_arming_is_refused_in_the_turn_in_which_a_stop_is_requested() -> None:
    stopped = warden()
    stopped.operator.stop = True
    with pytest.raises(ValueError, match="emergency stop has been requested"):
        stopped.arm([])
