"""What a page draws: frames, and the setting that frames are drawn in."""

import struct
from typing import Any

from agent_economy import _core
from agent_economy.server.runs import engines
from agent_economy.server.runs.timeline import Timeline
from agent_economy.stepped import Stepped

KIND = 1
"""The first number of a frame: of another layout it would be another."""

HEADER = struct.Struct("<4Id2I")
"""Kind, generation, tick, robots; time in seconds; items, number of the frame."""


def frame(simulation: Stepped, generation: int, number: int) -> bytes:
    """Return one moment, as `messages` says."""
    drawn = engines.of(simulation).drawn(simulation)
    robots = sum(simulation.scenario.robots.values())
    items = len(drawn) - 16 * robots
    tick, time_s = simulation.tick, simulation.time_s
    return HEADER.pack(KIND, generation, tick, robots, time_s, items, number) + drawn


def setting(timeline: Timeline, generation: int) -> dict[str, Any]:
    """Return all that stays from frame to frame until something is changed."""
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
