"""Waypoints that a team shares, as its radio messages show them. It reads no clock.

A robot announces the waypoint that it goes to, again every few seconds, and the ones that it has
reached. What is known here is what each robot of the team can know.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

MAX_AGE_S = 10.0
"""A claim, and a robot, that was not confirmed for this time does not count: as in the brain."""


@dataclass
class Claim:
    """A waypoint that a robot goes to, and when it last announced it."""

    goal: int
    at_s: float


@dataclass
class SharedWaypoints:
    """The waypoints of the robots of one kind.

    Attributes:
        waypoints_m: The waypoints.
        robots: The names of the team's real robots, by index.
        is_whole: Whether they are the whole team. Messages of simulated robots are not seen here.
    """

    waypoints_m: list[list[float]]
    robots: tuple[str, ...]
    is_whole: bool = True
    _claims: dict[str, Claim] = field(default_factory=dict)
    _served: dict[int, str] = field(default_factory=dict)
    _given_up: dict[int, set[str]] = field(default_factory=dict)
    _sent_s: dict[str, float] = field(default_factory=dict)

    def add(self, robot: str, outbox: Iterable[Mapping[str, Any]], now_s: float) -> None:
        """Take the messages that a robot sends."""
        for message in outbox:
            self._sent_s[robot] = now_s
            about = message["about"].get("goal")
            if about is not None and self._is_ours(about):
                self._note(robot, about["id"]["number"], about["status"], now_s)

    def verdicts(self, now_s: float) -> Iterator[dict[str, Any]]:
        """Yield the place, the verdict and the robot of each waypoint, in order.

        One that every robot has given up is impossible, also while one tries it again.
        """
        claims = self._valid_claims(now_s)
        senders = self._sent_s.keys() - self.silent(now_s)
        for number, place in enumerate(self.waypoints_m):
            verdict, robot = "pending", None
            if number in self._served:
                verdict, robot = "complete", self._served[number]
            elif self.is_whole and senders and senders <= self._given_up.get(number, set()):
                verdict = "impossible"
            elif number in claims:
                verdict, robot = "approaching", claims[number]
            yield {"at_m": place, "verdict": verdict, "served_by": robot}

    def silent(self, now_s: float) -> set[str]:
        """Return the robots that have sent something, but nothing for some time."""
        return {name for name, at_s in self._sent_s.items() if now_s - at_s > MAX_AGE_S}

    def _is_ours(self, about: Mapping[str, Any]) -> bool:
        number = about["id"]["number"]
        return number < len(self.waypoints_m) and list(about["at"]) == self.waypoints_m[number]

    def _valid_claims(self, now_s: float) -> dict[int, str]:
        """Return the robot that goes to each claimed waypoint: of several, the first."""
        return {
            claim.goal: robot
            for robot, claim in sorted(self._claims.items(), reverse=True)
            if now_s - claim.at_s <= MAX_AGE_S
        }

    def _note(self, robot: str, goal: int, status: str, now_s: float) -> None:
        claim = self._claims.get(robot)
        if status == "done":
            self._served.setdefault(goal, robot)
        # A new destination implies that the one before is released.
        if claim is not None and (claim.goal == goal) != (status == "active"):
            del self._claims[robot]
            # A robot also releases a waypoint that another one goes to: it has not failed.
            if claim.goal not in self._valid_claims(now_s):
                self._given_up.setdefault(claim.goal, set()).add(robot)
        if status == "active":
            self._claims[robot] = Claim(goal, now_s)


def shared_by(scenario: Mapping[str, Any], robots: Iterable[str]) -> Iterator[SharedWaypoints]:
    """Yield the waypoints of each kind of a scenario whose real robots share some."""
    names = list(robots)
    for kind, table in scenario["robots"].items():
        own = tuple(name for name in names if name.rpartition("/")[0] == kind)
        for behaviour in table.get("brain", {}).get("behaviours", []):
            is_shared = behaviour.get("assignment") == "shared"
            if own and behaviour["kind"] == "navigate" and is_shared:
                places = [[float(x), float(y)] for x, y in behaviour.get("waypoints_m", [])]
                yield SharedWaypoints(places, own, is_whole=len(own) == table["count"])
