"""The static parts of a scene, which change only with the scenario."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from foxglove_schemas_protobuf.Grid_pb2 import Grid
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.TextPrimitive_pb2 import TextPrimitive
from foxglove_schemas_protobuf.TriangleListPrimitive_pb2 import TriangleListPrimitive
from foxglove_schemas_protobuf.Vector2_pb2 import Vector2
from numpy.typing import NDArray

from agent_economy.recording.foxglove import (
    WORLD,
    Place,
    color,
    cylinder,
    loop,
    pose,
    stamp,
)

WALL_M = 0.5
"""Drawn height of obstacles; the simulator has no heights."""

FONT_PX = 12.0

BORDER, OBSTACLE, GROUND = "#4c566a", "#7b8494", "#a3773f"

FREE, UNKNOWN, OCCUPIED = (236, 239, 244, 255), (176, 182, 192, 255), (59, 66, 82, 255)
"""Red, green, blue and alpha of the cells of a map."""

FULLY_OCCUPIED = 100


def still(document: Mapping[str, Any], shapes: Sequence[Mapping[str, Any]]) -> list[SceneEntity]:
    """Return the border and the terrain of a scenario's document, and its obstacles except maps.

    Args:
        document: The scenario.
        shapes: The obstacles: see `recorded_setting` of the compiled part.
    """
    width_m, height_m = document["world"]["size_m"]
    corners = [(0, 0), (width_m, 0), (width_m, height_m), (0, height_m)]
    border = SceneEntity(frame_id=WORLD, id="border", lines=[loop(corners, color(BORDER))])
    grounds = sorted(document.get("terrain", {}).items())
    return [
        border,
        *(obstacle(f"obstacle/{each['number']}", each) for each in shapes),
        *(entity for name, each in grounds for entity in areas(name, each["areas_m"])),
    ]


def obstacle(name: str, given: Mapping[str, Any]) -> SceneEntity:
    """Return a polygon or a circle as a solid on the ground."""
    paint = color(OBSTACLE)
    if "radius_m" in given:
        body = cylinder(given["at_m"], given["radius_m"], (0, WALL_M), paint)
        return SceneEntity(frame_id=WORLD, id=name, cylinders=[body])
    corners = given["polygon_m"]
    walls = TriangleListPrimitive(pose=pose(), points=list(walls_of(corners)), color=paint)
    lines = [loop(corners, color(BORDER))]
    return SceneEntity(frame_id=WORLD, id=name, lines=lines, triangles=[walls])


def walls_of(corners: Sequence[Place]) -> Iterator[Point3]:
    """Yield the corners of two triangles per side of a polygon."""
    for (x, y), (next_x, next_y) in zip(corners, [*corners[1:], corners[0]], strict=True):
        low, high = Point3(x=x, y=y), Point3(x=x, y=y, z=WALL_M)
        next_low, next_high = Point3(x=next_x, y=next_y), Point3(x=next_x, y=next_y, z=WALL_M)
        yield from (low, next_low, next_high, low, next_high, high)


def areas(name: str, polygons: Sequence[Sequence[Place]]) -> Iterator[SceneEntity]:
    """Yield the areas of a terrain class, each with its name."""
    paint = color(GROUND)
    for number, corners in enumerate(polygons):
        at = np.mean(corners, axis=0)
        text = TextPrimitive(pose=pose(at), color=paint, text=name)
        text.billboard, text.scale_invariant, text.font_size = True, True, FONT_PX
        lines = [loop(corners, paint)]
        yield SceneEntity(frame_id=WORLD, id=f"ground/{name}/{number}", lines=lines, texts=[text])


def grid(given: Mapping[str, Any], time_ns: int) -> Grid:
    """Return a map with explicit colours, which panels display without configuration."""
    occupancy: NDArray[np.int8] = given["occupancy"]
    side_m = given["resolution_m"]
    names = ("red", "green", "blue", "alpha")
    kind = PackedElementField.UINT8
    cells = painted(occupancy)
    return Grid(
        timestamp=stamp(time_ns),
        frame_id=WORLD,
        pose=pose(given["corners_m"][0], half_turn=half_turn_of(given["corners_m"])),
        column_count=occupancy.shape[1],
        cell_size=Vector2(x=side_m, y=side_m),
        row_stride=cells.strides[0],
        cell_stride=cells.strides[1],
        fields=[
            PackedElementField(name=name, offset=offset, type=kind)
            for offset, name in enumerate(names)
        ],
        data=cells.tobytes(),
    )


def painted(occupancy: NDArray[np.int8]) -> NDArray[np.uint8]:
    """Return the colour of each cell, shape (rows, columns, 4)."""
    palette = np.array([FREE, UNKNOWN, OCCUPIED], np.uint8)
    cells: NDArray[np.uint8] = palette[states(occupancy)]
    return cells


def states(occupancy: NDArray[np.int8]) -> NDArray[np.uint8]:
    """Return the state of each cell, shape (rows, columns): 0 free, 1 unknown, 2 occupied."""
    each: NDArray[np.uint8] = (occupancy != 0).astype(np.uint8) + (occupancy == FULLY_OCCUPIED)
    return each


def half_turn_of(corners_m: Sequence[Place]) -> tuple[float, float]:
    """Return the sine and cosine of half the angle from x to the lower side of a map.

    It uses only square roots, which are the same on every machine.
    """
    (x, y), (end_x, end_y) = corners_m[:2]
    along, across = end_x - x, end_y - y
    length = np.sqrt(along * along + across * across)
    cosine = along / length
    half_sine = np.sqrt(max(0.0, (1 - cosine) / 2))
    half_cosine = np.sqrt(max(0.0, (1 + cosine) / 2))
    return float(np.copysign(half_sine, across)), float(half_cosine)
