"""Where the readings of the sensors of a real robot come from: the robot, the scenario, or both."""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import count
from typing import Any, Protocol

from agent_economy import _core
from agent_economy._core import Document
from agent_economy.live.drivers import Port
from agent_economy.live.fleet_file.entry import Entry
from agent_economy.live.fleet_file.findings import Findings, listed
from agent_economy.live.plan import ReadingSource
from agent_economy.live.readings import Quantity

Sensor = Mapping[str, Any]

KINDS = {
    Quantity.RANGES: "range",
    Quantity.POSITION: "position",
    Quantity.HEADING: "heading",
}
"""The kind of sensor that measures a quantity."""


class HasSensors(Protocol):
    """A kind of robots of a scenario, which may have errors elsewhere."""

    @property
    def name(self) -> str:
        """Its name."""

    @property
    def given(self) -> Mapping[str, Any]:
        """Its table."""


@dataclass(frozen=True)
class BareKind:
    """A kind of an invalid scenario.

    Attributes:
        name: Its name.
        given: Its table.
    """

    name: str
    given: Mapping[str, Any]


def sources_of(entry: Entry, kind: HasSensors) -> dict[str, ReadingSource]:
    """Return where the readings of each sensor of a robot come from, by name.

    Without a statement of the file, they are real if the driver measures them, otherwise virtual.
    """
    sensors = all_sensors(kind)
    default = {name: _default(entry, each) for name, each in sensors.items()}
    return {name: entry.sensors.get(name, default[name]) for name in sensors}


def all_sensors(kind: HasSensors) -> dict[str, Sensor]:
    """Return the sensors of a kind, by name, in alphabetical order."""
    return dict(sorted(kind.given.get("sensors", {}).items()))


def input_sensors(port: Port, entry: Entry, kind: HasSensors) -> dict[str, Sensor]:
    """Return the sensors of a kind that the lines of a port are readings of, by name.

    The rules judge an input also if all its sensors are virtual.
    """
    sources = sources_of(entry, kind)
    fitting = {name: each for name, each in all_sensors(kind).items() if _fits(port, each)}
    real = {name: each for name, each in fitting.items() if sources[name] != "virtual"}
    return real or fitting


def check_sources(findings: Findings, fleet: Document, entry: Entry, kind: HasSensors) -> None:
    """Report sources that sensors cannot have."""
    sensors = all_sensors(kind)
    for name, source in sorted(entry.sensors.items()):
        path = (*entry.path, "sensors", name)
        if name not in sensors:
            allowed = f"a sensor of robots.{kind.name} in the scenario"
            findings.unknown_key(fleet, path, allowed, list(sensors))
        elif (refused := _allowed(entry, kind, name, source)) is not None:
            findings.error(fleet, path, refused)


def virtual_by_default(entry: Entry, kind: HasSensors) -> list[str]:
    """Return the sensors that are virtual without a statement of the file, by name."""
    sources = sources_of(entry, kind)
    return [
        name
        for name, source in sources.items()
        if source == "virtual" and name not in entry.sensors
    ]


def scans_of(entry: Entry, kind: HasSensors) -> tuple[int | None, ...]:
    """Return the number of the sonar for each ring of rays of a body; None for a virtual one."""
    facts, sources = _core.sensor_kinds(), sources_of(entry, kind)
    sonars = count()
    return tuple(
        next(sonars) if sources[name] != "virtual" else None
        for name, sensor in all_sensors(kind).items()
        if facts[sensor["kind"]]["is_ring"]
    )


def _default(entry: Entry, sensor: Sensor) -> ReadingSource:
    is_measured = any(_fits(port, sensor) for port in entry.driver.ports)
    return "real" if is_measured else "virtual"


def _fits(port: Port, sensor: Sensor) -> bool:
    """Return whether a port has readings of a sensor: a sonar is a range sensor of one ray."""
    is_of_kind = port.quantity is not None and KINDS.get(port.quantity) == sensor["kind"]
    return is_of_kind and (port.quantity is not Quantity.RANGES or sensor["rays"] == 1)


def _allowed(entry: Entry, kind: HasSensors, name: str, source: ReadingSource) -> str | None:
    """Return what is allowed, if a source is not."""
    sensor = all_sensors(kind)[name]
    facts, driver = _core.sensor_kinds()[sensor["kind"]], entry.driver.name
    is_measured = any(_fits(port, sensor) for port in entry.driver.ports)
    if source == "virtual":
        others = [other for other in _same(entry, kind, name) if other != name]
        if facts["states_pose"] and not others:
            return (
                f'"real": virtual sensors measure from the {sensor["kind"]} that a real one '
                "states, and this robot has no other"
            )
        return None
    if not is_measured:
        return (
            f'"virtual": the driver {driver} has no input for it, only for sensors of kind '
            f"{_inputs(entry)}"
        )
    if source == "both" and not facts["can_be_both"]:
        return f'"real": a real and a virtual {sensor["kind"]} cannot be merged'
    same = _same(entry, kind, name)
    if facts["states_pose"] and len(same) > 1:
        return (
            f'"virtual" for all but one of {listed(same)}: the driver {driver} measures one '
            f"{sensor['kind']}"
        )
    return None


def _same(entry: Entry, kind: HasSensors, name: str) -> list[str]:
    """Return the sensors of the same kind that are real, by name."""
    sensors, sources = all_sensors(kind), sources_of(entry, kind)
    alike = [each for each in sensors if sensors[each]["kind"] == sensors[name]["kind"]]
    return [each for each in alike if sources[each] != "virtual"]


def _inputs(entry: Entry) -> str:
    kinds = sorted(KINDS[port.quantity] for port in entry.driver.ports if port.quantity in KINDS)
    return listed([f'"{kind}"' + (" (of one ray)" if kind == "range" else "") for kind in kinds])
