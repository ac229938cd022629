"""Starts the warden: signals, locks, the endpoint, and the end of the process."""

import asyncio
import os
import signal
import socket
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy.live.discovery.publication import published
from agent_economy.live.discovery.running_drive import RunningDrive
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.locks import AddressLocks, LockedError
from agent_economy.live.plan import FleetPlan, RobotPlan
from agent_economy.live.warden.control import Control, Drive
from agent_economy.live.warden.endings import End
from agent_economy.live.warden.endpoint import Endpoint
from agent_economy.live.warden.event_log import EventLog
from agent_economy.live.warden.page_process import start_page
from agent_economy.live.warden.reporter import Reporter
from agent_economy.live.warden.warden import Report, Warden

RESOLVE_S = 2.0
"""Time for which the lookup of a host name may delay the start."""


@dataclass(frozen=True)
class Options:
    """What a drive is started with.

    Attributes:
        fleet: The fleet file.
        record: The recording, which must not exist.
        is_numbered: Whether NAME-2, NAME-3 and so on are used if it exists.
        every: Number of steps per recorded state.
        seed: Seed of the simulated robots and sensors.
        is_headless: Whether it arms its robots itself, and ends by itself.
    """

    fleet: Path
    record: Path
    seed: int
    is_headless: bool
    is_numbered: bool = False
    every: int = 1

    def for_loop(self) -> list[str]:
        """Return the arguments of the process of the loop."""
        arguments = [str(self.fleet), "--record", str(self.record), "--seed", str(self.seed)]
        arguments += ["--every", str(self.every)]
        arguments += ["--numbered"] if self.is_numbered else []
        return arguments if self.is_headless else [*arguments, "--page"]


def drive_fleet(options: Options, report: Report) -> End:
    """Drive a fleet until the drive ends, with all robots stopped."""
    return asyncio.run(_drive(options, report))


async def _drive(options: Options, print_event: Report) -> End:
    loop = asyncio.get_running_loop()
    # A drive whose output is closed has no reader: it ends as after Ctrl-C.
    printer = Reporter(print_event, lambda: loop.call_soon_threadsafe(warden.interrupt))
    events = EventLog()

    def report(event: Mapping[str, Any]) -> None:
        printer(event)
        events.report(event)

    def report_error(_: asyncio.AbstractEventLoop, context: Mapping[str, Any]) -> None:
        # Not to standard error: a reader that does not read would hold the warden up.
        error = context.get("exception") or context["message"]
        report({"type": "message", "message": f"internal error: {error!r}"})

    loop.set_exception_handler(report_error)
    warden = Warden(report, is_headless=options.is_headless)
    try:
        return await _supervised(options, warden, report, events)
    finally:
        printer.close()


async def _supervised(options: Options, warden: Warden, report: Report, events: EventLog) -> End:
    loop = asyncio.get_running_loop()
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        loop.add_signal_handler(number, warden.interrupt)
    # A suspended warden cannot stop a robot: Ctrl-Z is an emergency stop instead, and a terminal
    # that background processes must not write to (`stty tostop`) does not suspend it.
    signal.signal(signal.SIGTTOU, signal.SIG_IGN)
    loop.add_signal_handler(signal.SIGTSTP, _stopper(warden, report))
    plan = await warden.load(options.for_loop())
    if plan is None:
        return warden.end_of_load
    for text in plan.warnings:
        report({"type": "message", "message": f"warning: {text}"})
    # A slow lookup of one robot's name must not hold up those of others: threads for each.
    loop.set_default_executor(ThreadPoolExecutor(max_workers=3 * len(plan.robots)))
    with ExitStack() as stack:
        try:
            drive = Drive(plan, str(options.fleet), warden.record)
            locks = await _locked(stack, plan, warden.new_locks)
            endpoint = await _publish(stack, drive, Control(warden, drive, events), report)
        except (LockedError, OSError) as error:
            report({"type": "message", "message": str(error)})
            await warden.close()
            return End.INVALID
        page = None if warden.run is None else start_page(warden.run, endpoint, report)
        if page is not None:
            warden.page = page.add
        end = await warden.drive(plan, locks)
        if page is not None:
            await page.end()
    report(
        {
            "type": "end",
            "reason": end.reason,
            "exit_code": end.exit_code,
            "unconfirmed": warden.unconfirmed(),
            "unseen_speed_m_s": warden.unseen_speed_m_s,
            "was_late": warden.was_late,
            "late_steps": warden.late_steps,
            "behind_s": warden.behind_s,
            "max_behind_s": warden.max_behind_s,
        }
    )
    return end


async def _locked(
    stack: ExitStack, plan: FleetPlan, new: Callable[[], AddressLocks]
) -> dict[str, AddressLocks]:
    """Lock the robots for this drive until the stack is closed; return the locks of each robot."""
    found = await asyncio.gather(*(addresses(robot) for robot in plan.robots))
    locks = {robot.name: new() for robot in plan.robots}
    for own, each in zip(locks.values(), found, strict=True):
        stack.callback(own.close)
        own.take(each)
    return locks


async def _publish(stack: ExitStack, drive: Drive, control: Control, report: Report) -> Endpoint:
    """Let other programs stop this drive until the stack is closed."""
    endpoint = Endpoint(control.actions())
    await endpoint.start()
    stack.callback(endpoint.close)
    host, port = endpoint.address
    entry = RunningDrive(os.getpid(), drive.fleet, host, port, endpoint.token)

    def warn(text: str) -> None:
        report({"type": "message", "message": text})

    stack.enter_context(published(entry, warn))
    return endpoint


async def addresses(robot: RobotPlan) -> list[tuple[str, int]]:
    """Return all numeric addresses of a motor port; none if they are not known within some seconds.

    What is not known yet is locked when the motor port is connected.
    """
    port = robot.ports[DRIVERS[robot.driver].motor_port]
    lookup = asyncio.get_running_loop().getaddrinfo(robot.host, None, type=socket.SOCK_STREAM)
    try:
        async with asyncio.timeout(RESOLVE_S):
            found = await lookup
    except (OSError, TimeoutError, UnicodeError):  # no name of a host, such as "a..b"
        return []
    return [(str(each[4][0]), port) for each in found]


def _stopper(warden: Warden, report: Report) -> Callable[[], None]:
    def stop() -> None:
        warden.stop()
        report({"type": "message", "message": "Emergency stop (Ctrl-Z); Ctrl-C ends the drive."})

    return stop
