"""A person's orders reach the brain by messages, and each assigned goal has its verdict."""

import math
from typing import Any

import pytest
from metric import world

from agent_economy import Batch, Brain, InputError, Scenario, Simulation
from agent_economy.runs.batch import Commands, Percepts

OPERATOR = {"role": "person", "kind": 0, "index": 0}

SCENARIO = world("""
clock.time_limit_s = 600
world.size_m = [20, 20]
[robots.rover]
radius_m = 0.25
count = 2
start = { kind = "fixed", at_m = [[2, 2], [2, 6]], heading_deg = [0, 0] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
sensors = { gps = { kind = "position", noise_m = 0.1 }, compass.kind = "heading" }
brain.behaviours = [{ kind = "cruise" }, { kind = "correct", stop_when_done = true }]
""")


def order(number: int, at: tuple[float, float], action: str = "assign") -> dict[str, Any]:
    """Return the received message of an order."""
    goal = {"issuer": OPERATOR, "number": number}
    about = {"order": {"goal": goal, "at": list(at), "action": action}}
    return {"from": OPERATOR, "age_s": 0.0, "message": {"about": about, "confidence": 1.0}}


class Body:
    """An external body of the first rover, which executes its commands."""

    def __init__(self, scenario: Scenario | None = None) -> None:
        """Create it at (2, 2), heading along x."""
        self.simulation = Simulation(scenario or Scenario.loads(SCENARIO), seed=1)
        self.x_m, self.y_m, self.heading_rad = 2.0, 2.0, 0.0

    def step(self, *inbox: dict[str, Any]) -> None:
        """Step with the messages of a person."""
        percept: Any = {
            "time_s": self.simulation.time_s,
            "position": {"value": [self.x_m, self.y_m], "age_s": 0.0},
            "heading_rad": {"value": self.heading_rad, "age_s": 0.0},
            "inbox": list(inbox),
        }
        motion = self.simulation.step(percepts={"rover/0": percept})["rover/0"]["motion"]
        self.heading_rad += 0.1 * motion["turn_rate_rad_s"]
        self.x_m += 0.1 * motion["speed_m_s"] * math.cos(self.heading_rad)
        self.y_m += 0.1 * motion["speed_m_s"] * math.sin(self.heading_rad)

    def verdicts(self) -> list[tuple[int, str]]:
        """Return the number and verdict of each assigned goal."""
        goals = self.simulation.assigned_goals("rover/0")
        return [(goal["id"]["number"], goal["verdict"]) for goal in goals]


def test_a_person_sends_a_running_robot_from_place_to_place() -> None:
    body = Body()
    body.step(order(4, (8.0, 2.0)), order(2, (8.0, 6.0)))
    assert body.verdicts() == [(4, "approaching"), (2, "pending")]
    assert body.simulation.assigned_goals("rover/0")[0] == {
        "id": {"issuer": OPERATOR, "number": 4},
        "at": [8.0, 2.0],
        "verdict": "approaching",
        "reason": None,
    }
    for _ in range(300):
        body.step()
    assert body.verdicts() == [(4, "complete"), (2, "complete")]
    assert math.dist((body.x_m, body.y_m), (8.0, 6.0)) < 0.6
    body.step(order(4, (0.0, 0.0), "withdraw"))
    assert body.verdicts() == [(2, "complete")]
    assert body.simulation.assigned_goals("rover/1") == []


def test_a_snapshot_contains_the_assigned_goals() -> None:
    body = Body()
    body.step(order(1, (8.0, 2.0)))
    snapshot = body.simulation.snapshot()
    body.step(order(1, (8.0, 2.0), "withdraw"))
    assert body.verdicts() == []
    body.simulation.restore(snapshot)
    assert body.verdicts() == [(1, "approaching")]


def test_without_orders_a_robot_that_stops_when_done_stays_where_it_is() -> None:
    simulation = Simulation(Scenario.loads(SCENARIO), seed=1)
    simulation.step(100)
    assert simulation.assigned_goals("rover/0") == []
    assert simulation.poses[0].tolist()[:2] == [2.0, 2.0]


def test_an_order_from_another_sender_is_ignored_and_one_of_an_unknown_kind_is_an_error() -> None:
    body = Body()
    for sender in ({"kind": 0, "index": 1}, {"role": "person", "kind": 0, "index": 1}):
        body.step({**order(1, (8.0, 2.0)), "from": sender})
    assert body.verdicts() == []
    with pytest.raises(InputError, match=r"inbox\[0\].from.kind = 7: must be a number"):
        body.step({**order(1, (8.0, 2.0)), "from": {"kind": 7, "index": 0}})


@pytest.mark.parametrize(
    ("change", "expected"),
    [
        ({"action": "go"}, 'order.action = "go": must be one of "assign", "withdraw"'),
        ({"at": [1.0]}, "order.at"),
        ({"at": [math.nan, 1.0]}, r"order.at[0] = nan: must be"),
        ({"goal": {"number": 1}}, "order.goal.issuer is missing"),
        ({"goal": {"issuer": OPERATOR, "number": -1}}, "order.goal.number = -1: must be a whole"),
        ({"speed": 1}, "order.speed is not a known key: expected one of goal, at, action"),
    ],
)
def test_an_error_of_an_order_names_its_path_and_what_is_allowed(
    change: dict[str, Any], expected: str
) -> None:
    received = order(1, (8.0, 2.0))
    received["message"]["about"]["order"].update(change)
    with pytest.raises(InputError) as caught:
        Body().step(received)
    assert expected in str(caught.value)


def test_a_brain_of_ones_own_takes_orders_too() -> None:
    brain = Brain.of(Scenario.loads(SCENARIO), "rover")
    percept: Any = {
        "position": {"value": [1.0, 1.0], "age_s": 0.0},
        "heading_rad": {"value": 0.0, "age_s": 0.0},
        "inbox": [order(1, (5.0, 1.0))],
    }
    assert brain.assigned_goals() == []
    assert brain.step(percept)["motion"]["speed_m_s"] > 0
    assert [goal["verdict"] for goal in brain.assigned_goals()] == ["approaching"]


def test_no_robot_can_forge_an_order() -> None:
    class Forger:
        def __init__(self, body: object) -> None:
            del body

        def step(self, percept: object) -> Any:
            del percept
            outbox = [order(1, (8.0, 2.0))["message"]]
            return {"motion": {"speed_m_s": 0, "turn_rate_rad_s": 0}, "outbox": outbox}

    text = """radio.range_m = 50
[robots.forger]
radius_m = 0.2
count = 1
radio.range_m = 50
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
"""
    simulation = Simulation(Scenario.loads(SCENARIO + text), seed=1, brains={"forger": Forger})
    simulation.step(50)
    assert simulation.percept("rover/0")["inbox"]  # type: ignore[index]
    assert simulation.assigned_goals("rover/0") == []


def still(percepts: Percepts, memory: dict[str, Any]) -> Commands:
    """Return commands to stand."""
    del percepts, memory
    return {"motion": {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}}


def test_an_unknown_robot_is_an_error_and_a_python_brain_has_no_assigned_goals() -> None:
    with pytest.raises(InputError, match="rover/9"):
        Simulation(Scenario.loads(SCENARIO)).assigned_goals("rover/9")
    simulation = Simulation("search", brains={"rover": Batch(still)})
    assert simulation.assigned_goals("rover/0") == []
