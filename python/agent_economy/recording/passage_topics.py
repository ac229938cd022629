"""The topics of vehicles that pass a mined lane: the stated path, and where the vehicles are."""

from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate

from agent_economy.recording import schemas
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import WORLD, color, cylinder, pose, scene
from agent_economy.runs.lane import BelievedLane
from agent_economy.runs.passage import Passage, Vehicle
from agent_economy.runs.simulation import Simulation

PASSAGE, PATH, VEHICLES = "/lane/passage", "/lane/path", "/lane/vehicles"

PAINT = "#2b6cb0"
PAINTS = {"driving": "#2b6cb0", "passed": "#2f855a", "lost": "#c53030"}

PATH_ALPHA = 0.35

VEHICLE_M = 2.0
"""Drawn height of a vehicle; the simulator has no heights."""


class PassageTopics:
    """Writes the path of each controller once, and the vehicles in each step."""

    def __init__(self, file: File, simulation: Simulation) -> None:
        """Begin without a path."""
        self._file, self._simulation = file, simulation
        self._written: dict[str, Passage] = {}
        self._drawn: list[Vehicle] = []

    def write(self, lanes: list[BelievedLane], time_ns: int) -> None:
        """Write what is new in the current step."""
        for lane in lanes:
            passage = lane.passage
            if passage is not None and self._written.get(lane.controller) != passage:
                self._written[lane.controller] = passage
                self._file.declare(PASSAGE, schemas.LANE_PASSAGE)
                message = {"controller": lane.controller, **passage._asdict()}
                self._file.write_json(PASSAGE, message, time_ns)
                self._file.write(f"{PATH}/{lane.controller}", path_scene(passage, time_ns), time_ns)
        vehicles = self._simulation.vehicles
        if vehicles and vehicles != self._drawn and self._written:
            self._drawn = vehicles
            width_m = next(iter(self._written.values())).width_m
            self._file.write(VEHICLES, vehicle_scene(vehicles, width_m, time_ns), time_ns)


def path_scene(passage: Passage, time_ns: int) -> SceneUpdate:
    """Return the path as a line of its width."""
    line = LinePrimitive(
        type=LinePrimitive.LINE_STRIP,
        pose=pose(),
        thickness=passage.width_m,
        points=[Point3(x=x, y=y) for x, y in passage.path_m],
        color=color(PAINT, PATH_ALPHA),
    )
    return scene([SceneEntity(frame_id=WORLD, id="path", lines=[line])], time_ns)


def vehicle_scene(vehicles: list[Vehicle], width_m: float, time_ns: int) -> SceneUpdate:
    """Return the vehicles that have entered the lane, as discs that are as wide as the path."""
    entities = [
        SceneEntity(
            frame_id=WORLD,
            id=vehicle.name,
            cylinders=[
                cylinder(vehicle.at_m, width_m / 2, (0.0, VEHICLE_M), color(PAINTS[vehicle.status]))
            ],
        )
        for vehicle in vehicles
        if vehicle.has_entered
    ]
    return scene(entities, time_ns)
