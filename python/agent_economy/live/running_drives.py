"""The drives that run on this machine, so that another terminal can stop them."""

import json
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import asdict, dataclass
from http.client import HTTPConnection, HTTPException
from pathlib import Path

from agent_economy.live.locks import runtime_folder

TIMEOUT_S = 3.0


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


def running() -> list[RunningDrive]:
    """Return the drives that run; files that killed ones left are removed."""
    return [drive for path in _folder().glob("*.json") if (drive := _read(path)) is not None]


@contextmanager
def registered(drive: RunningDrive) -> Iterator[None]:
    """List a drive while it runs; only this user can read its token."""
    path = _folder() / f"{drive.pid}.json"
    path.unlink(missing_ok=True)
    file = os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    with os.fdopen(file, "w") as stream:
        json.dump(asdict(drive), stream)
    try:
        yield
    finally:
        path.unlink(missing_ok=True)


def _folder() -> Path:
    folder = runtime_folder() / "drives"
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder


def _read(path: Path) -> RunningDrive | None:
    with suppress(OSError, ValueError, TypeError):
        drive = RunningDrive(**json.loads(path.read_text()))
        try:
            os.kill(drive.pid, 0)
        except ProcessLookupError:
            path.unlink(missing_ok=True)
            return None
        return drive
    return None
