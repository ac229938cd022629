"""Items in a scene, where they lie, and what is found of them."""

from collections.abc import Iterator, Mapping
from itertools import count

import numpy as np
import pyarrow as pa
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from numpy.typing import NDArray

from agent_economy.recording.file import File
from agent_economy.recording.foxglove import WORLD, color, log, scene, sphere, stamp

ITEM_M = 0.2
"""Radius with which an item is drawn: to the simulator it is a point."""

FOUND_M = 0.22
"""Radius of one that is found, which hides the one below."""

TOGETHER = 1000
"""Items that lie there as one entity, which viewers draw at once."""

BASE = 32
"""How many times more finds a topic has than the one before, at most."""

FOUND, SOUGHT, CLUTTER = "#2e9e5b", "#8e44ad", "#8a8a8a"

Floats = NDArray[np.float64]


class Items:
    """Items where they lie, and those that are found laid over them.

    A viewer that jumps in time shows the last message of each topic, so each must be whole; and all
    items anew at each find would be finds times items. So all are written once, as not found. The
    finds follow on topics that are whole, as the digits of a number are: of 2,220 finds the last 12
    are on topic 0, the 5 x 32 before these on 1, and the first 2 x 32 x 32 on 2. A topic is written
    anew when its digit changes: each find some 16 times on each.

    Each find is told in the log, once: also one of before the recording, or one that a change of
    the scenario made.
    """

    def __init__(
        self, file: File, items: pa.Table, target: Mapping[str, bool], told: set[str]
    ) -> None:
        """Begin with all items.

        Args:
            file: Where they are written.
            items: Each with its `kind`, `x_m` and `y_m`.
            target: Of each kind, whether it is.
            told: Names of those whose finds are in the log; those that follow are put there.
        """
        kinds = items["kind"].combine_chunks().dictionary_encode()
        self._kinds: list[str] = kinds.dictionary.to_pylist()
        self._kind_of = kinds.indices.to_numpy()
        self._number = np.zeros(len(items), np.int64)
        for kind in range(len(self._kinds)):
            places = np.flatnonzero(self._kind_of == kind)
            self._number[places] = np.arange(len(places))
        self._at = np.column_stack([items["x_m"].to_numpy(), items["y_m"].to_numpy()])
        self._file, self._target, self._told = file, target, told
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
        self._told.intersection_update(map(self.name, self._order))
        for level in count():
            if BASE**level > len(self._order) and not self._file.has(topic_of(level)):
                break
            self._write_level(level, time_ns)
        self._tell(self._order, found_s, time_ns)

    def write_finds(self, found_s: Floats, time_ns: int) -> None:
        """Write which items are found by now, as far as that has changed."""
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
        self._tell(new, found_s, time_ns)

    def _lying(self, time_ns: int) -> Iterator[SceneUpdate]:
        """Yield all items as if none were found, in parts."""
        now = stamp(time_ns)
        yield scene([], time_ns)
        for kind, name in enumerate(self._kinds):
            paint = color(SOUGHT if self._target[name] else CLUTTER)
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

    def _tell(self, places: list[int], found_s: Floats, time_ns: int) -> None:
        """Tell in the log what is found."""
        for place in places:
            name = self.name(place)
            if name not in self._told:
                words = f"found at {found_s[place]:.3f} s"
                self._file.write("/log", log(time_ns, Log.INFO, name, words), time_ns)
                self._told.add(name)

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
