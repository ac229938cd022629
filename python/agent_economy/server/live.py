"""The server of a drive's page. The warden starts it, as `python -m agent_economy.server.live`.

`agent_economy.live.warden.page_process` describes the messages on its standard input and output. It
has no part in the drive: the warden runs on if it ends.
"""

import json
import os
import socket
import sys
import threading
from base64 import b64decode
from collections.abc import Iterable, Iterator, Mapping
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

import uvicorn

from agent_economy import _core
from agent_economy.live.channel import Decoder
from agent_economy.recording.stops import Stop
from agent_economy.runs.external import external_body
from agent_economy.scenario import Scenario, Source
from agent_economy.server.app import app
from agent_economy.server.runs.live_run import LiveRun
from agent_economy.server.serving import http_server
from agent_economy.server.workspace import Workspace
from agent_economy.types.warden import Drive, Sonar

BLOCK_BYTES = 2**16


def main() -> None:
    """Serve the page until the input ends."""
    received = messages()
    start = next(received)
    scenario = scenario_of(start["scenario"])
    external = {name: external_body(values) for name, values in start["external"].items()}
    live = LiveRun(scenario, start["seed"], external)
    listening = socket.socket(fileno=start["listening"])
    # Of all programs, only this server may have it from here on.
    listening.set_inheritable(False)
    host, port = listening.getsockname()
    token = start["token"]
    served = app(Workspace(Path.cwd()), host, token, live, drive_of(start, scenario))
    server = http_server(served, partial(os._exit, 0))
    threading.Thread(target=receive, args=(received, live, server), daemon=True).start()
    url = f"http://{host}:{port}/?token={token}#/robots"
    with suppress(BrokenPipeError):  # the drive has ended already; so will the input
        os.write(sys.stdout.fileno(), json.dumps({"type": "ready", "url": url}).encode() + b"\n")
    server.run(sockets=[listening])


def messages() -> Iterator[dict[str, Any]]:
    """Yield the messages on standard input, until it ends."""
    decoder = Decoder()
    # Without a buffer: Python waits for the lock of a buffer that a thread reads when it ends.
    while data := os.read(sys.stdin.fileno(), BLOCK_BYTES):
        yield from decoder.feed(data)


def receive(received: Iterable[Mapping[str, Any]], live: LiveRun, server: uvicorn.Server) -> None:
    """Pass on the inputs of all steps, and end the server after the last one."""
    try:
        for message in received:
            stops = [
                Stop(tick, robot, action, tuple(reasons))
                for tick, robot, action, reasons in message["stops"]
            ]
            live.append(message["tick"], message["inputs"], stops)
    finally:
        live.end()
        server.should_exit = True


def scenario_of(source: Mapping[str, Any]) -> Scenario:
    """Return the scenario of a drive.

    Raises:
        InputError: If it has errors.
    """
    files = {name: b64decode(data) for name, data in source["files"].items()}
    return Scenario.of(Source(source["file"], source["text"], (), files))


def drive_of(start: Mapping[str, Any], scenario: Scenario) -> Drive:
    """Return where the warden is, and what the map draws of each robot."""
    kinds = _core.read_filled(scenario.source)["robots"]
    fences_m = start["fences_m"]
    return {
        "warden": start["warden"],
        "fleet": Path(start["fleet"]).stem,
        "origin": start["origin"],
        "robots": {
            name: {
                "fence_m": fences_m.get(name),
                "sonars": sonars_of(kinds[name.rpartition("/")[0]], start["scans"][name]),
            }
            for name in start["external"]
        },
    }


def sonars_of(kind: Mapping[str, Any], scans: Iterable[int | None]) -> list[Sonar]:
    """Return the range sensors of a robot that are sonars, in the order of their names.

    Args:
        kind: Its kind in the scenario.
        scans: For each range sensor of the kind, the number of its sonar; None for a virtual one.
    """
    sensors = sorted(kind.get("sensors", {}).items())
    ranges = [sensor for _, sensor in sensors if sensor["kind"] == "range"]
    return [
        {"facing_deg": sensor.get("facing_deg", 0.0), "max_m": sensor["range_m"]}
        for sensor, sonar in zip(ranges, scans, strict=True)
        if sonar is not None
    ]


if __name__ == "__main__":
    main()
