"""The topics that a drive adds to the recording of its run."""

from collections.abc import Mapping
from typing import Any

from agent_economy.recording.schemas import INTEGER, NUMBER, STRING, of_object

LIVE = "agent_economy.live"
"""Name of the metadata of a drive: its plan, the ordered waypoints and its start time."""

WIRE = "/wire/"
"""Prefix of the topics of lines: followed by the robot and the port."""

READINGS = "/reading/"
"""Prefix of the topics of readings: followed by the robot and the port."""

EVENTS, TICKS, SETPOINTS = "/live/events", "/live/ticks", "/live/setpoints"
ORDERS = "/live/orders"

_TIME = NUMBER | {"description": "Time since the machine was started."}
_ROBOT = STRING | {"description": "Name of the robot."}
_PORT = STRING | {"description": "Name of the port."}
_FAULTS = {"type": "array", "items": STRING}

_LINE = of_object(
    "agent_economy.Line",
    "A line that a robot sent (`line`), or that was written to it (`written`).",
    {
        "type": {"enum": ["line", "written"]},
        "robot": _ROBOT,
        "port": _PORT,
        "t": _TIME,
        "line": STRING | {"description": "Its bytes, as Latin-1. A written line has its end."},
    },
)

_READING = of_object(
    "agent_economy.Reading",
    "What a line measured: in SI units, in the frame of the world. It follows its line in /wire.",
    {
        "type": {"const": "reading"},
        "robot": _ROBOT,
        "port": _PORT,
        "t": _TIME,
        "quantity": {
            "enum": ["ranges", "heading", "position", "battery"],
            "description": "ranges: m, one per sonar. heading: rad, anticlockwise from the x axis "
            "of the world. position: x and y in m. battery: remaining share of the charge.",
        },
        "values": {
            "type": "array",
            "items": {"type": ["number", "null", "string"], "pattern": "^(-?inf|nan)$"},
            "description": 'Numbers; null where no value came, "inf" where a sonar sees nothing, '
            '"nan" for an impossible value.',
        },
    },
)

_SCHEMAS = {
    EVENTS: of_object(
        "agent_economy.RobotEvent",
        "A change of what the safety rules decide for a robot, with the reasons.",
        {
            "type": {"const": "event"},
            "t": _TIME,
            "robot": _ROBOT,
            "action": {"enum": ["move", "stop", "latched_stop"]},
            "mode": {"enum": ["auto", "manual"]},
            "is_armed": {"type": "boolean"},
            "is_confirmed": {"type": "boolean", "description": "Whether it is known to stand."},
            "unseen_speed_m_s": {
                "type": ["number", "null"],
                "description": "The fastest motion that a confirmed standstill does not exclude.",
            },
            "faults": _FAULTS | {"description": "What stops it now, with reasons."},
            "latched": _FAULTS | {"description": "Why it has to be armed."},
            "blockers": _FAULTS | {"description": "Why it cannot be armed."},
            "reasons": {"type": "object", "description": "Each of them with its values."},
            "warnings": _FAULTS | {"description": "What does not stop it."},
        },
    ),
    ORDERS: of_object(
        "agent_economy.Order",
        "A waypoint that an operator ordered; the brain receives it in its next percept.",
        {
            "type": {"const": "order"},
            "t": _TIME,
            "robot": _ROBOT,
            "at_m": {"type": "array", "items": NUMBER, "description": "Its place in the world."},
        },
    ),
    TICKS: of_object(
        "agent_economy.LiveTick",
        "The start of a step of the brains. The readings before it are what they know.",
        {
            "tick": INTEGER | {"description": "Number of steps taken."},
            "t": _TIME,
            "lateness_s": NUMBER | {"description": "Time by which it was late."},
            "behind_s": NUMBER | {"description": "Time by which the run is behind the clock."},
        },
    ),
    SETPOINTS: of_object(
        "agent_economy.Setpoints",
        "The setpoint of each robot.",
        {
            "tick": INTEGER | {"description": "Number of steps taken before it."},
            "motions": {
                "type": "object",
                "description": "Speed (m/s), turn rate (rad/s), heading to turn to (rad or null).",
            },
        },
    ),
}


def live_schema(topic: str) -> str:
    """Return the JSON Schema of a topic of a drive."""
    if topic.startswith(WIRE):
        return _LINE
    return _READING if topic.startswith(READINGS) else _SCHEMAS[topic]


def topic_of(message: Mapping[str, Any]) -> str:
    """Return the topic of a message of the warden."""
    match message["type"]:
        case "line" | "written":
            return f"{WIRE}{message['robot']}/{message['port']}"
        case "reading":
            return f"{READINGS}{message['robot']}/{message['port']}"
        case "order":
            return ORDERS
    return EVENTS
