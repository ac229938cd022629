"""The sensors of a scenario's kind: they have to be those that a driver has inputs for."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from agent_economy._core import Document
from agent_economy.live.drivers import Port
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings, listed
from agent_economy.live.fleet_file.scenario_kind import ScenarioKind
from agent_economy.live.fleet_file.sources import KINDS, Sensor, input_sensors
from agent_economy.live.plan import InputPlan
from agent_economy.live.readings import Quantity

MAX_ROUNDING = 0.01
"""A range may be rounded by this fraction of the maximum range."""

MAX_SIGMAS = 5
"""A range may exceed the maximum range by this number of standard deviations."""


@dataclass(frozen=True)
class Measurement:
    """What is possible for a quantity: see `InputPlan`."""

    noise: float
    bounds: tuple[float, float] | None


def check_sensors(findings: Findings, fleet: Document, entry: Entry, kind: ScenarioKind) -> None:
    """Report a driver whose inputs are not sensors of the kind."""
    if findings.has_error_at(fleet, (*entry.path, "sensors")):
        return
    ports = [port for port in entry.driver.ports if port.quantity in KINDS]
    found = {port: input_sensors(port, entry, kind) for port in ports}
    wrong = [
        f"needs {_wanted(port)}, and {_found(kind.sensors(KINDS[port.quantity]))}"
        + _fix(port, found[port], entry)
        for port in ports
        if port.quantity is not None and not _is_matched(port, found[port])
    ]
    if wrong:
        allowed = (
            f"a driver for the sensors of robots.{kind.name} in the scenario: {entry.driver.name} "
            f"{'; it '.join(wrong)}"
        )
        findings.error(fleet, (*entry.path, "driver"), allowed)


def input_plan(port: Port, entry: Entry, kind: ScenarioKind) -> InputPlan:
    """Return the input of a port with a quantity, whose sensors have been checked."""
    quantity = port.quantity or Quantity.BATTERY
    possible = _measurement(quantity, list(input_sensors(port, entry, kind).values()))
    max_age_s = entry.max_age_s[port.name]
    return InputPlan(port.name, quantity, max_age_s, possible.noise, possible.bounds)


def position_noise_m(kind: ScenarioKind) -> float:
    """Return the standard deviation of its positions along each axis."""
    sensors = kind.sensors("position").values()
    return max((float(sensor.get("noise_m", 0)) for sensor in sensors), default=0.0)


def _measurement(quantity: Quantity, sensors: list[Sensor]) -> Measurement:
    match quantity:
        case Quantity.RANGES:
            max_range_m = max(float(sensor["range_m"]) for sensor in sensors)
            noise_m = max(_range_noise_m(sensor) for sensor in sensors)
            # Noise and rounding may take a range beyond the maximum.
            bound_m = max_range_m * (1 + MAX_ROUNDING) + MAX_SIGMAS * noise_m
            return Measurement(noise_m, (0.0, bound_m))
        case Quantity.HEADING:
            return Measurement(math.radians(float(sensors[0].get("noise_deg", 0))), None)
        case Quantity.POSITION:
            return Measurement(float(sensors[0].get("noise_m", 0)), None)
        case Quantity.BATTERY:
            return Measurement(0.0, (0.0, 1.0))


def _range_noise_m(sensor: Sensor) -> float:
    """Return the standard deviation at the maximum range."""
    relative = float(sensor.get("relative_noise", 0)) * float(sensor["range_m"])
    return float(sensor.get("noise_m", 0)) + relative


def _is_matched(port: Port, found: Mapping[str, Sensor]) -> bool:
    return len(found) == (port.values if port.quantity is Quantity.RANGES else 1)


def _wanted(port: Port) -> str:
    if port.quantity is Quantity.RANGES:
        return f'{port.values} sensors of kind "range" with rays = 1'
    return f'one sensor of kind "{KINDS.get(port.quantity or Quantity.POSITION)}"'


def _fix(port: Port, found: Mapping[str, Sensor], entry: Entry) -> str:
    """Return how the sources of sensors have to change, if that can help."""
    stated = sorted(name for name, source in entry.sensors.items() if source == "virtual")
    if len(found) > (port.values if port.quantity is Quantity.RANGES else 1):
        return (
            ' (set the others to "virtual" under sensors)' if not set(found) <= set(stated) else ""
        )
    return f" (not all of {listed(stated)} can be virtual)" if stated else ""


def _found(found: Mapping[str, Sensor]) -> str:
    """Return which sensors of a kind there are, with the numbers of their rays."""
    each = [
        f"{name} (rays = {has['rays']})" if "rays" in has else name for name, has in found.items()
    ]
    return f"the kind has {listed(each) if each else 'none'}"
