"""What the warden has to know of a fleet: plain values, as the loop sends them when it starts."""

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Literal

from agent_economy.live.readings import Quantity

Point = tuple[float, float]

ReadingSource = Literal["real", "virtual", "both"]
"""Where the readings of a sensor come from: the robot, the scenario, or both."""


@dataclass(frozen=True)
class Origin:
    """The geographic origin of the world: see the scenario's `[world.origin]`."""

    latitude_deg: float
    longitude_deg: float
    rotation_deg: float = 0.0
    declination_deg: float = 0.0


@dataclass(frozen=True)
class InputPlan:
    """One input of a robot, and what is possible for it.

    Attributes:
        port: The port that its lines come from.
        quantity: What it measures.
        max_age_s: Age at which it is stale.
        noise: Its standard deviation, in the unit of its quantity.
        bounds: The possible values, in the unit of its quantity. Positions and headings have none:
            each finite value is possible.
    """

    port: str
    quantity: Quantity
    max_age_s: float
    noise: float
    bounds: tuple[float, float] | None = None


@dataclass(frozen=True)
class Wall:
    """An obstacle of the world, or a part of one.

    Attributes:
        name: Its path in the scenario.
        corners_m: Its corners in order; the centre of a circle.
        radius_m: The radius of a circle; 0 for others.
    """

    name: str
    corners_m: tuple[Point, ...]
    radius_m: float = 0.0


@dataclass(frozen=True)
class RobotPlan:
    """One robot of a fleet.

    Attributes:
        name: Its name in the scenario, KIND/INDEX.
        driver: The name of its driver.
        host: Its address.
        ports: The number of each of its ports.
        settings: All settings of the driver.
        inputs: Its inputs, by port.
        fence_m: Corners of the area that it must not leave, in the world; None without a fence.
        max_speed_m_s: Its maximum speed.
        max_turn_rate_rad_s: Its maximum turn rate.
        manual_speed_m_s: Its maximum speed in manual mode while an input is stale.
        min_battery: It stops below this share of its charge, if it reports one.
        deadman_s: Time after which the robot stops by itself without a motor line; None if it
            has no such timer.
        repeat_s: Time between two motor lines of the same motion.
        takes_orders: Whether its brain visits waypoints that an operator orders.
        radius_m: Radius of its body; None if it flies over walls.
        sensors: Where the readings of each of its sensors come from, by name: `real`, `virtual` or
            `both`. Those that are missing are real, as all of older recordings.
        scans: For each ring of rays of its body, the number of the sonar whose range is its scan;
            None for a ring that is virtual only. In older recordings, there is a sonar for each.
    """

    name: str
    driver: str
    host: str
    ports: Mapping[str, int]
    settings: Mapping[str, Any]
    inputs: tuple[InputPlan, ...]
    max_speed_m_s: float
    max_turn_rate_rad_s: float
    manual_speed_m_s: float
    min_battery: float = 0.1
    fence_m: tuple[Point, ...] | None = None
    deadman_s: float | None = None
    repeat_s: float = 0.2
    takes_orders: bool = True
    radius_m: float | None = None
    sensors: Mapping[str, ReadingSource] = field(default_factory=dict)
    scans: tuple[int | None, ...] | None = None


@dataclass(frozen=True)
class FleetPlan:
    """A fleet.

    Attributes:
        origin: The geographic origin of its world.
        robots: Its robots.
        period_s: Time between two steps of the loop.
        setpoint_lifetime_s: Time for which a setpoint is valid.
        max_lateness_s: Lateness of the loop at which all robots stop.
        size_m: Width and height of the world; None if they are unknown.
        walls: The obstacles of the world; None if there are too many for a plan.
    """

    origin: Origin
    robots: tuple[RobotPlan, ...]
    period_s: float
    setpoint_lifetime_s: float = 0.3
    max_lateness_s: float = 0.5
    warnings: tuple[str, ...] = field(default=())
    size_m: Point | None = None
    walls: tuple[Wall, ...] | None = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the plan as plain values, for JSON."""
        return asdict(self)


def plan_of(values: Mapping[str, Any]) -> FleetPlan:
    """Return the plan that `FleetPlan.to_dict` described."""
    robots = tuple(_robot(each) for each in values["robots"])
    rest = {key: value for key, value in values.items() if key not in ("origin", "robots")}
    rest["warnings"] = tuple(rest.get("warnings", ()))
    rest["size_m"] = rest.get("size_m") and tuple(rest["size_m"])
    # Recordings of older drives have none.
    walls = rest.get("walls", ())
    rest["walls"] = None if walls is None else tuple(_wall(each) for each in walls)
    return FleetPlan(origin=Origin(**values["origin"]), robots=robots, **rest)


def _wall(values: Mapping[str, Any]) -> Wall:
    return Wall(values["name"], _points(values["corners_m"]), values["radius_m"])


def _points(values: Iterable[tuple[float, float]]) -> tuple[Point, ...]:
    return tuple((float(x), float(y)) for x, y in values)


def _robot(values: Mapping[str, Any]) -> RobotPlan:
    inputs = tuple(_input(each) for each in values["inputs"])
    fence = values.get("fence_m")
    fence_m = fence and _points(fence)
    scans = values.get("scans")
    scans = None if scans is None else tuple(scans)
    return RobotPlan(**{**values, "inputs": inputs, "fence_m": fence_m, "scans": scans})


def _input(values: Mapping[str, Any]) -> InputPlan:
    bounds = values.get("bounds")
    quantity = Quantity(values["quantity"])
    return InputPlan(**{**values, "quantity": quantity, "bounds": bounds and tuple(bounds)})
