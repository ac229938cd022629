"""Stops all robots when the warden cannot: the only sockets of the loop."""

import os
import select
import signal
import socket
from collections.abc import Iterable, Mapping
from contextlib import suppress
from time import sleep

from agent_economy.live.clock import now_s
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.locks import AddressLocks, InheritedLocks, LockedError
from agent_economy.live.plan import FleetPlan, RobotPlan

Address = tuple[str, int]

REPEAT_S, LAST_S = 0.1, 5.0
"""Stop lines are repeated, and refused connections tried again, for this time."""


def stop_all(
    plan: FleetPlan,
    peers: Mapping[str, Address],
    warden_pid: int,
    locks: InheritedLocks | None = None,
) -> None:
    """End the warden, open the motor ports and stop all robots; returns after some seconds.

    The locks of the warden, of which this process has copies, keep other drives from starting.

    The warden is ended first: a robot may accept a single motor connection. `peers` has the
    numeric addresses of motor ports that have been connected; others would take a name lookup.
    """
    if os.getppid() == warden_pid:
        with suppress(ProcessLookupError):
            os.kill(warden_pid, signal.SIGKILL)
    if locks is not None:
        locks.take_over()
    began_s = now_s()
    links = [_MotorPort(robot, peers[robot.name]) for robot in plan.robots if robot.name in peers]
    while now_s() - began_s < LAST_S:
        for link in links:
            link.turn()
        _wait(links)
    for link in links:
        link.close()


class _MotorPort:
    """A motor port that is connected without waiting, so that no robot delays another.

    Its lock is taken if no copy of it was inherited.
    """

    def __init__(self, robot: RobotPlan, address: Address) -> None:
        driver = DRIVERS[robot.driver]
        self._address = address
        lines = driver.stop(robot.settings)
        self._stop = b"".join(line.data for line in lines if line.port == driver.motor_port)
        self._socket: socket.socket | None = None
        self._locks, self._is_locked = AddressLocks(), False
        self._sent_s = self._tried_s = float("-inf")

    def turn(self) -> None:
        """Connect if necessary, and write a stop when it is due."""
        self._lock()
        if self._socket is None:
            self._connect()
        if self._socket is not None and now_s() - self._sent_s >= REPEAT_S:
            self._send(self._socket)

    def waiting(self) -> socket.socket | None:
        """Return the socket if it has not been written yet."""
        return self._socket if self._sent_s < self._tried_s else None

    def close(self) -> None:
        """Close after what is queued has been sent."""
        if self._socket is not None:
            self._socket.close()
        self._locks.close()

    def _lock(self) -> None:
        if not self._is_locked:
            # Without it, a stop is written all the same.
            with suppress(LockedError, OSError):
                self._locks.take([self._address])
                self._is_locked = True

    def _connect(self) -> None:
        if now_s() - self._tried_s < REPEAT_S:
            return
        self._tried_s = now_s()
        with suppress(OSError):
            family = socket.AF_INET6 if ":" in self._address[0] else socket.AF_INET
            self._socket = socket.socket(family, socket.SOCK_STREAM)
            self._socket.setblocking(False)  # noqa: FBT003
            self._socket.connect_ex(self._address)

    def _send(self, link: socket.socket) -> None:
        try:
            link.send(self._stop)
            self._sent_s = now_s()
        except BlockingIOError:
            pass
        except OSError as error:
            # Not connected yet, which takes some time, or refused.
            if not isinstance(error, ConnectionError) and self._is_young():
                return
            link.close()
            self._socket = None

    def _is_young(self) -> bool:
        return now_s() - self._tried_s < 1.0


def _wait(links: Iterable[_MotorPort]) -> None:
    sockets = [each for link in links if (each := link.waiting()) is not None]
    if sockets:
        select.select([], sockets, [], REPEAT_S / 5)
    else:
        sleep(REPEAT_S / 5)
