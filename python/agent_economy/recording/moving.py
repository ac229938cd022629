"""What moves in a scene, or is found: robots and items."""

from collections.abc import Sequence

import numpy as np
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from numpy.typing import NDArray

from agent_economy.recording.messages import WORLD, arrow, color, cylinder, sphere, stamp

AIR_M = 1.5
"""How high a flying robot is drawn: the simulator has no heights."""

ITEM_M = 0.2
"""Radius with which an item is drawn: to the simulator it is a point."""

BODIES = {"active": "#3b7dd8", "empty": "#d8a03b", "broken": "#c0392b"}
"""Colours of robots, by status."""

AHEAD = "#eceff4"

FOUND, SOUGHT, CLUTTER = "#2e9e5b", "#8e44ad", "#8a8a8a"

Floats = NDArray[np.float64]


class Frames:
    """The robots' frames: the same message again and again, with other numbers in it."""

    def __init__(self, names: Sequence[str]) -> None:
        """Begin with the robots' names, which are those of their frames."""
        self._message = FrameTransforms(
            transforms=[
                FrameTransform(
                    parent_frame_id=WORLD,
                    child_frame_id=name,
                    translation=Vector3(),
                    rotation=Quaternion(),
                )
                for name in names
            ]
        )
        each = self._message.transforms
        self._parts = [(one.timestamp, one.translation, one.rotation) for one in each]

    def at(self, time_ns: int, poses: Floats, half_turns: Floats) -> FrameTransforms:
        """Return where the robots are; the next call changes what this one returned."""
        now = stamp(time_ns)
        rows = zip(self._parts, poses.tolist(), half_turns.tolist(), strict=True)
        for (when, place, turn), (x, y, _), (sine, cosine) in rows:
            when.CopyFrom(now)
            place.x, place.y = x, y
            turn.z, turn.w = sine, cosine
        return self._message


def robot(name: str, status: str, radius_m: float, *, is_flying: bool) -> SceneEntity:
    """Return a robot's body, which goes where its frame goes."""
    low_m = AIR_M if is_flying else 0.0
    high_m = low_m + radius_m
    body = cylinder((0, 0), radius_m, (low_m, high_m), color(BODIES[status], 0.9))
    ahead = arrow(1.5 * radius_m, high_m, color(AHEAD))
    return SceneEntity(frame_id=name, id=name, frame_locked=True, cylinders=[body], arrows=[ahead])


def item(name: str, at: tuple[float, float], *, is_found: bool, is_sought: bool) -> SceneEntity:
    """Return an item where it lies."""
    paint = FOUND if is_found else SOUGHT if is_sought else CLUTTER
    return SceneEntity(frame_id=WORLD, id=name, spheres=[sphere(at, ITEM_M, color(paint))])
