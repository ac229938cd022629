"""JSON Schemas of the topics for which Foxglove has no schema."""

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

from agent_economy import _core

NUMBER = {"type": "number"}
INTEGER = {"type": "integer", "minimum": 0}
SIGNED = {"type": "integer"}
STRING = {"type": "string"}

Schema = Mapping[str, Any]


def of_object(title: str, description: str, properties: Mapping[str, Schema]) -> str:
    """Return the schema of an object with exactly these properties."""
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
    """Return the schema of a list with one entry per robot, goal or controller."""
    return {"type": "array", "items": kind, "description": description}


OF_ALL_ENGINES: dict[str, Schema] = {
    "tick": INTEGER | {"description": "Number of steps taken."},
    "hash": STRING | {"description": "Hash of the state: 64 bits, hexadecimal."},
    "changes": INTEGER | {"description": "Number of changes of the scenario."},
    "found": INTEGER | {"description": "Number of items found."},
}

RUN = of_object(
    "agent_economy.Run",
    "The progress of a run.",
    {
        **OF_ALL_ENGINES,
        "decisions": {
            "type": ["string", "null"],
            "description": "Hash of all percepts and commands until then: 64 bits, hexadecimal. "
            "Null if the run was restored to a state without one.",
        },
        "stopped": INTEGER | {"description": "Number of robots that are empty or broken."},
    },
)

CLASSIC_RUN = of_object(
    "agent_economy.ClassicRun",
    "The progress of a run of the classic engine.",
    {
        **OF_ALL_ENGINES,
        "carry": SIGNED
        | {"description": "The left-slow score that the next robot to decide starts with."},
        "decides_in": INTEGER
        | {"description": "Number of steps until the next decision of the team."},
    },
)

TEAM = of_object(
    "agent_economy.Team",
    "The robots, in the order of all lists with one entry per robot.",
    {
        "robots": each("Name, KIND/INDEX, which is also the name of the robot's frame.", STRING),
        "radius_m": each("Radius of the footprint."),
        "is_flying": each("Whether it flies.", {"type": "boolean"}),
    },
)

ROBOTS = of_object(
    "agent_economy.Robots",
    "The state of each robot.",
    {
        "x_m": each("Position of the centre."),
        "y_m": each("Position of the centre."),
        "heading_rad": each("Heading: 0 along x, anticlockwise, from -pi to pi."),
        "speed_m_s": each("Forward speed."),
        "commanded_speed_m_s": each("Forward speed commanded by the brain."),
        "commanded_turn_rate_rad_s": each("Turn rate commanded by the brain, anticlockwise."),
        "status": each("Status of the robot.", {"enum": ["active", "empty", "broken"]}),
        "battery": each("State of charge, 0 to 1; 1 for a battery without a limited capacity."),
        "collisions": each("Number of collisions.", INTEGER),
    },
)

CLASSIC_ROBOTS = of_object(
    "agent_economy.ClassicRobots",
    "The state of each robot of the classic engine; a cell is one metre wide.",
    {
        "x_m": each("Drawn position."),
        "y_m": each("Drawn position, upwards."),
        "heading_rad": each("Heading: 0 along x, anticlockwise, above -pi, up to pi."),
        "column": each("Column of its cell, to the right.", SIGNED),
        "row": each("Row of its cell, downwards.", SIGNED),
        "speed": each("Cells per decision.", SIGNED),
        "left_turns": each("Counter of left turns.", SIGNED),
        "right_turns": each("Counter of right turns.", SIGNED),
        "colour": each(
            "Colour since the last decision: yellow if something is near, red on a shared cell.",
            {"enum": ["blue", "yellow", "red"]},
        ),
    },
)

TEXT_OR_NULL = {"type": ["string", "null"]}
NUMBER_OR_NULL = {"type": ["number", "null"]}

STATES = ["later", "unowned", "open", "awarded", "lost", "served", "expired"]

OWNED: dict[str, Schema] = {
    "name": each("Name, KIND/INDEX.", STRING),
    "x_m": each("Position."),
    "y_m": each("Position."),
    "state": each("State; later: it has not arrived yet.", {"enum": STATES}),
    "owner": each("The controller that owns it, as far as that one knows.", TEXT_OR_NULL),
    "assignee": each("The robot that it is awarded to.", TEXT_OR_NULL),
    "lease_s": each("Remaining time of that robot's lease.", NUMBER_OR_NULL),
    "votes": each("The controllers that vote for its owner.", {"type": "array", "items": STRING}),
    "owner_lease_s": each("Remaining time for which a majority does.", NUMBER_OR_NULL),
    "unserved": each("Why no robot can serve it at present.", TEXT_OR_NULL),
}

