"""A drive that runs, as other programs know it."""

import json
from dataclasses import asdict, dataclass
from http.client import HTTPConnection, HTTPException

TIMEOUT_S = 3.0

MAX_BYTES = 2**16
"""Size of an entry; more is none."""


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
        """Send a request; return whether it was accepted, and the answer in words."""
        connection = HTTPConnection(self.host, self.port, timeout=TIMEOUT_S)
        try:
            connection.request("POST", path, json.dumps({"token": self.token}))
            response = connection.getresponse()
            answer = json.loads(response.read())["message"]
        except (OSError, HTTPException, ValueError, KeyError) as error:
            return False, f"no answer: {error}"
        finally:
            connection.close()
        return response.status == 200, str(answer)  # noqa: PLR2004


def drive_of(data: bytes) -> RunningDrive | None:
    """Return the drive that a line describes; None if it describes none."""
    try:
        values = json.loads(data)
        drive = RunningDrive(**{name: values[name] for name in RunningDrive.__annotations__})
    except (ValueError, TypeError, KeyError, RecursionError):
        return None
    kinds = {name: type(value) for name, value in vars(drive).items()}
    return drive if kinds == RunningDrive.__annotations__ else None
