"""The robots of a scene."""

from collections.abc import Sequence

import numpy as np
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from numpy.typing import NDArray

from agent_economy.recording.foxglove import WORLD, arrow, color, cylinder, stamp

BLUE, YELLOW, RED = "#3b7dd8", "#d8a03b", "#c0392b"
"""Colours of robots."""

AHEAD = "#eceff4"

Floats = NDArray[np.float64]


class Frames:
    """The frames of the robots: one message object, updated for each step."""

    def __init__(self, names: Sequence[str]) -> None:
        """Create the frames, which have the names of the robots."""
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
        """Return the frames at one time; the next call changes the returned object."""
        now = stamp(time_ns)
        rows = zip(self._parts, poses.tolist(), half_turns.tolist(), strict=True)
        for (when, place, turn), (x, y, _), (sine, cosine) in rows:
            when.CopyFrom(now)
            place.x, place.y = x, y
            turn.z, turn.w = sine, cosine
        return self._message


def robot(name: str, paint: str, radius_m: float, low_m: float = 0) -> SceneEntity:
    """Return the body of a robot in its frame, drawn from a height upwards."""
    high_m = low_m + radius_m
    body = cylinder((0, 0), radius_m, (low_m, high_m), color(paint, 0.9))
    ahead = arrow(1.5 * radius_m, high_m, color(AHEAD))
    return SceneEntity(frame_id=name, id=name, frame_locked=True, cylinders=[body], arrows=[ahead])
