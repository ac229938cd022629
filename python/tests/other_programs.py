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


ALONE = """
import fcntl, os, socket, struct, sys
with socket.socket() as link:
    name, up = b"lo", 1
    fcntl.ioctl(link, 0x8914, struct.pack("16sh22x", name, up))
os.execv(sys.argv[1], sys.argv[1:])
"""
"""Switches on the loopback interface of a new network, and becomes another program."""


def in_own_network(*command: str) -> list[str]:
    """Return a command that runs in a network of its own, in which no other program is found."""
    rights = ["--net"] if os.geteuid() == 0 else ["--net", "--map-root-user"]
    return ["unshare", *rights, sys.executable, "-c", ALONE, *command]


def _has_networks() -> bool:
    try:
        done = subprocess.run(in_own_network("/bin/true"), capture_output=True, check=False)
    except OSError:
        return False
    return done.returncode == 0


needs_network = pytest.mark.skipif(not _has_networks(), reason="needs networks of its own")
