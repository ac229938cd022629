"""Waypoints that operators order: where they are, and whether their robot can go there."""

from collections.abc import Callable, Iterator
from functools import partial
from math import isfinite

from agent_economy._core import LocalFrame
from agent_economy.live.clock import now_s
from agent_economy.live.frame import frame_of, position_m
from agent_economy.live.legs import Walls, exit_of, is_within
from agent_economy.live.plan import FleetPlan, Point, RobotPlan
from agent_economy.live.readings import Quantity
from agent_economy.live.warden import effects
from agent_economy.live.warden.mission import COMPLETE, IMPOSSIBLE
from agent_economy.live.warden.request_body import Body, number
from agent_economy.live.warden.robot import Robot
from agent_economy.live.warden.warden import Warden

MINUTES_PER_DEG = 60.0
MAX_WAYPOINTS = 1000
"""Waypoints of one robot, complete ones included."""

KEYS = ("robot", "point_m", "latitude", "longitude")


class WaypointOrders:
    """Takes orders of waypoints, with the way to each of them."""

    def __init__(self, warden: Warden, plan: FleetPlan) -> None:
        """Create it for a drive."""
        self._warden, self._plan, self._frame = warden, plan, frame_of(plan.origin)
        self._walls = Walls(plan.walls or ())
        self._sent: dict[str, list[Point]] = {robot.name: [] for robot in plan.robots}

    def take(self, robot: RobotPlan, body: Body) -> str:
        """Order a waypoint; return what the order does, in words.

        Raises:
            ValueError: If the robot takes no orders, or cannot go there.
        """
        if not robot.takes_orders:
            message = f"the brain of {robot.name} takes no orders: it has no behaviour correct"
            raise ValueError(message)
        point = _point(body, self._frame)
        self._check_place(robot, point)
        self._check_count(robot.name)
        notes = list(self._check_way(robot, point))
        self._warden.order(robot.name, point)
        self._sent[robot.name].append(point)
        waiting = ", ".join(effects.waiting(self._warden, robot.name))
        notes += [f"queued: {waiting}"] if waiting else []
        return "; ".join([f"{robot.name}: waypoint {_shown(point)} ordered", *notes])

    def _check_place(self, robot: RobotPlan, point: Point) -> None:
        size_m = self._plan.size_m
        if size_m and not (0 <= point[0] <= size_m[0] and 0 <= point[1] <= size_m[1]):
            message = f"the waypoint is outside the world, [0, 0] to [{size_m[0]:g}, {size_m[1]:g}]"
            raise ValueError(message)
        if robot.fence_m is not None and not is_within(point, robot.fence_m):
            message = f"the waypoint is outside the fence of {robot.name}"
            raise ValueError(message)
        near = None if robot.radius_m is None else self._walls.near(point, robot.radius_m)
        if near is not None:
            wall, distance_m = near
            where = f"{distance_m:.2g} m from" if distance_m else "inside"
            message = (
                f"the waypoint is {where} the obstacle {wall.name}: at least {robot.radius_m:g} m, "
                f"the radius of {robot.name}, are needed"
            )
            raise ValueError(message)

    def _check_count(self, name: str) -> None:
        known = self._warden.goals.get(name, {})
        places = [tuple(goal["at_m"]) for goal in known.values()]
        # What the loop has reported since is a goal like the others.
        self._sent[name] = [point for point in self._sent[name] if point not in places]
        if len(known) + len(self._sent[name]) >= MAX_WAYPOINTS:
            message = f"{name} has {MAX_WAYPOINTS} waypoints already"
            raise ValueError(message)

    def _check_way(self, robot: RobotPlan, point: Point) -> Iterator[str]:
        """Yield what is to be known of the straight way to a waypoint.

        Raises:
            ValueError: If it leaves the fence.
        """
        if self._plan.walls is None:
            yield "it was not compared with the obstacles: the world has too many"
        start_m = self._start_m(robot.name)
        if start_m is None:
            yield f"only the waypoint was checked: the position of {robot.name} is not known"
            return
        if robot.fence_m is not None and not is_within(start_m, robot.fence_m):
            yield f"its way was not compared with the fence: {robot.name} is outside of it"
        elif robot.fence_m is not None:
            left_m = exit_of((start_m, point), robot.fence_m)
            if left_m is not None:
                leg = f"the leg from {_shown(start_m)} to {_shown(point)}"
                message = f"{leg} leaves the fence of {robot.name} at {_shown(left_m)}"
                raise ValueError(message)
        yield from self._obstacles(robot, start_m, point)

    def _obstacles(self, robot: RobotPlan, start_m: Point, point: Point) -> Iterator[str]:
        leg, radius_m = (start_m, point), robot.radius_m
        crossed = None if radius_m is None else self._walls.crossed(leg, radius_m)
        if crossed is not None:
            yield (
                f"the straight way crosses the obstacle {crossed[0].name}: the robot has to find a "
                "way around"
            )

    def _start_m(self, name: str) -> Point | None:
        """Return where a robot will be: at its last waypoint, or where it is; None if unknown."""
        if self._sent[name]:
            return self._sent[name][-1]
        for goal in reversed(self._warden.goals.get(name, {}).values()):
            if goal["verdict"] not in (COMPLETE, IMPOSSIBLE):
                x_m, y_m = goal["at_m"]
                return float(x_m), float(y_m)
        robot = self._warden.robots.get(name)
        return None if robot is None else _newest_m(robot)


