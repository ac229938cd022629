"""A robot whose ports send without end: the worst that a receiver can get.

It is a program: `python flooding_robot.py`. It prints its ports as JSON, reads the name of a flood
per line, and then sends it on all ports as fast as it is read. Before the first one it sends good
lines at 20 Hz. Each motor line is printed as JSON, with the time of its arrival.
"""

import itertools
import json
import socket
import sys
import threading
import time
from contextlib import suppress

from agent_economy.live.clock import now_s

GOOD = {"compass": b"90.0", "gps": b"36,36.0010,N,121,54.0000,W", "sonar": b"9,9,9,9,9,9"}
PORTS = ("motors", *GOOD)

FLOODS = ("digits", "line ends", "no line end", "good lines", "garbage", "one byte", "mixed")


def flood(name: str, port: str) -> bytes:
    """Return what is repeated on a port."""
    good = GOOD.get(port, b"x") + b"\r\n"
    each = {
        "digits": (b"1" * 4000 + b"x\n") * 16,
        "line ends": b"\n" * 65_536,
        "no line end": b"7" * 65_536,
        "good lines": good * (65_536 // len(good)),
        "garbage": bytes(range(256)) * 256,
        "one byte": b"1",
    }
    if name != "mixed":
        return each[name]
    return b"".join(each[kind] for kind in FLOODS if kind != "mixed")


class FloodingRobot:
    """Serves its ports, each connection in two threads.

    Attributes:
        flood: The current flood; empty for good lines.
        ports: The number of each port.
    """

    def __init__(self) -> None:
        """Start to serve."""
        self.flood = ""
        self.ports: dict[str, int] = {}
        for port in PORTS:
            server = socket.create_server(("127.0.0.1", 0))
            self.ports[port] = server.getsockname()[1]
            threading.Thread(target=self._serve, args=(port, server), daemon=True).start()

    def _serve(self, port: str, server: socket.socket) -> None:
        while True:
            link, _ = server.accept()
            for work in (self._send, self._receive):
                threading.Thread(target=work, args=(port, link), daemon=True).start()

    def _send(self, port: str, link: socket.socket) -> None:
        with suppress(OSError):
            for number in itertools.count():
                if self.flood:
                    link.sendall(flood(self.flood, port))
                elif port in GOOD:
                    # Like a receiver, whose last digit is noise.
                    link.sendall(GOOD[port].replace(b"0,N", b"%d,N" % (number % 3)) + b"\n")
                if not self.flood or self.flood == "one byte":
                    time.sleep(0.001 if self.flood else 0.05)

    def _receive(self, port: str, link: socket.socket) -> None:
        with suppress(OSError):
            for line in link.makefile("rb"):
                if port == "motors":
                    row = {"t_s": now_s(), "line": line.decode().strip()}
                    sys.stdout.write(json.dumps(row) + "\n")
                    sys.stdout.flush()


def main() -> None:
    """Serve until the input ends."""
    robot = FloodingRobot()
    sys.stdout.write(json.dumps(robot.ports) + "\n")
    sys.stdout.flush()
    for line in sys.stdin:
        robot.flood = line.strip()


if __name__ == "__main__":
    main()
