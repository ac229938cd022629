"""What a scenario states about its world and its kinds of robots: valid values, with defaults."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from agent_economy import _core
from agent_economy._core import Document
from agent_economy.live.fleet_file.findings import Path
from agent_economy.live.fleet_file.walls import walls_of
from agent_economy.live.legs import Walls
from agent_economy.live.plan import Point, Wall
from agent_economy.scenario import Scenario

DEFAULT_STEP_S = 0.1
DEFAULT_WITHIN_M = 0.5

WAYPOINT_BEHAVIOURS = {"correct", "navigate"}


@dataclass(frozen=True)
class ScenarioWorld:
    """A scenario of the metric engine, with the lines of its values."""

    scenario: Scenario

    @cached_property
    def document(self) -> Document:
        """The text of the scenario, for errors about it."""
        source = self.scenario.source
        return Document(source.file, source.text)

    @cached_property
    def values(self) -> dict[str, Any]:
        """The scenario, with the values of bundled robot models."""
        return _core.read_filled(self.scenario.source)

    @property
    def world(self) -> Mapping[str, Any]:
        """Its table `world`."""
        world: Mapping[str, Any] = self.values["world"]
        return world

    @property
    def origin(self) -> Mapping[str, float] | None:
        """Its geographic origin, if it has one."""
        origin: Mapping[str, float] | None = self.world.get("origin")
        return origin

    @property
    def step_s(self) -> float:
        """Its time step."""
        return float(self.values["clock"].get("step_s", DEFAULT_STEP_S))

    @cached_property
    def walls(self) -> tuple[Wall, ...]:
        """Its obstacles."""
        return walls_of(self.scenario, self.world.get("obstacles", []))

    @cached_property
    def indexed_walls(self) -> Walls:
        """Its obstacles, for questions about many points and ways."""
        return Walls(self.walls)

    def contains(self, point: Point) -> bool:
        """Return whether a point is in the world."""
        width_m, height_m = self.world["size_m"]
        return 0.0 <= point[0] <= float(width_m) and 0.0 <= point[1] <= float(height_m)

    def kind(self, name: str) -> "ScenarioKind":
        """Return a kind of robot."""
        return ScenarioKind(self, name, self.values["robots"][name])


@dataclass(frozen=True)
class ScenarioKind:
    """A kind of robot of a scenario.

    Attributes:
        of: The scenario.
        name: Its name.
        given: Its table.
    """

    of: ScenarioWorld
    name: str
    given: Mapping[str, Any]

    def path(self, *keys: str | int) -> Path:
        """Return the path of a value of the kind in the scenario."""
        return ("robots", self.name, *keys)

    @property
    def drive(self) -> Mapping[str, Any]:
        """The limits of its motion."""
        drive: Mapping[str, Any] = self.given["drive"]
        return drive

    @property
    def max_speed_m_s(self) -> float:
        """Its maximum speed."""
        return float(self.drive["max_speed_m_s"])

    @property
    def brain_period_s(self) -> float:
        """Time between two steps of its brain."""
        rate_hz = self.given.get("brain", {}).get("rate_hz")
        return max(self.of.step_s, 1 / rate_hz) if rate_hz else self.of.step_s

    def sensors(self, kind: str) -> dict[str, Mapping[str, Any]]:
        """Return its sensors of a kind, by name, in alphabetical order."""
        sensors = self.given.get("sensors", {})
        return {name: sensors[name] for name in sorted(sensors) if sensors[name]["kind"] == kind}

    def behaviours(self) -> Iterator[tuple[Path, Mapping[str, Any]]]:
        """Yield each behaviour of its brain, with its path in the scenario."""
        behaviours = self.given.get("brain", {}).get("behaviours", [])
        for index, each in enumerate(behaviours):
            yield self.path("brain", "behaviours", index), each

    @property
    def takes_orders(self) -> bool:
        """Whether its brain visits waypoints that an operator orders."""
        return any(each["kind"] == "correct" for _, each in self.behaviours())

    @property
    def radius_m(self) -> float | None:
        """The radius of its body; None if it flies over obstacles."""
        return float(self.given["radius_m"]) if self.given.get("layer") != "air" else None

    def waypoints(self) -> Iterator[tuple[Path, Point]]:
        """Yield each waypoint of its brain, with its path in the scenario."""
        for path, behaviour in self.behaviours():
            if behaviour["kind"] in WAYPOINT_BEHAVIOURS:
                for index, (x, y) in enumerate(behaviour.get("waypoints_m", [])):
                    yield (*path, "waypoints_m", index), (float(x), float(y))

    def waypoints_m(self) -> list[Point]:
        """Return the waypoints of its brain."""
        return [point for _, point in self.waypoints()]

    def start_m(self, index: int) -> Point | None:
        """Return where a robot of the kind starts, if the scenario gives a fixed place."""
        places = self.given.get("start", {}).get("at_m", [])
        if index >= len(places):
            return None
        x, y = places[index]
        return float(x), float(y)
