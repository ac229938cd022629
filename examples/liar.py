"""A robot that lies: how far a team believes in a false item, and what false observations cost."""

from statistics import mean
from typing import Any

import agent_economy as ae

LIAR: dict[str, Any] = {
    "count": 1,
    "radius_m": 0.25,
    "start": {"kind": "fixed", "at_m": [[0.5, 0.5]]},
    "drive": {"max_speed_m_s": 1.0, "max_acceleration_m_s2": 1.0, "max_turn_rate_deg_s": 90.0},
    "radio": {"range_m": 100.0},
    "sensors": {
        "camera": {
            "kind": "items",
            "range_m": 4.0,
            "fov_deg": 360.0,
            "rate_hz": 5.0,
            "detection_probability": {"mine": 0.9},
        }
    },
    "brain": {"rate_hz": 5.0, "behaviours": []},
}
FALSE_ITEM_M = [12.0, 2.0]


class FalseItem:
    """Reports an item that does not exist, with invented observations of all its team mates."""

    def __init__(self, _body: Any) -> None:
        """Start counting."""
        self.steps = 0

    def step(self, _percept: Any) -> dict[str, Any]:
        """Report the item four times, each time as observed by another robot."""
        self.steps += 1
        outbox = []
        for index in range(4):
            observer = {"kind": 0, "index": index}
            behind = {"observer": observer, "track_id": self.steps, "observations": self.steps}
            item = {"kind": 0, "at": FALSE_ITEM_M, "provenance": behind}
            outbox.append({"about": {"item": item}, "confidence": 1.0})
        return {"outbox": outbox}


class FalseObservations:
    """Claims to have searched everywhere, where it never was."""

    def __init__(self, _body: Any) -> None:
        """Start counting."""
        self.steps = 0

    def step(self, _percept: Any) -> dict[str, Any]:
        """Claim a thousand observations at the next place."""
        self.steps += 1
        column, row = self.steps % 8, self.steps // 8 % 8
        place = [1.5 + 3.125 * column, 1.5 + 3.125 * row]
        sender = {"at": place, "heading_rad": 0.0, "observations": 1000 * self.steps}
        return {"outbox": [{"about": {"sender": sender}, "confidence": 1.0}]}


def with_liar(initial_trust: float) -> ae.Scenario:
    """Return the bundled search with a liar in a corner of the field."""
    scenario = ae.Scenario.load("search-beliefs")
    scenario = scenario.replace("robots.rover.brain.beliefs.trust", {"initial": initial_trust})
    return scenario.replace("robots.liar", LIAR)


def belief_in_false_item(initial_trust: float) -> float:
    """Return the strongest belief in the false item in ten seconds, of robots that do not move."""
    scenario = with_liar(initial_trust)
    scenario = scenario.replace("robots.rover.brain.behaviours", [{"kind": "hold_position"}])
    brains: Any = {"liar": FalseItem}
    simulation = ae.Simulation(scenario, seed=1, brains=brains)
    strongest = 0.0
    for _ in range(100):
        simulation.step()
        for robot in range(4):
            belief_state: Any = simulation.belief_state(f"rover/{robot}")
            for item in belief_state["items"]:
                if item["at"] == FALSE_ITEM_M:
                    strongest = max(strongest, item["confidence"])
    return strongest


def mean_time_s(brains: Any) -> float:
    """Return the mean time until all items are found, or the time limit."""
    runs = (ae.run(with_liar(0.9), seed=1, run=run, brains=brains) for run in range(30))
    return mean(run.time_s or 0.0 for run in runs)


for trust in (0.9, 0.5):
    print(f"trust {trust}: belief in the false item up to {belief_in_false_item(trust):.3f}")
print(f"without lies: {mean_time_s({}):.1f} s")
print(f"with false observations: {mean_time_s({'liar': FalseObservations}):.1f} s")
