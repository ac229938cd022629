"""Frames of a run, and the setting that they are drawn in.

A frame in little endian is a header of eight numbers, `u32` except the time: 1, generation of the
setting, tick, robots, time in seconds (`f64`), items, number of the frame; then what `_core.frame`
or the frame of a classic run contains.
"""

import json
import struct
from typing import Any

from agent_economy import _core
from agent_economy.runs.stepped import Stepped
from agent_economy.server.parameters import parameters
from agent_economy.server.runs import engines
from agent_economy.server.runs.run import Run
from agent_economy.server.runs.shown import subjects
from agent_economy.server.runs.versions import Version
from agent_economy.types.page import Setting, VersionView

KIND = 1
"""The first number of a frame; a frame of another layout would have another."""

HEADER = struct.Struct("<4Id2I")
"""Kind, generation, tick, robots; time in seconds; items, number of the frame."""

ROBOT_BYTES = 16

MAX_VALUE = 60
"""Maximum number of characters of the value of a change in the list of versions."""


def frame(simulation: Stepped, generation: int, number: int) -> bytes:
    """Return the frame of the current moment."""
    drawn = engines.of(simulation).drawn(simulation)
    robots = sum(simulation.scenario.robots.values())
    items = len(drawn) - ROBOT_BYTES * robots
    tick, time_s = simulation.tick, simulation.time_s
    return HEADER.pack(KIND, generation, tick, robots, time_s, items, number) + drawn


def setting(run: Run, generation: int) -> Setting:
    """Return everything that stays the same from frame to frame until the scenario changes."""
    simulation, log = run.simulation, run.log
    own: Any = {
        "type": "setting",
        "generation": generation,
        "step_s": simulation.step_s,
        "document": _core.read_filled(simulation.scenario.source),
        "parameters": parameters(simulation.scenario),
        "robots": simulation.robots,
        "external": list(simulation.declared_external),
        "changes": simulation.changes,
        "log": None if run.is_recorded else log,
        "versions": [version_view(version) for version in run.versions.all.values()],
        "version": run.versions.current.number,
        "can_redo": run.versions.can_redo,
        "offer": subjects.offer(simulation),
    }
    whole: Setting = own | engines.of(simulation).still(simulation)
    return whole


def version_view(version: Version) -> VersionView:
    """Return what a page displays of a version of a run."""
    change, parent = version.change, version.parent
    return {
        "number": version.number,
        "parent": None if parent is None else parent.number,
        "tick": 0 if change is None else change.tick,
        "path": "" if change is None else change.path,
        "value": "" if change is None else shortened(json.dumps(change.value)),
        "latest_tick": version.latest_tick,
    }


def shortened(text: str) -> str:
    """Return a string of at most `MAX_VALUE` characters."""
    return text if len(text) <= MAX_VALUE else f"{text[: MAX_VALUE - 1]}…"
