"""Serves the page of a drive that is simulated, for browser tests: `live_page.py PORT TOKEN`.

PORT and TOKEN are those of a warden. The robot `bender/0` gets the percepts that it has in a
simulation of the same run. Address and process of each server of the page are written as a line of
JSON. The drive ends with the standard input.
"""

import asyncio
import json
import sys
from collections.abc import Mapping
from typing import Any

import agent_economy as ae
from agent_economy.live.warden.page_process import COMMAND, PageProcess

ROBOT, SEED = "bender/0", 7
SECRET = "secret-of-the-page"  # noqa: S105  (of a test)


def start_message(port: int, token: str) -> Mapping[str, Any]:
    """Return the first message for the server."""
    scenario = ae.Scenario.load("bender-team")
    return {
        "type": "start",
        "fleet": "bender-team.toml",
        "scenario": {"file": "bender-team.toml", "text": scenario.source.text, "files": {}},
        "seed": SEED,
        "external": {ROBOT: {}},
        "scans": {ROBOT: list(range(6))},
        "origin": scenario.to_dict()["world"]["origin"],
        "fences_m": {},
        "warden": {"port": port, "token": token},
        "token": SECRET,
    }


async def drive(port: int, token: str) -> None:
    """Feed the servers in real time."""

    def ready(url: str) -> None:
        sys.stdout.write(json.dumps({"url": url, "pid": page.pid}) + "\n")
        sys.stdout.flush()

    page = PageProcess(start_message(port, token), ready, lambda: sys.exit(1), COMMAND)
    page.start()
    simulation = ae.Simulation(ae.Scenario.load("bender-team"), SEED)
    ended = asyncio.create_task(asyncio.to_thread(sys.stdin.read))
    while not ended.done():
        percept = simulation.percept(ROBOT)
        inputs = {} if percept is None else {ROBOT: percept}
        page.add(
            {"type": "input", "tick": simulation.tick, "inputs": {"percepts": inputs}, "stops": []}
        )
        simulation.step()
        await asyncio.sleep(simulation.step_s)
    await page.end()


if __name__ == "__main__":
    asyncio.run(drive(int(sys.argv[1]), sys.argv[2]))
