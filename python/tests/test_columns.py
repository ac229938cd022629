"""Messages of every type reach brains on arrays, and are sent by them."""

import json
import random
from pathlib import Path
from typing import Any

import pytest
from metric import world

from agent_economy import Batch, Scenario, Simulation
from agent_economy.runs.batch import Commands, Percepts

SCHEMAS = Path(__file__).resolve().parents[2] / "schemas/brain.schema.json"
TYPES: dict[str, Any] = json.loads(SCHEMAS.read_text(encoding="utf-8"))["$defs"]
MAX = {"uint8": 200, "uint16": 60_000, "uint32": 4_000_000_000}

TALKERS = world("""
clock.time_limit_s = 60
world.size_m = [20, 20]
items.mine = { target = false, count = 1 }
[robots.rover]
count = 3
radius_m = 0.2
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
radio = { range_m = 50, messages_per_step = 1000 }
""")


def resolved(schema: Any) -> Any:
    """Return the definition to which a schema refers."""
    target = schema.get("$ref")
    return TYPES[target.rsplit("/", 1)[-1]] if target else schema


def sample(schema: Any, chance: random.Random) -> Any:
    """Return a random value that a schema allows; numbers are exact in single precision."""
    schema = resolved(schema)
    if parts := schema.get("oneOf") or schema.get("anyOf"):
        return sample(chance.choice(parts), chance)
    if "const" in schema:
        return schema["const"]
    if schema["type"] == "array":
        return [sample(schema["items"], chance) for _ in range(schema["minItems"])]
    if schema["type"] != "object":
        return scalar(schema, chance)
    properties = schema.get("properties", {})
    value = {key: sample(each, chance) for key, each in properties.items()}
    # A robot has no role in messages.
    return {key: each for key, each in value.items() if (key, each) != ("role", "robot")}


def scalar(schema: Any, chance: random.Random) -> float | bool:
    """Return a random number or flag."""
    match schema["type"]:
        case "integer":
            return chance.randint(0, MAX[schema["format"]])
        case "number":
            return chance.randint(0, 4096) / 64
    return chance.random() < 0.5


UNIONS = {
    "contract": "ContractMessage",
    "lease": "LeaseMessage",
    "ownership": "OwnershipMessage",
    "lane": "LaneMessage",
}
"""The kinds of messages that are unions themselves, and their types."""


def kinds_of_messages() -> list[tuple[str, ...]]:
    """Return the path of each type of message."""
    return [
        (name, *inner)
        for part in TYPES["About"]["oneOf"]
        for name, content in part["properties"].items()
        for inner in (
            [(key,) for each in TYPES[UNIONS[name]]["oneOf"] for key in each["properties"]]
            if name in UNIONS
            else [()]
        )
    ]


def message(path: tuple[str, ...], chance: random.Random) -> dict[str, Any]:
    """Return a random message of a type."""
    about = sample(content_of(path), chance)
    if path == ("item",):
        about["kind"], about["kind_share"] = 0, 0.5
        about["provenance"]["observer"] = {"kind": 0, "index": 1}
    for key in reversed(path):
        about = {key: about}
    to = {"to": {"kind": 0, "index": chance.randint(0, 2)}} if chance.random() < 0.5 else {}
    return {**to, "about": about, "confidence": 0.5}


def content_of(path: tuple[str, ...]) -> Any:
    """Return the schema of the content of a type of message."""
    union = TYPES["About" if len(path) == 1 else UNIONS[path[0]]]
    return next(
        part["properties"][path[-1]] for part in union["oneOf"] if path[-1] in part["properties"]
    )


def talking(messages: list[dict[str, Any]], received_percepts: list[Percepts]) -> Batch:
    """Return a brain that sends messages in its first step."""

    def talk(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        received_percepts.append(percepts)
        if memory:
            return {}
        memory["has_sent"] = True
        return {"outbox": [{"row": 1, **each} for each in messages]}  # type: ignore[typeddict-item]

    return Batch(talk)


@pytest.mark.parametrize("seed", range(5))
def test_messages_of_all_types_are_sent_and_received_as_given(seed: int) -> None:
    chance = random.Random(seed)  # noqa: S311
    messages = [message(path, chance) for path in 3 * kinds_of_messages()]
    chance.shuffle(messages)
    received_percepts: list[Percepts] = []
    scenario = Scenario.loads(TALKERS)
    simulation = Simulation(scenario, brains={"rover": talking(messages, received_percepts)})
    simulation.step()
    sent = simulation.decided["rover/1"]["outbox"]
    assert sent == messages
    received = {index: simulation.percept(f"rover/{index}") for index in (0, 2)}
    simulation.step()
    inbox = received_percepts[-1]["inbox"]
    for index, percept in received.items():
        assert percept is not None
        assert len(percept["inbox"]) > 0
        mine = [each for each in inbox if each["row"] == index]
        assert mine == [{**each, "row": index} for each in percept["inbox"]]


BIDDERS = (
    TALKERS.replace("items.mine = { target = false, count = 1 }\n", "")
    + """
[robots.rover.brain]
behaviours = [{ kind = "serve" }]
[robots.rover.sensors]
gps = { kind = "position" }
compass = { kind = "heading" }
[goals.spot]
count = 1
placement = { kind = "fixed", at_m = [[10, 10]] }
[controllers.base]
count = 1
start = { kind = "fixed", at_m = [[5, 5]] }
radio = { range_m = 50 }
"""
)


def test_a_brain_on_arrays_bids_for_the_goal_of_a_controller_and_is_awarded_it() -> None:
    calls: list[float] = []
    awards: list[int] = []

    def bid(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        del memory
        bids: list[Any] = []
        for received in percepts["inbox"]:
            message = received["message"]["about"].get("contract", {})
            if "award" in message:
                awards.append(received["row"])
            if "call" in message:
                call = message["call"]
                calls.append(call["task"]["at_m"][0])
                content = {
                    "goal": call["task"]["id"],
                    "number": 7,
                    "time_s": 1.0 if received["row"] == 2 else 60.0,  # the last robot is the best
                    "total_s": 4.0,
                    "energy": 0.0,
                    "call": call["number"],
                }
                about = {"contract": {"bid": content}}
                bid = {"to": received["from"], "about": about, "confidence": 0.9}
                bids.append({"row": received["row"], **bid})
        return {"outbox": bids}

    Simulation(Scenario.loads(BIDDERS), brains={"rover": Batch(bid)}).step(40)
    assert set(calls) == {10.0}
    assert awards[:1] == [2]
