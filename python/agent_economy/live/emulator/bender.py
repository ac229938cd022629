"""The scenario that is emulated: a robot kind `bender` with the sensors of the protocol."""

from dataclasses import dataclass
from typing import Any

import tomli_w

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.live.emulator.settings import MAX_RATE_HZ, Settings
from agent_economy.scenario import Override, Scenario, Source

KIND = "bender"
"""The robot kind that is emulated. The robots of other kinds are in no real world."""

SONARS = tuple(f"sonar_{index}" for index in range(6))

DRIVE = ("lag_s", "delay_s", "gain", "gain_left_right", "track_width_m")
"""Settings that are values of the drive of the scenario, under the same names."""

Values = dict[str, Any]
"""Values of the scenario, by path."""


WORLD = ("engine", "summary", "clock", "world")
BODY = ("count", "radius_m", "start", "drive", "collision", "layer")
"""What the real world has of a scenario, and of its robots."""


@dataclass(frozen=True)
class Bender:
    """What the emulator has to know of a scenario.

    Attributes:
        scenario: The scenario.
        position: Name of the position sensor.
        heading: Name of the compass.
        max_range_m: Maximum range of each sonar.
        world: Its `[world]`.
    """

    scenario: Scenario
    position: str
    heading: str
    max_range_m: tuple[float, ...]
    world: Values

    @classmethod
    def of(cls, scenario: Scenario) -> "Bender":
        """Read a scenario.

        Raises:
            InputError: If it has no robot kind `bender` with the sensors of the protocol.
        """
        spec = scenario.to_dict()
        sensors = spec.get("robots", {}).get(KIND, {}).get("sensors", {})
        missing = [f"{name} (kind range, 1 ray)" for name in SONARS if not is_sonar(sensors, name)]
        names = {kind: named(sensors, kind) for kind in ("position", "heading")}
        missing += [f"one of kind {kind}" for kind, name in names.items() if name is None]
        if missing:
            message = (
                f"{scenario.source.file}: robots.{KIND}.sensors: missing {', '.join(missing)}; "
                "start from the bundled scenario bender"
            )
            raise InputError(message)
        return cls(
            scenario,
            str(names["position"]),
            str(names["heading"]),
            tuple(sensors[name]["range_m"] for name in SONARS),
            spec["world"],
        )

    def emulated(self, robots: int, settings: Settings) -> Scenario:
        """Return the scenario with that number of robots, whose sensors measure in every step.

        Raises:
            InputError: If the scenario does not allow that.
        """
        robot = f"robots.{KIND}"
        every = (*SONARS, self.position, self.heading)
        values = {
            f"{robot}.count": robots,
            f"{robot}.brain.rate_hz": MAX_RATE_HZ,
            "clock.step_s": 1 / MAX_RATE_HZ,
            **{f"{robot}.sensors.{name}.rate_hz": MAX_RATE_HZ for name in every},
            **self.errors(settings),
        }
        overrides = (Override.at(path, value, "emulator") for path, value in values.items())
        return self._real_world().changed(tuple(overrides))

    def _real_world(self) -> Scenario:
        """Return the scenario without what only a drive has: simulated robots, items and goals."""
        filled = _core.read_filled(self.scenario.source)
        kind = filled["robots"][KIND]
        sensors = {name: kind["sensors"][name] for name in (*SONARS, self.position, self.heading)}
        body = {key: kind[key] for key in BODY if key in kind}
        world = {key: filled[key] for key in WORLD if key in filled}
        robots = {KIND: body | {"sensors": sensors}}
        source = self.scenario.source
        text = tomli_w.dumps({**world, "merit": "equation-5.2", "robots": robots})
        return Scenario.of(Source(source.file, text, (), source.files))

    def errors(self, settings: Settings) -> Values:
        """Return the errors of the drive and of the sensors."""
        robot = f"robots.{KIND}"
        drive = {f"{robot}.drive.{name}": getattr(settings, name) for name in DRIVE}
        receiver = f"{robot}.sensors.{self.position}"
        drift = {
            f"{receiver}.drift_m": settings.gps_drift_m,
            f"{receiver}.drift_s": settings.gps_drift_s,
        }
        return drive | drift | self._noise(settings)

    def _noise(self, settings: Settings) -> Values:
        """Return the noise of the receiver and the compass: of the settings, or its own."""
        spec = self.scenario.to_dict()["robots"][KIND]["sensors"]
        keys = (
            (self.position, "noise_m", settings.gps_noise_m),
            (self.heading, "noise_deg", settings.compass_noise_deg),
        )
        return {
            f"robots.{KIND}.sensors.{name}.{key}": (
                spec[name].get(key, 0.0) if value == "scenario" else value
            )
            for name, key, value in keys
        }


def is_sonar(sensors: Values, name: str) -> bool:
    """Return whether a sensor is a sonar of one ray."""
    sensor = sensors.get(name, {})
    return (sensor.get("kind"), sensor.get("rays")) == ("range", 1)


def named(sensors: Values, kind: str) -> str | None:
    """Return the name of the first sensor of a kind."""
    return next((name for name in sorted(sensors) if sensors[name]["kind"] == kind), None)
