"""Give robots a brain in Python: a class with `step(percept) -> command`.

Each rover gets one object of the class. It decides instead of the scenario's brain, in the same
steps and from the same percepts.
"""

import agent_economy as ae
from agent_economy.runs.brain import Body, Command, Percept

NEAR_M = 0.8
LOOKS_RAD = 0.6
LONGEST_TURN_S = 3.0


class Wanderer:
    """Drives straight, and turns for a random time in front of an obstacle."""

    def __init__(self, body: Body) -> None:
        """Store the body, which is constant during a run."""
        bearings_rad = body["rings"][0]["bearings_rad"]
        self.ahead = [ray for ray, rad in enumerate(bearings_rad) if abs(rad) < LOOKS_RAD]
        self.body = body
        self.turns_until_s = 0.0

    def step(self, percept: Percept) -> Command:
        """Return the command until the next step."""
        is_turning = percept["time_s"] < self.turns_until_s
        if not is_turning and self.is_blocked(percept):
            is_turning = True
            fraction = percept["random_words"][0] / 2**32  # the only source of randomness
            self.turns_until_s = percept["time_s"] + LONGEST_TURN_S * fraction
        return {
            "motion": {
                "speed_m_s": 0.0 if is_turning else self.body["max_speed_m_s"],
                "turn_rate_rad_s": self.body["max_turn_rate_rad_s"] if is_turning else 0.0,
            },
            "heading_rad": None,  # only for bodies that turn to a heading by themselves
            "requests": [],  # sensors to switch on or off
            "outbox": [],  # messages to other robots
        }

    def is_blocked(self, percept: Percept) -> bool:
        """Return whether something ahead is near; a ray that hits nothing has the range None."""
        ranges_m = percept["scans"][0]["ranges_m"]
        if not ranges_m:  # any part of a percept may be missing
            return True
        ahead = (ranges_m[ray] for ray in self.ahead)
        return any(range_m is not None and range_m < NEAR_M for range_m in ahead)


def main() -> None:
    """Compare it with the bundled brain."""
    outcome = ae.run("search", seed=7, run=2, brains={"rover": Wanderer})
    print(f"run 2: {outcome.status} after {outcome.time_s} s, {outcome.collisions} collisions")

    mine = ae.replicate("search", runs=20, seed=7, brains={"rover": Wanderer})
    bundled = ae.replicate("search", runs=20, seed=7)
    for name, table in {"mine": mine, "bundled": bundled}.items():
        found, collisions = (table[column].to_numpy().mean() for column in ("found", "collisions"))
        print(f"{name}: {found:.2f} of 4 found, {collisions:.2f} collisions per run")


if __name__ == "__main__":
    main()
