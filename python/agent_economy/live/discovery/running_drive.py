"""A drive that runs, as other programs know it."""

import json
import socket
from dataclasses import asdict, dataclass
from time import monotonic, sleep

HOST = "127.0.0.1"
"""The host of every endpoint: an entry of another user must not send requests elsewhere."""

TIMEOUT_S = 3.0

AGAIN_S = 0.02
"""Time until a request whose connection was closed is sent again."""

MAX_BYTES = 2**16
"""Size of an entry and of an answer; more is none."""


@dataclass(frozen=True)
class RunningDrive:
    """A drive that runs.

    Attributes:
        pid: Its process.
        fleet: Its fleet file.
        host: The host of its endpoint.
        port: The port of its endpoint.
        token: What requests to it have to contain.
    """

    pid: int
    fleet: str
    host: str
    port: int
    token: str

    def encoded(self) -> bytes:
        """Return it as a line of JSON."""
        return json.dumps(asdict(self)).encode() + b"\n"

    def request(self, path: str) -> tuple[bool, str]:
        """Send a request; return whether it was accepted, and the answer in words.

        A connection that ends without an answer is replaced: other programs may flood the endpoint
        with connections, and a stop must get through all the same.
        """
        until_s = monotonic() + TIMEOUT_S
        while True:
            try:
                return self._answer(path, until_s)
            except TimeoutError:
                return False, f"no answer within {TIMEOUT_S:g} s"
            except ConnectionRefusedError as error:
                return False, f"no answer: {error.strerror or error}"
            except OSError as error:
                if monotonic() + AGAIN_S > until_s:
                    return False, f"no answer: {error.strerror or error}"
            except (ValueError, KeyError, IndexError, TypeError, RecursionError):
                return False, "an answer that is none of a drive"
            sleep(AGAIN_S)

    def _answer(self, path: str, until_s: float) -> tuple[bool, str]:
        body = json.dumps({"token": self.token}).encode()
        head = f"POST {path} HTTP/1.1\r\nHost: {self.host}\r\nConnection: close\r\n"
        head += f"Content-Length: {len(body)}\r\n\r\n"
        with socket.create_connection((self.host, self.port), TIMEOUT_S) as link:
            link.sendall(head.encode() + body)
            data = received(link, until_s)
        if not data:
            message = "the connection was closed"
            raise ConnectionResetError(message)
        start, _, answer = data.partition(b"\r\n\r\n")
        return start.split(b" ")[1] == b"200", str(json.loads(answer)["message"])


def received(link: socket.socket, until_s: float) -> bytes:
    """Return all that a connection sends until it ends, or until it is too long for a drive.

    Raises:
        OSError: If it fails; TimeoutError if it does not end in time.
    """
    data = bytearray()
    while len(data) < MAX_BYTES:
        link.settimeout(max(1e-3, until_s - monotonic()))
        part = link.recv(MAX_BYTES - len(data))
        if not part:
            break
        data += part
        if monotonic() > until_s:
            raise TimeoutError
    return bytes(data)


def drive_of(data: bytes) -> RunningDrive | None:
    """Return the drive that a line describes; None if it describes none."""
    try:
        values = json.loads(data)
        drive = RunningDrive(**{name: values[name] for name in RunningDrive.__annotations__})
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    kinds = {name: type(value) for name, value in vars(drive).items()}
    is_valid = kinds == RunningDrive.__annotations__ and drive.host == HOST
    return drive if is_valid and 0 < drive.port < 2**16 else None
