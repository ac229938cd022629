"""What a page draws: frames, and the setting that frames are drawn in."""

import base64
import math
import struct
from collections.abc import Mapping
from typing import Any

from agent_economy import _core
from agent_economy.recording.still import states
from agent_economy.server.timeline import Timeline
from agent_economy.simulation import Simulation

KIND = 1
"""The first number of a frame: of another layout it would be another."""

HEADER = struct.Struct("<4Id2I")
"""Kind, generation, tick, robots; time in seconds; items, number of the frame."""


def frame(simulation: Simulation, generation: int, number: int) -> bytes:
    """Return one moment, as `messages` says."""
    run = simulation._run  # noqa: SLF001  (ours)
    drawn = _core.frame(run)
    robots = len(run.robots)
    items = len(drawn) - 16 * robots
    tick, time_s = simulation.tick, simulation.time_s
    return HEADER.pack(KIND, generation, tick, robots, time_s, items, number) + drawn


def setting(timeline: Timeline, generation: int) -> dict[str, Any]:
    """Return all that stays from frame to frame until something is changed."""
    simulation, log = timeline.simulation, timeline.log
    run = simulation._run  # noqa: SLF001  (ours)
    document = _core.read_filled(simulation.scenario.source)
    recorded = _core.recorded_setting(run)
    items = simulation.items
    places = zip(
        items["kind"].to_pylist(), items["x_m"].to_pylist(), items["y_m"].to_pylist(), strict=True
    )
    kinds = document.get("items", {})
    return {
        "type": "setting",
        "generation": generation,
        "document": document,
        "robots": list(simulation.robots),
        "kinds": [
            kind(name, count, recorded) for name, count in simulation.scenario.robots.items()
        ],
        "items": [
            {"kind": name, "at_m": [x, y], "sought": kinds.get(name, {}).get("sought", True)}
            for name, x, y in places
        ],
        "item_kinds": sorted(kinds),
        "maps": [map_of(each) for each in recorded["maps"]],
        "changes": [list(change) for change in simulation.changes],
        "log": None if timeline.is_recorded else [list(change) for change in log],
    }


def kind(name: str, count: int, recorded: Mapping[str, Any]) -> dict[str, Any]:
    """Return what is drawn of a robot kind."""
    body = recorded["bodies"][name]
    return {
        "name": name,
        "count": count,
        "radius_m": body["radius_m"],
        "radio_range_m": recorded["radio_m"][name],
        "rings": [
            {key: each[key] for key in ("bearings_rad", "range_m")} for each in body["rings"]
        ],
        "sensors": [
            *map(ring, body["rings"]),
            *(detector(body, each) for each in body["detectors"]),
        ],
    }


def ring(given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the sector that a range ring sees, a beam's width beyond its outermost beams."""
    bearings = given["bearings_rad"]
    first, last = bearings[0], bearings[-1]
    apart = (last - first) / max(1, len(bearings) - 1)
    return {
        "name": "range",
        "kind": "range",
        "range_m": given["range_m"],
        "width_rad": min(math.tau, last - first + apart),
        "facing_rad": (first + last) / 2,
    }


def detector(body: Mapping[str, Any], given: Mapping[str, Any]) -> dict[str, Any]:
    """Return the sector in which a detector finds items."""
    sector = {key: given[key] for key in ("range_m", "width_rad", "facing_rad")}
    return {"name": body["sensors"][given["sensor"]], "kind": "items", **sector}


def map_of(recorded: Mapping[str, Any]) -> dict[str, Any]:
    """Return a map: of each cell, the lowest row first, 0 free, 1 unknown, 2 occupied."""
    occupancy = recorded["occupancy"]
    rows, columns = occupancy.shape
    return {
        "corners_m": recorded["corners_m"],
        "columns": columns,
        "rows": rows,
        "cells": base64.b64encode(states(occupancy).tobytes()).decode(),
    }