CONTROLLERS: dict[str, Schema] = {
    "name": each("Name, KIND/INDEX.", STRING),
    "x_m": each("Position."),
    "y_m": each("Position."),
    "range_m": each("Range of the radio."),
    "working": each("Whether it sends and receives.", {"type": "boolean"}),
    "refused": each("Number of goals that it refused.", INTEGER),
}


def of_lists(properties: Mapping[str, Schema]) -> Schema:
    """Return the schema of a part with exactly these lists."""
    return {
        "type": "object",
        "properties": properties,
        "required": list(properties),
        "additionalProperties": False,
    }


ECONOMY = of_object(
    "agent_economy.Economy",
    "Goals and controllers; all lists of one part have the same order.",
    {"goals": of_lists(OWNED), "controllers": of_lists(CONTROLLERS)},
)

BOOLEAN_OR_NULL = {"type": ["boolean", "null"]}

CLEARED: Schema = {
    "type": "object",
    "properties": {"kind": STRING, "share": NUMBER, "low": NUMBER, "high": NUMBER},
    "required": ["kind", "share", "low", "high"],
    "additionalProperties": False,
}

LANE_RISKS: dict[str, Schema] = {
    "name": each("Name of the controller, KIND/INDEX.", STRING),
    "unmarked": each("Expected number of mines without a mark, as the controller believes."),
    "marked": each("Expected number of mines at marks."),
    "probability": each("Probability that at least one mine is left in the lane."),
    "statement_is_clear": each(
        "Whether it has declared the lane clear, or given it up.", BOOLEAN_OR_NULL
    ),
    "statement_risk": each("The probability at that time.", NUMBER_OR_NULL),
    "statement_at_s": each("That time, on its clock.", NUMBER_OR_NULL),
    "clearance": each(
        "For each kind of mines: the share that is cleared, as believed, and its interval.",
        {"type": "array", "items": CLEARED},
    ),
}

LANE = of_object(
    "agent_economy.Lane",
    "The remaining risk of a mined lane, and what controllers have stated about it.",
    {
        "mines_left": INTEGER | {"description": "The truth: mines that are not destroyed."},
        "controllers": of_lists(LANE_RISKS),
    },
)

VERDICTS = ["confirmed", "rejected", "isolated", "neutralised", None]

OF_LANE_MARKS: dict[str, Schema] = {
    "controller": each("The controller that believes it, KIND/INDEX.", STRING),
    "number": each("Its number, which never changes.", INTEGER),
    "x_m": each("Position."),
    "y_m": each("Position."),
    "deviation_m": each("Standard deviation of the position along each axis."),
    "mine": each("Probability that it holds a mine that has not been neutralised."),
    "verdict": each("The last statement about it.", {"enum": VERDICTS}),
    "failed_charges": each("Charges that have gone off there and destroyed nothing.", INTEGER),
}

LANE_MARKS = of_object(
    "agent_economy.LaneMarks",
    "The places that robots have marked, as each controller believes them to be.",
    {"marks": of_lists(OF_LANE_MARKS)},
)

LANE_PASSAGE = of_object(
    "agent_economy.LanePassage",
    "The path on which vehicles are to pass a mined lane, and the risk of each, as stated.",
    {
        "controller": STRING | {"description": "The controller that states it, KIND/INDEX."},
        "path_m": each("Corners of its middle line, x and y.", {"type": "array", "items": NUMBER}),
        "width_m": NUMBER | {"description": "Its width."},
        "length_m": NUMBER | {"description": "Its length."},
        "mines": NUMBER | {"description": "Expected number of mines within its width."},
        "risks": each("Probability that each vehicle is destroyed, in their order."),
    },
)

INPUT = of_object(
    "agent_economy.Input",
    "The external inputs of the next step, by robot name. A replay needs them.",
    {
        "tick": INTEGER | {"description": "Number of steps taken."},
        "percepts": {"type": "object", "description": "Percepts of external bodies."},
        "observed": {
            "type": "object",
            "description": "Percepts of external bodies whose brains do not step.",
        },
        "commands": {
            "type": "object",
            "description": "Commands that replace the decisions of brains.",
        },
    },
)

OUTCOME = json.dumps(
    {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "agent_economy.Outcome",
        "description": "The outcome of a run, by the columns of a table of runs.",
        "type": "object",
        "required": ["status"],
    }
)


@cache
def exchanged(name: str) -> str:
    """Return the schema of a message of brains: "Percept" or "Command"."""
    schema = _core.Brain.schemas()[name]
    return json.dumps(schema | {"title": f"agent_economy.{name}"})
