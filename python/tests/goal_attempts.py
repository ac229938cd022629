"""What becomes of the goals of a robot in a world: given up, or reached."""

import math
from dataclasses import dataclass, field

import numpy as np
from goal_worlds import TIME_LIMIT_S, Place, World, corners, distance_m, random_world

from agent_economy import Simulation
from agent_economy.types.brain import GoalState

OCCUPIED_PERCENT = 73
"""From this probability on, a cell is believed occupied."""

REACHED_M = 0.45
"""The arrival radius, plus the error of the position."""

PLANNED_S = 1.0
"""Time after which the first path to a goal is known: until then, a straight line is assumed."""

LENGTHENED_M = 0.1
"""A minimum path length that rises by more than this shows that the clock was restarted."""

PERIOD_S = 0.2
"""Time between two decisions."""


@dataclass
class Discoveries:
    """The cells that a robot has ever believed occupied."""

    last_s: float = -math.inf
    """When a cell was last believed occupied for the first time."""
    _ever: np.ndarray | None = None

    def observe(self, simulation: Simulation) -> None:
        """Note the time if a cell is believed occupied for the first time."""
        believed = simulation.believed_map("rover/0")
        if believed is None:
            return
        occupied = np.asarray(believed["occupancy"]) >= OCCUPIED_PERCENT
        ever = np.zeros_like(occupied) if self._ever is None else self._ever
        if (occupied & ~ever).any():
            self.last_s = simulation.time_s
        self._ever = ever | occupied


@dataclass
class Attempt:
    """What became of one goal; times in seconds."""

    at: Place
    began_s: float | None = None
    restarts_s: list[float] = field(default_factory=list)
    """Times at which the clock of its first attempt restarted because the path grew."""
    discoveries_s: list[float] = field(default_factory=list)
    """For each restart, when a cell was last believed occupied for the first time."""
    tried_s: list[float] = field(default_factory=list)
    given_up_s: list[float] = field(default_factory=list)
    reached_s: float | None = None
    _min_m: float = math.inf
    _is_tried: bool = False

    @property
    def patience_s(self) -> float:
        """Time from the last restart of the clock until it was given up first."""
        if self.began_s is None or not self.given_up_s:
            return math.inf
        return self.given_up_s[0] - max([self.began_s, *self.restarts_s])

    def attempts_s(self, until_s: float) -> list[float]:
        """Return how long the attempts were that failed before a time."""
        attempts = zip(self.tried_s, self.given_up_s, strict=False)
        return [given_up_s - tried_s for tried_s, given_up_s in attempts if given_up_s < until_s]

    @property
    def unfounded_restarts(self) -> int:
        """Number of restarts without a cell that was discovered since the one before."""
        before_s = [0.0, *self.restarts_s]
        pairs = zip(before_s, self.discoveries_s, strict=False)
        return sum(found_s < restart_s - PERIOD_S for restart_s, found_s in pairs)

    def observe(self, goal: GoalState, time_s: float, discoveries: Discoveries) -> None:
        """Take the state of the goal after a decision into account."""
        is_impossible = goal["verdict"] == "impossible"
        if is_impossible and self._is_tried:
            self.given_up_s.append(time_s)
        if goal["is_pursued"]:
            self._pursue(goal, time_s, discoveries)
        self._is_tried = goal["is_pursued"] or (self._is_tried and not is_impossible)

    def _pursue(self, goal: GoalState, time_s: float, discoveries: Discoveries) -> None:
        if not self._is_tried:
            self.tried_s.append(time_s)
        self.began_s = time_s if self.began_s is None else self.began_s
        min_m = goal["min_remaining_m"]
        is_planned = time_s - self.began_s > PLANNED_S
        if is_planned and not self.given_up_s and min_m > self._min_m + LENGTHENED_M:
            self.restarts_s.append(time_s)
            self.discoveries_s.append(discoveries.last_s)
        self._min_m = min_m


@dataclass
class Outcome:
    """What became of the goals of a world."""

    impossible: list[Attempt]
    possible: list[Attempt]

    @property
    def is_decided(self) -> bool:
        """Whether all unreachable goals were given up, and all others reached."""
        is_reached = all(attempt.reached_s is not None for attempt in self.possible)
        return is_reached and all(attempt.given_up_s for attempt in self.impossible)

    @property
    def end_s(self) -> float:
        """The time at which the last goal was reached; the time limit if one was not."""
        ends_s = (attempt.reached_s for attempt in self.possible)
        return max(TIME_LIMIT_S if end_s is None else end_s for end_s in ends_s)


def outcome(family: str, number: int, *, to_the_end: bool = False) -> Outcome:
    """Run a world until it is decided, or to the time limit."""
    world, scenario = random_world(family, number)
    simulation, discoveries = Simulation(scenario, seed=number), Discoveries()
    attempts = [Attempt(at) for at in world.waypoints]
    result = Outcome(attempts[: world.count], attempts[world.count :])
    while not simulation.is_over and (to_the_end or not result.is_decided):
        change(simulation, world)
        simulation.step(2)
        if result.impossible:
            discoveries.observe(simulation)
        observe(attempts, simulation, discoveries)
    return result


def change(simulation: Simulation, world: World) -> None:
    """Make the next change of a world if it is due, as soon as the robot is not in the way."""
    x, y = simulation.poses[0, :2]
    here = (float(x), float(y))
    due = world.changes[:1] if simulation.time_s >= world.next_change_s else []
    for _, boxes in due:
        if all(distance_m(here, box) > world.radius_m for box in boxes):
            simulation.change("world.obstacles", [{"polygon_m": corners(box)} for box in boxes])
            world.changes.pop(0)


def observe(attempts: list[Attempt], simulation: Simulation, discoveries: Discoveries) -> None:
    """Take the last decision of the robot into account."""
    state = simulation.belief_state("rover/0")
    here = simulation.poses[0, :2]
    for attempt in attempts:
        for goal in state["goals"] if state else []:
            if math.dist(goal["to"], attempt.at) < LENGTHENED_M:
                attempt.observe(goal, simulation.time_s, discoveries)
        if attempt.reached_s is None and math.dist(here, attempt.at) < REACHED_M:
            attempt.reached_s = simulation.time_s
