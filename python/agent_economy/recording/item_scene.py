"""The items of a scene, and the finds."""

from collections.abc import Iterator, Mapping
from itertools import count

import numpy as np
import pyarrow as pa
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from numpy.typing import NDArray

from agent_economy import arrow
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import WORLD, color, log, scene, sphere, stamp

ITEM_M = 0.2
"""Drawn radius of an item, which is a point in the simulator."""

FOUND_M = 0.22
"""Drawn radius of a found item, which hides the one below."""

ITEMS_PER_ENTITY = 1000
"""Items per entity; viewers draw the items of an entity together."""

BASE = 32
"""Base of the digits; see `Items`."""

FOUND, TARGET, CLUTTER = "#2e9e5b", "#8e44ad", "#8a8a8a"

Floats = NDArray[np.float64]


class Items:
    """Draws all items, with the found ones on top.

    A viewer that jumps in time displays the last message of each topic, so each message must be
    complete. Writing all items at each find would take finds x items. Therefore, the items are
    written once, as not found, and the finds are distributed over topics like the digits of their
    number to the base 32. Of 2,220 finds, the last 12 are on topic 0, the 5 x 32 before these on
    topic 1, and the first 2 x 32 x 32 on topic 2. A topic is written again when its digit changes,
    which writes each find about 16 times per topic.

    The log contains each find once, including those before the recording or by a change of the
    scenario.
    """

    def __init__(
        self, file: File, items: pa.Table, target: Mapping[str, bool], logged: set[str]
    ) -> None:
        """Prepare the items of a run; nothing is written yet.

        Args:
            file: The file.
            items: `kind`, `x_m` and `y_m` of each item.
            target: Whether each kind is a target.
            logged: Names of items whose finds are in the log; it is kept up to date.
        """
        kinds = items["kind"].combine_chunks().dictionary_encode()
        self._kinds: list[str] = kinds.dictionary.to_pylist()
        self._kind_of = arrow.numbers(kinds.indices)
        self._number = np.zeros(len(items), np.int64)
        for kind in range(len(self._kinds)):
            indices = np.flatnonzero(self._kind_of == kind)
            self._number[indices] = np.arange(len(indices))
        self._at = np.column_stack([arrow.numbers(items[name]) for name in ("x_m", "y_m")])
        self._file, self._target, self._logged = file, target, logged
        self._found = np.zeros(len(items), np.bool_)
        self._order: list[int] = []

    def name(self, item: int) -> str:
        """Return the name of an item, KIND/INDEX."""
        return f"{self._kinds[self._kind_of[item]]}/{self._number[item]}"

    def write_all(self, found_s: Floats, time_ns: int) -> None:
        """Write all items, and all finds."""
        self._file.write_parts("/scene/items", SceneUpdate, self._not_found(time_ns), time_ns)
        self._found = np.isfinite(found_s)
        found = np.flatnonzero(self._found)
        self._order = found[np.argsort(found_s[found], kind="stable")].tolist()
        self._logged.intersection_update(map(self.name, self._order))
        for level in count():
            if BASE**level > len(self._order) and not self._file.has(topic_of(level)):
                break
            self._write_level(level, time_ns)
        self._log(self._order, found_s, time_ns)

    def write_finds(self, found_s: Floats, time_ns: int) -> None:
        """Write the finds since the last call, and log those that are not in the log."""
        found = np.isfinite(found_s)
        if (self._found & ~found).any():
            self.write_all(found_s, time_ns)
            return
        before, new = len(self._order), np.flatnonzero(found & ~self._found).tolist()
        self._order += new
        self._found = found
        for level in count():
            if before // BASE**level == len(self._order) // BASE**level:
                break
            self._write_level(level, time_ns)
        self._log(new, found_s, time_ns)

    def log_find(self, name: str, found_s: float, time_ns: int) -> None:
        """Write the find of an item to the log, unless it is already in it."""
        if name not in self._logged:
            message = f"found at {found_s:.3f} s"
            self._file.write("/log", log(time_ns, Log.INFO, name, message), time_ns)
            self._logged.add(name)

    def _not_found(self, time_ns: int) -> Iterator[SceneUpdate]:
        """Yield all items in parts, as if none had been found."""
        now = stamp(time_ns)
        yield scene([], time_ns)
        for kind, name in enumerate(self._kinds):
            paint = color(TARGET if self._target[name] else CLUTTER)
            positions = self._at[self._kind_of == kind]
            for first in range(0, len(positions), ITEMS_PER_ENTITY):
                several = positions[first : first + ITEMS_PER_ENTITY].tolist()
                entity = SceneEntity(
                    timestamp=now,
                    frame_id=WORLD,
                    id=f"{name}/{first}-{first + len(several) - 1}",
                    spheres=[sphere(at, ITEM_M, paint) for at in several],
                )
                yield SceneUpdate(entities=[entity])

    def _log(self, items: list[int], found_s: Floats, time_ns: int) -> None:
        """Write the finds to the log, except those already in it."""
        for item in items:
            self.log_find(self.name(item), found_s[item], time_ns)

    def _write_level(self, level: int, time_ns: int) -> None:
        size, finds = BASE**level, len(self._order)
        first, end = finds // (size * BASE) * (size * BASE), finds // size * size
        paint = color(FOUND)
        entities = [
            SceneEntity(
                frame_id=WORLD,
                id=self.name(item),
                spheres=[sphere(self._at[item].tolist(), FOUND_M, paint)],
            )
            for item in self._order[first:end]
        ]
        self._file.write(topic_of(level), scene(entities, time_ns), time_ns)


def topic_of(level: int) -> str:
    """Return the topic of a digit of the finds."""
    return f"/scene/found/{level}"