def _newest_m(robot: Robot) -> Point | None:
    """Return the newest position of a robot; None if it has none that is fresh."""
    for plan in robot.plan.inputs:
        if plan.quantity is Quantity.POSITION and plan.port in robot.readings:
            reading, at_s = robot.readings[plan.port]
            is_fresh = now_s() - at_s <= plan.max_age_s
            x_m, y_m = reading.values
            if is_fresh and x_m is not None and y_m is not None and isfinite(x_m + y_m):
                return x_m, y_m
    return None


def _shown(point: Point) -> str:
    return f"[{point[0]:.2f}, {point[1]:.2f}]"


def _point(body: Body, frame: LocalFrame) -> Point:
    """Return the place of a waypoint in the world."""
    if "point_m" in body:
        if "latitude" in body or "longitude" in body:
            message = "a waypoint has either point_m, or latitude and longitude"
            raise ValueError(message)
        given = body["point_m"]
        if not isinstance(given, list) or len(given) != 2:  # noqa: PLR2004
            message = "point_m must be two numbers"
            raise ValueError(message)
        return _pair(*(partial(number, each, f"point_m[{i}]") for i, each in enumerate(given)))
    latitude, longitude = (
        partial(_degrees, body, key, letters)
        for key, letters in (("latitude", "NS"), ("longitude", "EW"))
    )
    return position_m(frame, *_pair(latitude, longitude))


def _pair(*reads: Callable[[], float]) -> Point:
    """Return two values, or the errors of both."""
    values, errors = [], []
    for read in reads:
        try:
            values.append(read())
        except ValueError as error:
            errors.append(str(error))
    if errors:
        raise ValueError("; ".join(errors))
    return values[0], values[1]


def _degrees(body: Body, key: str, letters: str) -> float:
    angle = body.get(key)
    if not isinstance(angle, dict) or angle.get("hemisphere") not in tuple(letters):
        message = f"{key} must have degrees, minutes, and the hemisphere {' or '.join(letters)}"
        raise ValueError(message)
    degrees, minutes = (number(angle.get(part), f"{key}.{part}") for part in ("degrees", "minutes"))
    limit_deg = 90.0 if key == "latitude" else 180.0
    value = degrees + minutes / MINUTES_PER_DEG
    if degrees < 0 or not 0 <= minutes < MINUTES_PER_DEG or value > limit_deg:
        message = f"{key} must be 0 to {limit_deg:g} degrees, and 0 to 59.99 minutes"
        raise ValueError(message)
    return value if angle["hemisphere"] == letters[0] else -value
