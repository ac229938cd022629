"""Give all robots of a kind one brain: a function on arrays, many times as fast as a class.

The rule is that of `brain_in_python.py`, and so is the run, to the last bit.
"""

from typing import Any

import numpy as np

import agent_economy as ae
from agent_economy.runs.batch import Commands, Percepts
from brain_in_python import LONGEST_TURN_S, LOOKS_RAD, NEAR_M, Wanderer


def wander(percepts: Percepts, memory: dict[str, Any]) -> Commands:
    """Return what all robots that step now are to do; each array has an entry for each of them."""
    body, robots = percepts["body"], percepts["robots"]
    if not memory:  # a run begins
        bearings_rad = np.asarray(body["rings"][0]["bearings_rad"])
        memory["ahead"] = np.abs(bearings_rad) < LOOKS_RAD
        memory["turns_until_s"] = np.zeros(percepts["count"])
    turns_until_s = memory["turns_until_s"]

    scan = percepts["scans"][0]
    is_near = (scan["ranges_m"][:, memory["ahead"]] < NEAR_M).any(axis=1)
    is_blocked = is_near | np.isnan(scan["age_s"])  # what is missing is NaN
    is_turning = percepts["time_s"] < turns_until_s[robots]
    begins = is_blocked & ~is_turning
    luck = percepts["random_words"][begins, 0] / 2**32
    turns_until_s[robots[begins]] = percepts["time_s"] + LONGEST_TURN_S * luck
    is_turning |= begins
    return {
        "motion": {
            "speed_m_s": np.where(is_turning, 0.0, body["max_speed_m_s"]),
            "turn_rate_rad_s": np.where(is_turning, body["max_turn_rate_rad_s"], 0.0),
        }
    }


def main() -> None:
    """Take the same run both ways."""
    field = ae.Scenario.load("search").replace("world.size_m", [100, 100])
    field = field.replace("robots.rover.count", 200)
    batch = ae.Simulation(field, seed=7, brains={"rover": ae.Batch(wander)})
    each = ae.Simulation(field, seed=7, brains={"rover": Wanderer})
    outcome = batch.finish()
    print(f"200 rovers: {outcome.status} after {outcome.time_s} s")
    print(f"the same as a class for each: {each.finish() == outcome and each.hash == batch.hash}")


if __name__ == "__main__":
    main()
