"""The control port: requests and replies, one JSON object per line."""

import json
from collections.abc import Mapping
from typing import Any, Protocol

from agent_economy._core import InputError
from agent_economy.live.emulator.faults import PORTS

FORMS = (
    '{"robot": 0, "port": "sonar", "fault": "stall", "on": true, "value": null}, '
    '{"set": {"gps_hz": 2}}, {"get": "state"} or {"get": "settings"}'
)
"""All requests."""

FAULT_KEYS = {"robot", "port", "fault", "on", "value"}


class Controlled(Protocol):
    """What a control port controls."""

    async def fault(
        self, robot: int, port: str, name: str, value: Any = None, *, on: bool = True
    ) -> None:
        """Switch a fault on or off."""

    def set(self, values: Mapping[str, Any]) -> None:
        """Change settings."""

    def state(self) -> dict[str, Any]:
        """Return the state of all robots."""

    def settings_as_dict(self) -> dict[str, Any]:
        """Return all settings."""


async def reply(line: bytes, controlled: Controlled) -> dict[str, Any]:
    """Carry out the request of a line and return the reply: `ok`, and the result or the error."""
    try:
        return {"ok": True, **await _carried_out(_request(line), controlled)}
    except InputError as error:
        return {"ok": False, "error": str(error)}


def _request(line: bytes) -> dict[str, Any]:
    try:
        request = json.loads(line)
    except (ValueError, RecursionError):
        request = None
    if not isinstance(request, dict):
        shown = line[:80].decode("utf-8", "replace")
        message = f"{shown!r}: not a JSON object on one line: expected {FORMS}"
        raise InputError(message)
    return request


async def _carried_out(request: dict[str, Any], controlled: Controlled) -> dict[str, Any]:
    match request:
        case {"get": "state", **rest} if not rest:
            return {"state": controlled.state()}
        case {"get": "settings", **rest} if not rest:
            return {"settings": controlled.settings_as_dict()}
        case {"set": dict() as values, **rest} if not rest:
            controlled.set(values)
            return {"settings": controlled.settings_as_dict()}
        case {"fault": str() as name, **rest} if rest.keys() <= FAULT_KEYS:
            await _switch(name, rest, controlled)
            return {}
    message = f"{json.dumps(request)}: not a request: expected {FORMS}"
    raise InputError(message)


async def _switch(name: str, request: dict[str, Any], controlled: Controlled) -> None:
    robot, port, on = request.get("robot"), request.get("port"), request.get("on", True)
    if not isinstance(robot, int) or isinstance(robot, bool):
        message = f"robot = {json.dumps(robot)}: must be the number of a robot, from 0"
        raise InputError(message)
    if port not in PORTS:
        message = f"port = {json.dumps(port)}: must be one of {', '.join(PORTS)}"
        raise InputError(message)
    if not isinstance(on, bool):
        message = f"on = {json.dumps(on)}: must be true or false"
        raise InputError(message)
    await controlled.fault(robot, port, name, request.get("value"), on=on)
