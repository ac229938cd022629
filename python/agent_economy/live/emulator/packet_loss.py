"""Loses the packets that arrive at a socket, so that nothing is acknowledged: a half-open link."""

import ctypes
import socket
import struct
import sys
from contextlib import suppress

IS_SUPPORTED = sys.platform == "linux"

_SO_ATTACH_FILTER, _SO_DETACH_FILTER = 26, 27
_RETURN_NOTHING = struct.pack("HBBI", 0x06, 0, 0, 0)


def lose_packets(link: socket.socket, *, on: bool) -> None:
    """Let the kernel drop every packet that arrives at a socket, or take them again.

    A classic BPF program decides how much of a packet is taken, here nothing. TCP then behaves as
    if the network were interrupted: it acknowledges nothing, and the sender retransmits.
    """
    if not on:
        with suppress(FileNotFoundError):  # there is none
            link.setsockopt(socket.SOL_SOCKET, _SO_DETACH_FILTER, 0)
        return
    instructions = ctypes.create_string_buffer(_RETURN_NOTHING)
    program = struct.pack("HL", 1, ctypes.addressof(instructions))
    link.setsockopt(socket.SOL_SOCKET, _SO_ATTACH_FILTER, program)
