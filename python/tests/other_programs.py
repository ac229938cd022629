"""Programs beside the tests, also of another user, and networks that only one test sees."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import pytest

from agent_economy.live.local_socket import HAS_ABSTRACT

OTHER_UID = 65534

needs_abstract = pytest.mark.skipif(not HAS_ABSTRACT, reason="needs abstract sockets")
needs_root = pytest.mark.skipif(os.geteuid() != 0, reason="needs root, to act as another user")

# Everything is imported before: the other user may not be allowed to read the installation.
AS_USER = """
import os, socket, struct, sys, time
if {uid}:
    os.setgroups([])
    os.setgid({uid})
    os.setuid({uid})
"""


@contextmanager
def program(code: str, *arguments: str, uid: int | None = None) -> Iterator[subprocess.Popen[str]]:
    """Run a program until the block ends; it has printed a line when the block begins."""
    command = [sys.executable, "-c", AS_USER.format(uid=uid or 0) + code, *arguments]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    try:
        process.stdout.readline()
        yield process
    finally:
        process.kill()
        process.wait(10)
