"""The program of the loop; the warden starts it."""

import argparse
import os
import sys
from base64 import b64encode
from contextlib import suppress
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.live import fleet
from agent_economy.live.channel import SILENCE_S
from agent_economy.live.external import bodies_of
from agent_economy.live.locks import InheritedLocks
from agent_economy.live.loop.last_resort import stop_all
from agent_economy.live.loop.log import LogOptions
from agent_economy.live.loop.loop import Loop
from agent_economy.live.loop.pipe import Pipe, WardenLostError
from agent_economy.runs.external import plain

INVALID, LOST = 2, 3
"""Exit codes: the input is not valid; the warden was lost, and the robots have been stopped."""


def main() -> int:
    """Run the loop; return its exit code."""
    parser = argparse.ArgumentParser()
    parser.add_argument("fleet", type=Path)
    parser.add_argument("--record", type=Path, required=True)
    parser.add_argument("--numbered", action="store_true", help="NAME-2.mcap if it exists.")
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--page", action="store_true", help="Report the run and all its inputs.")
    parser.add_argument("--locks", type=int, required=True, help="Descriptor that they arrive at.")
    arguments = parser.parse_args()
    locks = InheritedLocks(arguments.locks)
    warden = os.getppid()
    pipe = Pipe()
    try:
        loaded = fleet.load(arguments.fleet)
        options = LogOptions(arguments.record, arguments.numbered, arguments.every)
        loop = Loop(loaded, pipe, options, arguments.seed, has_page=arguments.page)
    except InputError as error:
        pipe.send({"type": "invalid", "message": str(error), "errors": error.errors})
        return INVALID
    if arguments.page:
        pipe.send({"type": "run", "run": described(loaded, arguments.seed)})
    pipe.send({"type": "plan", "plan": loaded.plan.to_dict(), "record": str(loop.record)})
    pipe.watch()
    try:
        loop.run()
    except WardenLostError:
        stop_all(loaded.plan, loop.peers, warden, locks)
        locks.close()
        loop.close()
        explain()
        return LOST
    return 0


def described(loaded: fleet.Fleet, seed: int) -> dict[str, Any]:
    """Return what another process needs to step the same run; files are in base 64."""
    source = loaded.scenario.source
    files = {
        name: b64encode(data).decode()
        for name, data in source.files.items()
        if isinstance(data, bytes)
    }
    return {
        "fleet": loaded.file,
        "scenario": {"file": source.file, "text": source.text, "files": files},
        "seed": seed,
        "external": plain(bodies_of(loaded.plan)),
        "scans": {robot.name: robot.scans for robot in loaded.plan.robots},
        "origin": loaded.plan.to_dict()["origin"],
        "fences_m": {robot.name: robot.fence_m for robot in loaded.plan.robots},
    }


def explain() -> None:
    """Report why the drive has ended; after the stop, since a terminal may hold the text up."""
    text = (
        f"The warden had ended, or was silent for more than {SILENCE_S:g} s, as on a busy or "
        "suspended machine. The loop has ended it and sent stop to the robots; whether they "
        "stand is not confirmed.\n"
    )
    with suppress(OSError):
        sys.stderr.write(text)
        sys.stderr.flush()


if __name__ == "__main__":
    sys.exit(main())
