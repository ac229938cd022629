"""The simulated world: bodies, obstacles and sensors are those of the engine."""

from collections.abc import Mapping
from dataclasses import dataclass

from agent_economy.live.emulator.bender import KIND, Bender
from agent_economy.live.emulator.settings import MAX_RATE_HZ, Settings
from agent_economy.live.emulator.tracks import Motion
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin
from agent_economy.runs.brain import Percept
from agent_economy.runs.simulation import Simulation
from agent_economy.scenario import Override, Scenario

STEP_S = 1 / MAX_RATE_HZ
"""Length of a step."""

MONTEREY = {"latitude_deg": 36.595267, "longitude_deg": -121.875003, "declination_deg": 14.5}
"""The origin of a scenario without its own: that of the bundled scenario, with x to the east."""


@dataclass(frozen=True)
class Senses:
    """What the sensors of a robot measured last; None where nothing was measured.

    Attributes:
        at_m: Its position in the world.
        heading_rad: Its heading: 0 along x, anticlockwise.
        ranges_m: The ranges of the sonars from the centre of the robot; None without an echo.
    """

    at_m: tuple[float, float] | None = None
    heading_rad: float | None = None
    ranges_m: tuple[float | None, ...] = (None,) * 6


@dataclass(frozen=True)
class Pose:
    """Where a robot is, and its speed."""

    x_m: float
    y_m: float
    heading_rad: float
    speed_m_s: float


class World:
    """A simulation whose robots of the kind `bender` are commanded from outside.

    Attributes:
        frame: Its place on the earth.
        max_range_m: Maximum range of each sonar.
        robots: Names of the robots.
    """

    def __init__(self, scenario: Scenario, robots: int, seed: int, settings: Settings) -> None:
        """Create it at its first step.

        Raises:
            InputError: If the scenario has no `bender` with the sensors of the protocol, or no room
                for that number of robots.
        """
        self._bender = Bender.of(scenario)
        self._errors = self._bender.errors(settings)
        self._simulation = Simulation(self._bender.emulated(robots, settings), seed)
        self.frame = frame_of(Origin(**(self._bender.world.get("origin") or MONTEREY)))
        self.max_range_m = self._bender.max_range_m
        self.robots = tuple(f"{KIND}/{index}" for index in range(robots))

    @property
    def time_s(self) -> float:
        """Simulated time."""
        return self._simulation.time_s

    @property
    def collisions(self) -> int:
        """Number of collisions so far."""
        return int(self._simulation.outcome().collisions or 0)

    def step(self, motions: Mapping[str, Motion]) -> None:
        """Advance by one step; each body executes its motion as far as it can."""
        commands = {
            robot: {"motion": {"speed_m_s": speed, "turn_rate_rad_s": turn_rate}}
            for robot, (speed, turn_rate) in motions.items()
        }
        self._simulation.step(commands=commands)  # type: ignore[arg-type]

    def senses(self, robot: str, before: Senses) -> Senses:
        """Return what a robot has measured; those before if it measures no longer."""
        percept = self._simulation.percept(robot)
        return before if percept is None else senses_of(percept)

    def pose(self, robot: str) -> Pose:
        """Return the true pose of a robot."""
        row = self._simulation.robots.index(robot)
        x_m, y_m, heading_rad = map(float, self._simulation.poses[row])
        return Pose(x_m, y_m, heading_rad, float(self._simulation.speeds[row]))

    def set_errors(self, settings: Settings) -> None:
        """Take over the errors of the drive and of the sensors.

        Raises:
            InputError: If the scenario does not allow them. Nothing is changed then.
        """
        errors = self._bender.errors(settings)
        changed = {path: value for path, value in errors.items() if value != self._errors[path]}
        overrides = (Override.at(path, value, "emulator") for path, value in changed.items())
        self._simulation.scenario.changed(tuple(overrides))
        for path, value in changed.items():
            self._simulation.change(path, value)
        self._errors = errors


def senses_of(percept: Percept) -> Senses:
    """Return the senses in a percept: its scans are those of the sonars, in their order."""
    at, heading = percept["position"], percept["heading_rad"]
    ranges = [scan.get("ranges_m") or [None] for scan in percept["scans"]]
    return Senses(
        (at["value"][0], at["value"][1]) if at else None,
        heading["value"] if heading else None,
        tuple(first for first, *_ in ranges),
    )
