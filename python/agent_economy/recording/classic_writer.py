"""Recordings of the classic engine: a cell is drawn one metre wide, with y upwards."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity

from agent_economy import arrow
from agent_economy.recording import schemas
from agent_economy.recording.clock import Clock
from agent_economy.recording.fields import hash_text
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import WORLD as FRAME
from agent_economy.recording.foxglove import color, cube, scene
from agent_economy.recording.inputs import ExternalInputs
from agent_economy.recording.item_scene import Floats, Items
from agent_economy.recording.logged import Logged
from agent_economy.recording.robot_scene import BLUE, RED, YELLOW, Frames, robot
from agent_economy.recording.selection import Selection
from agent_economy.recording.static_scene import OBSTACLE, WALL_M, half_turn_of
from agent_economy.runs.brain import Command
from agent_economy.runs.classic_simulation import COLOURS, ClassicSimulation
from agent_economy.runs.classic_world import CELL_PX, CELLS, RADIUS, WORLD, centre
from agent_economy.scenario import validation

TOPICS = {
    "/run": schemas.CLASSIC_RUN,
    "/team": schemas.TEAM,
    "/robots": schemas.CLASSIC_ROBOTS,
    "/outcome": schemas.OUTCOME,
}

PAINTS = (BLUE, YELLOW, RED)
"""Colours of robots, by their number in the compiled part."""

AHEAD = ((0, 1), (1, 1), (1, 0), (1, -1), (0, -1), (-1, -1), (-1, 0), (-1, 1))
"""Direction (right, up) by heading: eighths of a turn clockwise from up."""

HALF_TURNS = np.array([half_turn_of([(0, 0), ahead]) for ahead in AHEAD])
"""Sine and cosine of half the angle from x, by heading."""

EIGHTH_DEG, LEFT_DEG = 45, 270

UNCHANGED = ("column", "row", "speed", "left_turns", "right_turns")

NO_BRAINS = "none: robots of the classic engine have no percepts or commands"


class ClassicMoments:
    """The steps of a run until its scenario changes: see `engines.Moments`."""

    decision_hash = None

    def __init__(
        self,
        file: File,
        simulation: ClassicSimulation,
        _: Selection,
        logged: Logged,
        clock: Clock,
    ) -> None:
        """Write the static topics and the first step; see `engines.Engine`."""
        time_ns = clock.time_ns(simulation.tick)
        for topic, schema in TOPICS.items():
            file.declare(topic, schema)
        self._file, self._simulation, self._clock = file, simulation, clock
        self._changes = len(simulation.changes)
        self._names = simulation.robots
        self._frames = Frames(self._names)
        self._items = Items(file, items(), {"item": True}, logged.finds)
        self._colours: list[int] = []
        robots = len(self._names)
        bodies = {"radius_m": [RADIUS] * robots, "is_flying": [False] * robots}
        file.write_json("/team", {"robots": self._names, **bodies}, time_ns)
        file.write("/scene/world", scene([walls()], time_ns), time_ns)
        self._items.write_all(found_s(simulation), time_ns)
        self.write()

    def step(self, steps: int, inputs: ExternalInputs) -> dict[str, Command]:
        """Advance as `ClassicSimulation.step` does.

        Raises:
            InputError: If there are percepts or commands.
        """
        for name, each in inputs._asdict().items():
            validation.check(each is None, name, each, NO_BRAINS)
        self._simulation.step(steps)
        return {}

    def log_events(self) -> None:
        """Do nothing: the only events of the engine are finds, which `write` logs."""

    def close(self) -> None:
        """Do nothing: no events are collected."""

    def write(self) -> None:
        """Write the current step."""
        simulation = self._simulation
        time_ns = self._clock.time_ns(simulation.tick)
        robots = simulation._run.robots  # noqa: SLF001  (ours)
        found = found_s(simulation)
        self.tick, self.hash = simulation.tick, simulation.hash
        self._file.write("/tf", self._frames.at(time_ns, *placed(robots)), time_ns)
        self._file.write_json("/robots", states(robots), time_ns)
        run = {
            "tick": self.tick,
            "hash": hash_text(self.hash),
            "changes": self._changes,
            "found": int(np.isfinite(found).sum()),
            "carry": simulation.carry,
            "decides_in": simulation.decides_in,
        }
        self._file.write_json("/run", run, time_ns)
        if robots["colour"] != self._colours:
            self._colours = robots["colour"]
            paints = zip(self._names, self._colours, strict=True)
            bodies = [robot(name, PAINTS[colour], RADIUS) for name, colour in paints]
            self._file.write("/scene/robots", scene(bodies, time_ns), time_ns)
        self._items.write_finds(found, time_ns)


def errors(_: ClassicSimulation, percepts: Sequence[str]) -> list[str]:
    """Return the errors of the names of robots whose percepts are to be recorded."""
    return validation.errors_unless(not percepts, "percepts", list(percepts), NO_BRAINS)


def walls() -> SceneEntity:
    """Return the walls; items, which also block robots, are written separately."""
    size_m = (1.0, 1.0, WALL_M)
    cubes = [cube(centre(cell), size_m, color(OBSTACLE)) for cell in WORLD["walls"]]
    return SceneEntity(frame_id=FRAME, id="walls", cubes=cubes)


def items() -> pa.Table:
    """Return the items in the format of the metric engine."""
    x_m, y_m = np.array([centre(cell) for cell in WORLD["items"]]).T
    return arrow.table({"kind": ["item"] * len(x_m), "x_m": x_m, "y_m": y_m})


def found_s(simulation: ClassicSimulation) -> Floats:
    """Return the time at which each item was found; NaN if it has not been."""
    found = simulation._run.found_s  # noqa: SLF001  (ours)
    return np.array(found, np.float64)  # None becomes NaN


def placed(robots: Mapping[str, list[float]]) -> tuple[Floats, Floats]:
    """Return the poses, shape (robots, 3), and the sine and cosine of half their headings."""
    half_turns = HALF_TURNS[np.array(robots["heading_deg"]) // EIGHTH_DEG % len(AHEAD)]
    columns = states(robots)
    return np.column_stack([columns[name] for name in ("x_m", "y_m", "heading_rad")]), half_turns


def states(robots: Mapping[str, list[Any]]) -> dict[str, list[Any]]:
    """Return the state of each robot, as lists."""
    return {
        "x_m": [x_px / CELL_PX for x_px in robots["x_px"]],
        "y_m": [CELLS - y_px / CELL_PX for y_px in robots["y_px"]],
        "heading_rad": [heading_rad(degrees) for degrees in robots["heading_deg"]],
        **{name: robots[name] for name in UNCHANGED},
        "colour": COLOURS[robots["colour"]].tolist(),
    }


def heading_rad(degrees: float) -> float:
    """Convert a heading from degrees clockwise from up to radians anticlockwise from x."""
    return math.radians(90 - degrees if degrees < LEFT_DEG else 450 - degrees)
