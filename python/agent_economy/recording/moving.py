"""What moves in a scene, or is found: robots and items."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import count

import numpy as np
import pyarrow as pa
from foxglove_schemas_protobuf.FrameTransform_pb2 import FrameTransform
from foxglove_schemas_protobuf.FrameTransforms_pb2 import FrameTransforms
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from numpy.typing import NDArray

from agent_economy.recording.file import File
from agent_economy.recording.messages import (
    WORLD,
    arrow,
    color,
    cylinder,
    scene,
    sphere,
    stamp,
)

AIR_M = 1.5
"""How high a flying robot is drawn: the simulator has no heights."""

ITEM_M = 0.2
"""Radius with which an item is drawn: to the simulator it is a point."""

FOUND_M = 0.22
"""Radius of one that is found, which hides the one below."""

TOGETHER = 1000
"""Items that lie there as one entity, which viewers draw at once."""

BASE = 32
"""How many times more finds a topic has than the one before, at most."""

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


class Items:
    """Items where they lie, and those that are found laid over them.

    A viewer that jumps in time shows the last message of each topic, so each must be whole; and all
    items anew at each find would be finds times items. So all are written once, as not found. The
    finds follow on topics that are whole, as the digits of a number are: of 2,220 finds the last 12
    are on topic 0, the 5 x 32 before these on 1, and the first 2 x 32 x 32 on 2. A topic is written
    anew when its digit changes: each find some 16 times on each.
    """

    def __init__(self, file: File, items: pa.Table, sought: Mapping[str, bool]) -> None:
        """Begin with all items; of each kind, whether it is sought."""
        kinds = items["kind"].combine_chunks().dictionary_encode()
        self._kinds: list[str] = kinds.dictionary.to_pylist()
        self._kind_of = kinds.indices.to_numpy()
        self._number = np.zeros(len(items), np.int64)
        for kind in range(len(self._kinds)):
            places = np.flatnonzero(self._kind_of == kind)
            self._number[places] = np.arange(len(places))
        self._at = np.column_stack([items["x_m"].to_numpy(), items["y_m"].to_numpy()])
        self._file, self._sought = file, sought
        self._found = np.zeros(len(items), np.bool_)
        self._order: list[int] = []

    def name(self, place: int) -> str:
        """Return the name of an item, KIND/INDEX."""
        return f"{self._kinds[self._kind_of[place]]}/{self._number[place]}"

    def write_all(self, found_s: Floats, time_ns: int) -> None:
        """Write all items, and those that are found by now."""
        self._file.write_parts("/scene/items", SceneUpdate, self._lying(time_ns), time_ns)
        self._found = np.isfinite(found_s)
        places = np.flatnonzero(self._found)
        self._order = places[np.argsort(found_s[places], kind="stable")].tolist()
        for level in count():
            if BASE**level > len(self._order) and not self._file.has(topic_of(level)):
                return
            self._write_level(level, time_ns)

    def write_finds(self, found_s: Floats, time_ns: int) -> None:
        """Write which items are found by now, as far as that has changed."""
        found = np.isfinite(found_s)
        if (self._found & ~found).any():
            self.write_all(found_s, time_ns)
            return
        before = len(self._order)
        self._order += np.flatnonzero(found & ~self._found).tolist()
        self._found = found
        for level in count():
            if before // BASE**level == len(self._order) // BASE**level:
                return
            self._write_level(level, time_ns)

    def _lying(self, time_ns: int) -> Iterator[SceneUpdate]:
        """Yield all items as if none were found, in parts."""
        now = stamp(time_ns)
        yield scene([], time_ns)
        for kind, name in enumerate(self._kinds):
            paint = color(SOUGHT if self._sought[name] else CLUTTER)
            places = self._at[self._kind_of == kind]
            for first in range(0, len(places), TOGETHER):
                several = places[first : first + TOGETHER].tolist()
                entity = SceneEntity(
                    timestamp=now,
                    frame_id=WORLD,
                    id=f"{name}/{first}-{first + len(several) - 1}",
                    spheres=[sphere(at, ITEM_M, paint) for at in several],
                )
                yield SceneUpdate(entities=[entity])

    def _write_level(self, level: int, time_ns: int) -> None:
        size, finds = BASE**level, len(self._order)
        first, end = finds // (size * BASE) * (size * BASE), finds // size * size
        paint = color(FOUND)
        entities = [
            SceneEntity(
                frame_id=WORLD,
                id=self.name(place),
                spheres=[sphere(self._at[place].tolist(), FOUND_M, paint)],
            )
            for place in self._order[first:end]
        ]
        self._file.write(topic_of(level), scene(entities, time_ns), time_ns)


def topic_of(level: int) -> str:
    """Return where finds are written."""
    return f"/scene/found/{level}"
