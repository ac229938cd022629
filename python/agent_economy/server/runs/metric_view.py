"""What a page draws of a run of the metric engine, in metres."""

import base64
import math
from collections.abc import Mapping
from typing import Any

from agent_economy import _core
from agent_economy.recording.static_scene import states
from agent_economy.runs.simulation import Simulation
from agent_economy.types.page import CircleView, KindView, MapView, ObstacleView, SensorView


def drawn(simulation: Simulation) -> bytes:
    """Return the current moment: see `_core.frame`."""
    return _core.frame(simulation._run)  # noqa: SLF001  (ours)


def still(simulation: Simulation) -> dict[str, Any]:
    """Return the world, its obstacles and items, and the robot kinds."""
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
            kind_view(name, count, recorded) for name, count in simulation.scenario.robots.items()
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
        "obstacles": [obstacle_view(each) for each in recorded["shapes"]],
        "maps": [map_view(each) for each in recorded["maps"]],
    }


def kind_view(name: str, count: int, recorded: Mapping[str, Any]) -> KindView:
    """Return what is drawn of a robot kind."""
    body = recorded["bodies"][name]
    return {
        "name": name,
        "count": count,
        "radius": body["radius_m"],
        "is_flying": recorded["flies"][name],
        "radio_range_m": recorded["radio_m"][name],
        "rings": [
            {"bearings_rad": each["bearings_rad"], "range_m": each["range_m"]}
            for each in body["rings"]
        ],
        "sensors": [
            *map(ring_sector, body["rings"]),
            *(detector_sector(body, each) for each in body["detectors"]),
        ],
    }


def ring_sector(ring: Mapping[str, Any]) -> SensorView:
    """Return the sector of a range ring: half a beam wider than its outermost beams."""
    bearings = ring["bearings_rad"]
    first, last = bearings[0], bearings[-1]
    apart = (last - first) / max(1, len(bearings) - 1)
    return {
        "name": "range",
        "kind": "range",
        "range_m": ring["range_m"],
        "width_rad": min(math.tau, last - first + apart),
        "facing_rad": (first + last) / 2,
    }


def detector_sector(body: Mapping[str, Any], detector: Mapping[str, Any]) -> SensorView:
    """Return the sector in which a detector finds items."""
    return {
        "name": body["sensors"][detector["sensor"]],
        "kind": "items",
        "range_m": detector["range_m"],
        "width_rad": detector["width_rad"],
        "facing_rad": detector["facing_rad"],
    }


def obstacle_view(shape: Mapping[str, Any]) -> ObstacleView:
    """Return an obstacle other than a map."""
    circle: CircleView | None = None
    if "radius_m" in shape:
        circle = {"at": shape["at_m"], "radius": shape["radius_m"]}
    return {"entry": shape["entry"], "polygon": shape.get("polygon_m"), "circle": circle}


def map_view(recorded: Mapping[str, Any]) -> MapView:
    """Return an obstacle map, the lowest row first."""
    occupancy = recorded["occupancy"]
    rows, columns = occupancy.shape
    return {
        "corners": recorded["corners_m"],
        "columns": columns,
        "rows": rows,
        "cells": base64.b64encode(states(occupancy).tobytes()).decode(),
    }
