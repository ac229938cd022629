"""Starts the warden: signals, locks, the endpoint, and the end of the process."""

import asyncio
import os
import signal
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy.live.drivers import DRIVERS
from agent_economy.live.locks import AddressLocks, LockedError
from agent_economy.live.plan import FleetPlan
from agent_economy.live.running_drives import RunningDrive, registered
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
    # A slow lookup of one robot's name must not hold up those of others: a thread for each.
    loop.set_default_executor(ThreadPoolExecutor(max_workers=2 * len(plan.robots)))
    with ExitStack() as stack:
        try:
            drive = Drive(plan, str(options.fleet), warden.record)
            endpoint = await _publish(stack, drive, Control(warden, drive, events))
        except (LockedError, OSError) as error:
            report({"type": "message", "message": str(error)})
            await warden.close()
            return End.INVALID
        page = None if warden.run is None else start_page(warden.run, endpoint, report)
        if page is not None:
            warden.page = page.add
        end = await warden.drive(plan)
        if page is not None:
            await page.end()
    report(
        {
            "type": "end",
            "reason": end.reason,
            "exit_code": end.exit_code,
            "unconfirmed": warden.unconfirmed(),
            "late_steps": warden.late_steps,
            "behind_s": warden.behind_s,
            "max_behind_s": warden.max_behind_s,
        }
    )
    return end


async def _publish(stack: ExitStack, drive: Drive, control: Control) -> Endpoint:
    """Lock the robots for this drive, and let other programs stop it, until the stack is closed."""
    locks = AddressLocks()
    stack.callback(locks.close)
    locks.take(await addresses(drive.plan))
    endpoint = Endpoint(control.actions())
    await endpoint.start()
    stack.callback(endpoint.close)
    host, port = endpoint.address
    entry = RunningDrive(os.getpid(), drive.fleet, host, port, endpoint.token)
    stack.enter_context(registered(entry))
    return endpoint


async def addresses(plan: FleetPlan) -> list[tuple[str, int]]:
    """Return the address of each motor port, with a numeric host if it can be resolved soon."""
    hosts = await asyncio.gather(*(numeric(robot.host) for robot in plan.robots))
    ports = [robot.ports[DRIVERS[robot.driver].motor_port] for robot in plan.robots]
    return list(zip(hosts, ports, strict=True))


async def numeric(host: str) -> str:
    """Return the address of a host name, or the name if it is not known within some seconds."""
    try:
        async with asyncio.timeout(RESOLVE_S):
            found = await asyncio.get_running_loop().getaddrinfo(host, None)
    except (OSError, TimeoutError, UnicodeError):  # no name of a host, such as "a..b"
        return host
    return str(found[0][4][0])


def _stopper(warden: Warden, report: Report) -> Callable[[], None]:
    def stop() -> None:
        warden.operator.stop = True
        report({"type": "message", "message": "Emergency stop (Ctrl-Z); Ctrl-C ends the drive."})

    return stop
