"""A robot of a fleet file, with defaults."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from agent_economy.live.drivers import DRIVERS, Driver
from agent_economy.live.fleet_file.schema import MANUAL_SPEED_M_S, MIN_BATTERY
from agent_economy.live.plan import Point, ReadingSource

PORTS_PER_ROBOT = 10
"""Distance of the default port numbers of two robots of a kind."""


@dataclass(frozen=True)
class Entry:
    """A robot of a fleet file whose values are valid, each by itself.

    Attributes:
        kind: Its kind in the scenario.
        index: Its index within the kind.
        given: The table of the file.
        driver: Its driver.
        ports: The number of each of its ports.
        max_age_s: Age at which the newest line of a port is stale, by port.
        settings: All settings of the driver.
        fence_m: Corners of its fence; None without one.
        waypoints_m: Its waypoints at the start; None without any.
    """

    kind: str
    index: int
    given: Mapping[str, Any]
    driver: Driver
    ports: dict[str, int]
    max_age_s: dict[str, float]
    settings: dict[str, Any]
    fence_m: tuple[Point, ...] | None
    waypoints_m: tuple[Point, ...] | None

    @property
    def name(self) -> str:
        """Its name in the scenario, KIND/INDEX."""
        return f"{self.kind}/{self.index}"

    @property
    def sensors(self) -> Mapping[str, ReadingSource]:
        """Where the readings of sensors come from, by name, as far as the file states it."""
        sensors: Mapping[str, ReadingSource] = self.given.get("sensors", {})
        return sensors

    @property
    def path(self) -> tuple[str, ...]:
        """Its path in the file."""
        return ("robots", self.name)

    @property
    def host(self) -> str:
        """Its host name or address."""
        return str(self.given["host"])

    @property
    def deadman_s(self) -> float | None:
        """Time after which it stops by itself without a motor line, if it has such a timer."""
        return self.given.get("deadman_s")

    @property
    def min_battery(self) -> float:
        """It stops below this share of its charge."""
        return float(self.given.get("min_battery", MIN_BATTERY))

    def manual_speed_m_s(self, max_speed_m_s: float) -> float:
        """Return its maximum speed in manual mode while an input is stale."""
        return float(self.given.get("manual_speed_m_s", min(MANUAL_SPEED_M_S, max_speed_m_s)))


def entry_of(kind: str, index: int, given: Mapping[str, Any]) -> Entry:
    """Return a robot from its table, which agrees with the schema."""
    driver = DRIVERS[given["driver"]]
    offset = PORTS_PER_ROBOT * index
    numbers = {port.name: port.number + offset for port in driver.ports}
    ages = {port.name: port.max_age_s for port in driver.ports if port.max_age_s is not None}
    defaults = {key: setting.default for key, setting in driver.settings.items()}
    return Entry(
        kind=kind,
        index=index,
        given=given,
        driver=driver,
        ports=numbers | given.get("ports", {}),
        max_age_s=ages | given.get("max_age_s", {}),
        settings=defaults | given.get("settings", {}),
        fence_m=_points(given.get("fence_m")),
        waypoints_m=_points(given.get("waypoints_m")),
    )


def _points(given: list[list[float]] | None) -> tuple[Point, ...] | None:
    return None if given is None else tuple((float(x), float(y)) for x, y in given)
