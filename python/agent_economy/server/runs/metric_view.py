"""What a page draws of a run of the metric engine, in metres."""

import base64
import math
from collections.abc import Mapping
from typing import Any

from agent_economy import _core
from agent_economy.recording.static_scene import states
from agent_economy.runs.simulation import Simulation


def drawn(simulation: Simulation) -> bytes:
    """Return one moment: see `_core.frame`."""
    return _core.frame(simulation._run)  # noqa: SLF001  (ours)


def still(simulation: Simulation) -> dict[str, Any]:
    """Return the world, what is in it, and robots as they are made."""
    document = simulation.scenario.to_dict()
    recorded = _core.recorded_setting(simulation._run)  # noqa: SLF001  (ours)
    items = simulation.items
    places = zip(
        items["kind"].to_pylist(), items["x_m"].to_pylist(), items["y_m"].to_pylist(), strict=True
    )
    kinds = document.get("items", {})
    world = document["world"]
    return {
        "world": {
            "size": world["size_m"],
            "periodic": world.get("periodic", False),
            "unit": "m",
            "cell": None,
        },
        "kinds": [
            kind(name, count, recorded) for name, count in simulation.scenario.robots.items()
        ],
        "items": [
            {
                "kind": name,
                "at": [x, y],
                "target": kinds.get(name, {}).get("target", True),
                "contact": [],
            }
            for name, x, y in places
        ],
        "item_kinds": sorted(kinds),
        "maps": [map_of(each) for each in recorded["maps"]],
    }


def kind(name: str, count: int, recorded: Mapping[str, Any]) -> dict[str, Any]:
    """Return what is drawn of a robot kind."""
    body = recorded["bodies"][name]
    return {
        "name": name,
        "count": count,
        "radius": body["radius_m"],
        "flies": recorded["flies"][name],
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
        "corners": recorded["corners_m"],
        "columns": columns,
        "rows": rows,
        "cells": base64.b64encode(states(occupancy).tobytes()).decode(),
    }
