"""The JSON Schema of fleet files, from the drivers: also for editors."""

from collections.abc import Mapping
from typing import Any

from agent_economy.live.drivers import DRIVERS, Driver, Port, Setting

Schema = dict[str, Any]

SETPOINT_LIFETIME_S = 0.3
MAX_LATENESS_S = 0.5
MIN_BATTERY = 0.1
MANUAL_SPEED_M_S = 0.2

MAX_CORNERS = 1000
MAX_WAYPOINTS = 1_000
"""More orders at once take a brain longer than `MAX_LATENESS_S`: the robot would be stopped."""

_SECONDS = "s"
"""The unit in messages, as the Rust core names it."""


def fleet_schema() -> Schema:
    """Return the schema of a fleet file, of draft 7."""
    return {
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "Fleet of Agent Economy",
        "description": "Real robots that a scenario's brains drive.",
        **_table(
            {
                "scenario": {
                    "type": "string",
                    "minLength": 1,
                    "description": "The scenario: the name of a bundled one, or a path relative to "
                    "this file.",
                },
                "setpoint_lifetime_s": _number(
                    "Time for which a setpoint of the brain is valid, in seconds. A robot stops "
                    "without a newer one.",
                    (0.01, 10),
                    SETPOINT_LIFETIME_S,
                ),
                "max_lateness_s": _number(
                    "Lateness of the control loop at which all robots stop, in seconds.",
                    (0.01, 10),
                    MAX_LATENESS_S,
                ),
                "robots": {
                    "type": "object",
                    "description": "The robots of the scenario, by name: KIND/INDEX.",
                    "additionalProperties": {"oneOf": [_robot(each) for each in DRIVERS.values()]},
                },
            },
            ("scenario", "robots"),
        ),
    }


def _robot(driver: Driver) -> Schema:
    reading = [port for port in driver.ports if port.quantity is not None]
    settings = {key: _setting(each) for key, each in driver.settings.items()}
    described = f"A robot with the driver {driver.name}."
    keys: dict[str, Schema] = {
        "driver": {"const": driver.name, "description": "The driver of this kind of robot."},
        "host": {"type": "string", "minLength": 1, "description": "Its host name or IP address."},
        "ports": _table({port.name: _port(port) for port in driver.ports})
        | {"description": "The number of each of its TCP ports."},
        "max_age_s": _table({port.name: _max_age(port) for port in reading})
        | {"description": "Age at which the newest line of a port is stale, in seconds."},
        "settings": _table(settings) | {"description": "Settings of the driver."},
        "sensors": {
            "type": "object",
            "description": "Where the readings of its sensors come from, by name: the robot, the "
            "scenario (simulated robots, items and obstacles, as seen from its position), or both. "
            "Without it, from the robot if the driver measures them, otherwise from the scenario.",
            "additionalProperties": {"enum": ["real", "virtual", "both"]},
        },
    }
    return {"description": described, **_table(keys | _limits(), ("driver", "host"))}


def _limits() -> dict[str, Schema]:
    return {
        "fence_m": _points(
            "Corners of the area that it must not leave, in order, in metres of the world.",
            (3, MAX_CORNERS),
        ),
        "deadman_s": _number(
            "Time after which the robot stops by itself without a motor line, in seconds. "
            "Without it, it has no such timer.",
            (0.1, 60),
        ),
        "min_battery": _number(
            "It stops below this fraction of its charge, if it reports one.", (0, 1), MIN_BATTERY
        ),
        "manual_speed_m_s": _number(
            "Its maximum speed in manual mode while an input is stale, in m/s.",
            (0, 100),
            MANUAL_SPEED_M_S,
        ),
        "waypoints_m": _points(
            "Waypoints that are ordered at the start, in metres of the world: after those of the "
            "scenario's brain.",
            (0, MAX_WAYPOINTS),
        ),
    }


def _table(keys: Mapping[str, Schema], required: tuple[str, ...] = ()) -> Schema:
    table: Schema = {
        "type": "object",
        "properties": dict(keys),
        "additionalProperties": False,
    }
    return table | ({"required": list(required)} if required else {})


def _number(text: str, bounds: tuple[float, float], default: float | None = None) -> Schema:
    low, high = bounds
    number = {"type": "number", "minimum": low, "maximum": high, "description": text}
    return number if default is None else number | {"default": default}


def _port(port: Port) -> Schema:
    return {
        "type": "integer",
        "minimum": 1,
        "maximum": 65535,
        "description": f"Without it, {port.number} plus ten times the index of the robot.",
    }


def _max_age(port: Port) -> Schema:
    text = f"Of lines with {port.quantity}."
    return _number(text, (0.01, 60), port.max_age_s) | {"x-unit": _SECONDS}


def _setting(setting: Setting) -> Schema:
    guess = " The default is a guess: measure it on the robot." if setting.is_guess else ""
    schema = dict(setting.schema) | {"description": setting.description + guess}
    return schema if setting.default is None else schema | {"default": setting.default}


def _points(text: str, length: tuple[int, int]) -> Schema:
    low, high = length
    point = {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 2}
    return {
        "type": "array",
        "items": point,
        "minItems": low,
        "maxItems": high,
        "description": text,
    }
