"""Messages with Foxglove's schemas, which its panels display without configuration.

Positions are in metres and angles in radians, in the frame "world": x to the right, y up, z towards
the viewer. Each robot has its own frame, under its name: x to the front, y to the left.

Source: the schemas of Foxglove (docs.foxglove.dev, "Message schemas").
"""

from collections.abc import Sequence

from foxglove_schemas_protobuf.ArrowPrimitive_pb2 import ArrowPrimitive
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.CubePrimitive_pb2 import CubePrimitive
from foxglove_schemas_protobuf.CylinderPrimitive_pb2 import CylinderPrimitive
from foxglove_schemas_protobuf.LaserScan_pb2 import LaserScan
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneEntityDeletion_pb2 import SceneEntityDeletion
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.SpherePrimitive_pb2 import SpherePrimitive
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3
from google.protobuf.timestamp_pb2 import Timestamp

WORLD = "world"
"""Name of the world frame."""

SECOND_NS = 1_000_000_000

Place = Sequence[float]
"""x and y, in metres."""

LINE_PX = 2.0


def stamp(time_ns: int) -> Timestamp:
    """Convert a time to a message."""
    return Timestamp(seconds=time_ns // SECOND_NS, nanos=time_ns % SECOND_NS)


def color(text: str, alpha: float = 1.0) -> Color:
    """Convert a colour from #rrggbb."""
    red, green, blue = bytes.fromhex(text.removeprefix("#"))
    return Color(r=red / 255, g=green / 255, b=blue / 255, a=alpha)


def pose(at: Place = (0, 0), z_m: float = 0, half_turn: tuple[float, float] = (0, 1)) -> Pose:
    """Return a pose; `half_turn` is the sine and cosine of half its heading."""
    return Pose(
        position=Vector3(x=at[0], y=at[1], z=z_m),
        orientation=Quaternion(z=half_turn[0], w=half_turn[1]),
    )


def loop(corners: Sequence[Place], paint: Color) -> LinePrimitive:
    """Return a closed line with a constant width on the screen."""
    return LinePrimitive(
        type=LinePrimitive.LINE_LOOP,
        pose=pose(),
        thickness=LINE_PX,
        scale_invariant=True,
        points=[Point3(x=x, y=y) for x, y in corners],
        color=paint,
    )


def cylinder(
    at: Place, radius_m: float, heights_m: tuple[float, float], paint: Color
) -> CylinderPrimitive:
    """Return an upright cylinder between two heights."""
    low_m, high_m = heights_m
    return CylinderPrimitive(
        pose=pose(at, (low_m + high_m) / 2),
        size=Vector3(x=2 * radius_m, y=2 * radius_m, z=high_m - low_m),
        bottom_scale=1,
        top_scale=1,
        color=paint,
    )


def cube(at: Place, size_m: tuple[float, float, float], paint: Color) -> CubePrimitive:
    """Return a block on the ground."""
    x_m, y_m, z_m = size_m
    return CubePrimitive(pose=pose(at, z_m / 2), size=Vector3(x=x_m, y=y_m, z=z_m), color=paint)


def sphere(at: Place, radius_m: float, paint: Color) -> SpherePrimitive:
    """Return a sphere on the ground."""
    side = 2 * radius_m
    return SpherePrimitive(
        pose=pose(at, radius_m), size=Vector3(x=side, y=side, z=side), color=paint
    )


def arrow(length_m: float, z_m: float, paint: Color) -> ArrowPrimitive:
    """Return an arrow from the centre to the front."""
    return ArrowPrimitive(
        pose=pose(z_m=z_m),
        shaft_length=0.6 * length_m,
        shaft_diameter=0.2 * length_m,
        head_length=0.4 * length_m,
        head_diameter=0.5 * length_m,
        color=paint,
    )


def scene(entities: Sequence[SceneEntity], time_ns: int) -> SceneUpdate:
    """Return a scene that replaces all earlier ones on its topic."""
    begin = stamp(time_ns)
    for entity in entities:
        entity.timestamp.CopyFrom(begin)
    return SceneUpdate(
        deletions=[SceneEntityDeletion(timestamp=begin, type=SceneEntityDeletion.ALL)],
        entities=entities,
    )


def scan(frame: str, time_ns: int, bearings_rad: Sequence[float], ranges: list[float]) -> LaserScan:
    """Return the scan of a range ring; the range of a ray without a return is infinite."""
    return LaserScan(
        timestamp=stamp(time_ns),
        frame_id=frame,
        pose=pose(),
        start_angle=bearings_rad[0],
        end_angle=bearings_rad[-1],
        ranges=ranges,
    )


def log(time_ns: int, level: Log.Level.ValueType, name: str, message: str) -> Log:
    """Return an entry of the log."""
    return Log(timestamp=stamp(time_ns), level=level, name=name, message=message)
