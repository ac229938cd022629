"""The topics of a mined lane: its remaining risk, the marks, and a map of each controller."""

from typing import Any

import numpy as np
from foxglove_schemas_protobuf.Grid_pb2 import Grid
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.Vector2_pb2 import Vector2
from numpy.typing import NDArray

from agent_economy.recording import schemas
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import WORLD, pose, stamp
from agent_economy.recording.passage_topics import PassageTopics
from agent_economy.runs.lane import BelievedLane
from agent_economy.runs.simulation import Simulation

RISK, MARKS, MAP = "/lane", "/lane/marks", "/lane/map"

MAP_S = 5.0
"""Simulated time between two maps, and two lists of marks; a statement is always with both."""

PALETTE = np.array(
    [(255, 247, 188), (254, 196, 79), (236, 112, 20), (153, 52, 4), (60, 20, 4)], np.float64
)
"""Colours at equal distances of the logarithm of the expected mines, from pale to dark: their order
is visible to colour-blind people, too. The first is of cells that are cleared, the last of 1,000
times as many mines and more."""

DECADES = 3

CELL = np.dtype([("rgba", np.uint8, 4), ("expected_mines", "<f4")])

OF_RISK = ("unmarked", "marked", "probability")
OF_STATEMENT = ("is_clear", "risk", "at_s")
OF_SHARE = ("kind", "share", "low", "high")
OF_MARKS = ("number", "deviation_m", "mine", "verdict", "failed_charges")


class LaneTopics:
    """Writes what each controller believes of a mined lane, if there is one."""

    def __init__(self, file: File, simulation: Simulation) -> None:
        """Declare the topics."""
        self._file, self._simulation = file, simulation
        self._is_on = bool(simulation.lanes)
        self._statements = 0
        self._due_s = -np.inf
        if self._is_on:
            file.declare(RISK, schemas.LANE)
            file.declare(MARKS, schemas.LANE_MARKS)
            self._passage = PassageTopics(file, simulation)

    def write(self, time_ns: int) -> None:
        """Write the current step; the marks and maps only when they are due."""
        if not self._is_on:
            return
        lanes = self._simulation.lanes
        risk = {"mines_left": self._simulation.mines_left, "controllers": risks(lanes)}
        self._file.write_json(RISK, risk, time_ns)
        self._passage.write(lanes, time_ns)
        statements = sum(lane.statement is not None for lane in lanes)
        if self._simulation.time_s < self._due_s and statements == self._statements:
            return
        self._statements, self._due_s = statements, self._simulation.time_s + MAP_S
        self._file.write_json(MARKS, {"marks": marks(lanes)}, time_ns)
        for lane in lanes:
            self._file.write(f"{MAP}/{lane.controller}", grid(lane, time_ns), time_ns)


def risks(lanes: list[BelievedLane]) -> dict[str, list[Any]]:
    """Return the remaining risk and the statement of each controller, as lists."""
    return {
        "name": [lane.controller for lane in lanes],
        **{key: [getattr(lane.risk, key) for lane in lanes] for key in OF_RISK},
        **{
            f"statement_{key}": [
                None if lane.statement is None else getattr(lane.statement, key) for lane in lanes
            ]
            for key in OF_STATEMENT
        },
        "clearance": [
            [{key: getattr(share, key) for key in OF_SHARE} for share in lane.clearance]
            for lane in lanes
        ],
    }


def marks(lanes: list[BelievedLane]) -> dict[str, list[Any]]:
    """Return the marks of all controllers, as lists."""
    owned = [(lane.controller, mark) for lane in lanes for mark in lane.marks]
    return {
        "controller": [controller for controller, _ in owned],
        "x_m": [mark.at_m[0] for _, mark in owned],
        "y_m": [mark.at_m[1] for _, mark in owned],
        **{key: [getattr(mark, key) for _, mark in owned] for key in OF_MARKS},
    }


def grid(lane: BelievedLane, time_ns: int) -> Grid:
    """Return the expected mines of each cell, also as colours."""
    rows, columns = lane.expected.shape
    cells = np.zeros((rows, columns), CELL)
    cells["rgba"] = painted(lane)
    cells["expected_mines"] = lane.expected
    uint8 = PackedElementField.UINT8
    colours = [
        PackedElementField(name=name, offset=offset, type=uint8)
        for offset, name in enumerate(("red", "green", "blue", "alpha"))
    ]
    number = PackedElementField(name="expected_mines", offset=4, type=PackedElementField.FLOAT32)
    return Grid(
        timestamp=stamp(time_ns),
        frame_id=WORLD,
        pose=pose(lane.corners_m[0]),
        column_count=columns,
        cell_size=Vector2(x=lane.cell_m, y=lane.cell_m),
        row_stride=columns * CELL.itemsize,
        cell_stride=CELL.itemsize,
        fields=[*colours, number],
        data=cells.tobytes(),
    )


def painted(lane: BelievedLane) -> NDArray[np.uint8]:
    """Return the colour of each cell by its density of mines, shape (rows, columns, 4)."""
    ratio = lane.expected / lane.area_m2 / lane.cleared_below_per_m2
    share = np.log10(np.maximum(ratio, 1.0)) / DECADES
    stops = np.linspace(0, 1, len(PALETTE))
    channels = [np.interp(share, stops, PALETTE[:, channel]) for channel in range(3)]
    opaque = np.full(share.shape, 255.0)
    colours: NDArray[np.uint8] = np.stack([*channels, opaque], axis=-1).round().astype(np.uint8)
    return colours
