"""JSON Schemas of what recordings hold that Foxglove has no schema for."""

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from agent_economy import _core

NUMBER = {"type": "number"}
INTEGER = {"type": "integer", "minimum": 0}
SIGNED = {"type": "integer"}
TEXT = {"type": "string"}

Schema = Mapping[str, Any]


def of_object(title: str, description: str, properties: Mapping[str, Schema]) -> str:
    """Return the schema of an object that has all of these properties and no others."""
    return json.dumps(
        {
            "$schema": "https://json-schema.org/draft/2020-12/schema",
            "title": title,
            "description": description,
            "type": "object",
            "properties": properties,
            "required": list(properties),
            "additionalProperties": False,
        }
    )


def each(description: str, kind: Schema = NUMBER) -> Schema:
    """Return the schema of a list with an entry a robot."""
    return {"type": "array", "items": kind, "description": description}


OF_ALL_RUNS: dict[str, Schema] = {
    "tick": INTEGER | {"description": "Steps that have been taken."},
    "hash": TEXT | {"description": "Tells states apart: 64 bits, hexadecimal."},
    "changes": INTEGER | {"description": "Changes of the scenario so far."},
    "found": INTEGER | {"description": "Items found so far."},
}

RUN = of_object(
    "agent_economy.Run",
    "Where a run is.",
    {**OF_ALL_RUNS, "stopped": INTEGER | {"description": "Robots that cannot go on."}},
)

CLASSIC_RUN = of_object(
    "agent_economy.ClassicRun",
    "Where a run of the classic engine is.",
    {
        **OF_ALL_RUNS,
        "carry": SIGNED | {"description": "The score with which the next robot begins to decide."},
        "decides_in": INTEGER | {"description": "Steps until the team decides next."},
    },
)

TEAM = of_object(
    "agent_economy.Team",
    "The robots, in the order of all lists of robots.",
    {
        "robots": each("KIND/INDEX, which is also the name of the robot's frame.", TEXT),
        "radius_m": each("Of the disc that it covers."),
        "is_flying": each("Whether it is in the air.", {"type": "boolean"}),
    },
)

ROBOTS = of_object(
    "agent_economy.Robots",
    "How each robot is.",
    {
        "x_m": each("Where its centre is."),
        "y_m": each("Where its centre is."),
        "heading_rad": each("Its course: 0 along x, anticlockwise, from -pi to pi."),
        "speed_m_s": each("Ahead."),
        "wanted_speed_m_s": each("What its brain wants."),
        "wanted_turn_rate_rad_s": each("What its brain wants, anticlockwise."),
        "status": each("Whether it can go on.", {"enum": ["active", "empty", "broken"]}),
        "battery": each("Share that is left; 1 if it never empties."),
        "collisions": each("New contacts that it has had.", INTEGER),
    },
)

CLASSIC_ROBOTS = of_object(
    "agent_economy.ClassicRobots",
    "How each robot of the classic engine is; a cell is a metre.",
    {
        "x_m": each("Where it is drawn."),
        "y_m": each("Where it is drawn, upwards."),
        "heading_rad": each("Where it goes: 0 along x, anticlockwise, above -pi, to pi."),
        "column": each("Of its cell, to the right.", SIGNED),
        "row": each("Of its cell, downwards.", SIGNED),
        "speed": each("Cells a decision.", SIGNED),
        "left_turns": each("As far as they count.", SIGNED),
        "right_turns": each("As far as they count.", SIGNED),
        "colour": each(
            "Since the last decision: yellow if something is near, red if on a shared cell.",
            {"enum": ["blue", "yellow", "red"]},
        ),
    },
)

INPUT = of_object(
    "agent_economy.Input",
    "What came into the next step from outside, by robots: without it there is no replay.",
    {
        "tick": INTEGER | {"description": "Steps that had been taken."},
        "percepts": {"type": "object", "description": "Of robots whose bodies are outside."},
        "commands": {"type": "object", "description": "Instead of what brains would decide."},
    },
)

OUTCOME = json.dumps(
    {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "agent_economy.Outcome",
        "description": "What a run has given, by the columns of a table of runs.",
        "type": "object",
        "required": ["status"],
    }
)


@cache
def exchanged(name: str) -> str:
    """Return the schema of what enters or leaves a brain: "Percept" or "Command"."""
    schema = _core.Brain.schemas()[name]
    return json.dumps(schema | {"title": f"agent_economy.{name}"})
