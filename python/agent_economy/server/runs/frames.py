"""Frames of a run, and the setting that they are drawn in."""

import struct
from typing import Any

from agent_economy import _core
from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs import engines
from agent_economy.server.runs.timeline import Timeline

KIND = 1
"""The first number of a frame; a frame of another layout would have another."""

HEADER = struct.Struct("<4Id2I")
"""Kind, generation, tick, robots; time in seconds; items, number of the frame."""


def frame(simulation: Stepped, generation: int, number: int) -> bytes:
    """Return the frame of the current moment, encoded as in `messages`."""
    drawn = engines.of(simulation).drawn(simulation)
    robots = sum(simulation.scenario.robots.values())
    items = len(drawn) - 16 * robots
    tick, time_s = simulation.tick, simulation.time_s
    return HEADER.pack(KIND, generation, tick, robots, time_s, items, number) + drawn


def setting(timeline: Timeline, generation: int) -> dict[str, Any]:
    """Return everything that stays the same from frame to frame until the scenario changes."""
    simulation, log = timeline.simulation, timeline.log
    return {
        "type": "setting",
        "generation": generation,
        "step_s": simulation.step_s,
        "document": _core.read_filled(simulation.scenario.source),
        "robots": list(simulation.robots),
        "changes": [list(change) for change in simulation.changes],
        "log": None if timeline.is_recorded else [list(change) for change in log],
        **engines.of(simulation).still(simulation),
    }
