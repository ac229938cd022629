"""Locks that keep two programs from driving one robot."""

import fcntl
import os
import re
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import IO


class LockedError(Exception):
    """Another program drives a robot at this address."""


def runtime_folder() -> Path:
    """Return the folder of locks and running drives, which only this user can read.

    Programs without the variable, such as those that cron starts, find the usual folder too.
    """
    usual = Path(f"/run/user/{os.getuid()}")
    default = str(usual) if usual.is_dir() else tempfile.gettempdir()
    base = os.environ.get("XDG_RUNTIME_DIR") or default
    folder = Path(base) / f"agent-economy-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    if folder.stat().st_uid != os.getuid():
        message = f"{folder}: belongs to another user: remove it, or set XDG_RUNTIME_DIR"
        raise PermissionError(message)
    return folder


class AddressLocks:
    """Holds locks on addresses until closed, or until this process dies."""

    def __init__(self) -> None:
        """Hold nothing."""
        self._files: list[IO[bytes]] = []

    def take(self, addresses: Sequence[tuple[str, int]]) -> None:
        """Lock all addresses, of which the hosts are numeric if they can be resolved.

        Raises:
            LockedError: If another program has one of them.
        """
        for host, port in addresses:
            name = re.sub(r"[^0-9A-Za-z.:-]", "_", f"{host}:{port}")
            file = (runtime_folder() / f"{name}.lock").open("ab")
            try:
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                file.close()
                message = f"{host}:{port} is being driven by another program: end that one first"
                raise LockedError(message) from None
            self._files.append(file)

    def close(self) -> None:
        """Give up all locks."""
        for file in self._files:
            file.close()
        self._files.clear()
