"""Hosts and ports: each can exist, and no two connections go to the same one.

Nothing is resolved here: names are resolved when robots are connected.
"""

import ipaddress
import re
from collections.abc import Iterable

from agent_economy._core import Document
from agent_economy.live.fleet_file.entry import PORTS_PER_ROBOT, Entry
from agent_economy.live.fleet_file.findings import Findings

MAX_PORT = 65535
MAX_HOST_LENGTH = 253

# An underscore is no part of a host name, but some local networks have names with one.
_LABEL = re.compile(r"[A-Za-z0-9_]([A-Za-z0-9_-]{0,61}[A-Za-z0-9_])?")

_ALLOWED_HOST = "a host name such as bender.local or an IP address, without a port"


def check_network(findings: Findings, fleet: Document, entries: Iterable[Entry]) -> None:
    """Report hosts that cannot exist, port numbers beyond the last one, and shared ports."""
    owners: dict[tuple[str, int], str] = {}
    for entry in entries:
        host = _normal(entry.host)
        if host is None:
            findings.error(fleet, (*entry.path, "host"), _ALLOWED_HOST)
        for port, number in entry.ports.items():
            path = (*entry.path, "ports", port)
            if number > MAX_PORT:
                allowed = (
                    f"a whole number from 1 to {MAX_PORT}: without it, it is the usual number plus "
                    f"{PORTS_PER_ROBOT} times the index of the robot, {number}"
                )
                findings.error(fleet, path, allowed)
            owner = owners.setdefault((host or entry.host, number), f"{port} of {entry.name}")
            if owner != f"{port} of {entry.name}":
                allowed = f"another number than {number}, which is port {owner} on the same host"
                findings.error(fleet, path, allowed)


def _normal(host: str) -> str | None:
    """Return one string for hosts that are certainly the same; None for what is no host."""
    try:
        address = ipaddress.ip_address(host)
    except ValueError:
        return _normal_name(host)
    is_one = not (address.is_unspecified or address.is_multicast or str(address) == _BROADCAST)
    return str(address) if is_one else None


_BROADCAST = "255.255.255.255"


def _normal_name(host: str) -> str | None:
    try:
        name = host.encode("idna").decode().removesuffix(".").lower()
    except UnicodeError:
        return None
    labels = name.split(".")
    is_name = all(_LABEL.fullmatch(label) for label in labels) and len(name) <= MAX_HOST_LENGTH
    # A last label of digits is an address with an error: 127.0.0.256.
    if not is_name or labels[-1].isdigit():
        return None
    return "127.0.0.1" if name == "localhost" else name
