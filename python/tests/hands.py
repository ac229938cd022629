"""A client that drives robots by hand."""

import json
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from http.client import HTTPConnection, HTTPException
from typing import Any

from live_bench import Drive
from priority import raised_priority

from agent_economy.live.clock import now_s

PERIOD_S = 0.1
NEUTRAL = 150


class Hands:
    """The operator of a drive: it sends the values of the tracks of some robots, again and again.

    Attributes:
        client: Its name.
        last_s: When it sent the last values.
    """

    def __init__(self, drive: Drive) -> None:
        """Create it; it sends nothing yet."""
        self.client, self.last_s = "hands", 0.0
        self._drive, self._value, self._number = drive, NEUTRAL, 0
        self._robots: Sequence[str] = ()
        self._closed = threading.Event()
        self._thread: threading.Thread | None = None

    def take(self, robots: Sequence[str]) -> None:
        """Become the operator, switch robots to manual mode, and send neutral values."""
        entry = self._drive.running()
        link = HTTPConnection(entry.host, entry.port, timeout=5)
        common = {"token": entry.token, "client": self.client}
        post(link, "/operator", **common, take=True)
        for robot in robots:
            post(link, "/mode", **common, robot=robot, mode="manual")
        time.sleep(0.2)  # the next turns
        self._robots = robots
        self._thread = threading.Thread(target=self._run, args=(link, common), daemon=True)
        self._thread.start()

    def drive(self, value: int) -> None:
        """Send other values from now on."""
        self._value = value

    def close(self) -> None:
        """Send nothing any more, as a page that is closed."""
        self._closed.set()
        if self._thread is not None:
            self._thread.join(timeout=5)

    def _run(self, link: HTTPConnection, common: dict[str, Any]) -> None:
        with suppress(OSError, HTTPException), raised_priority():  # the drive has ended
            while not self._closed.is_set():
                due_s = now_s() + PERIOD_S
                self._number += 1
                values = {"left": self._value, "right": self._value, "number": self._number}
                for robot in self._robots:
                    self.last_s = now_s()
                    post(link, "/manual", **common, robot=robot, since=10**9, **values)
                self._closed.wait(max(0.0, due_s - now_s()))
        link.close()


def post(link: HTTPConnection, path: str, **body: Any) -> None:
    """Send a request; the connection stays open. It may be refused."""
    link.request("POST", path, json.dumps(body))
    link.getresponse().read()
