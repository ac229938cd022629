"""A drive without an operator at a screen: when it arms its robots, and when it is over."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from agent_economy.live.rules import Decision
from agent_economy.live.rules.faults import EMERGENCY_STOP
from agent_economy.live.warden.endings import End

READY_S = 30.0
"""A robot that cannot be armed for this time after the start is left out."""

COMPLETE, IMPOSSIBLE = "complete", "impossible"

Verdicts = Mapping[str, Mapping[str, str]]
"""The verdict of each goal, by robot and goal; absent until the first report."""


@dataclass
class Mission:
    """Arms each robot once, as soon as nothing speaks against it.

    Attributes:
        robots: The names of all robots.
        began_s: When it began.
    """

    robots: tuple[str, ...]
    began_s: float
    _armed: set[str] = field(default_factory=set)

    def to_arm(self, decisions: Mapping[str, Decision]) -> frozenset[str]:
        """Return the robots to arm now."""
        self._armed |= {name for name, each in decisions.items() if each.is_armed}
        ready = {name for name, each in decisions.items() if not each.blockers}
        return frozenset(ready - self._armed)

    def end(
        self, decisions: Mapping[str, Decision], verdicts: Verdicts, now_s: float
    ) -> End | None:
        """Return how the drive ends now, or None if a robot is still driving."""
        ends = [self._end_of(name, decisions[name], verdicts, now_s) for name in self.robots]
        gravest = (End.STOPPED, End.NOT_READY, End.UNFINISHED, End.DONE)
        return None if None in ends else next(end for end in gravest if end in ends)

    def _end_of(
        self, name: str, decision: Decision, verdicts: Verdicts, now_s: float
    ) -> End | None:
        if EMERGENCY_STOP in decision.latched:
            return End.STOPPED
        if name not in self._armed:
            return End.NOT_READY if now_s - self.began_s > READY_S else None
        if not decision.is_armed:
            return End.STOPPED
        goals = verdicts.get(name)
        if not goals or any(each not in (COMPLETE, IMPOSSIBLE) for each in goals.values()):
            return None
        return End.UNFINISHED if IMPOSSIBLE in goals.values() else End.DONE
