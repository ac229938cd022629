"""Verifies a recorded drive bit for bit: lines to readings, to percepts, to setpoints."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from agent_economy.live.line_readings import LineReadings
from agent_economy.live.loop.team import Team
from agent_economy.live.plan import FleetPlan
from agent_economy.recording.file import strict
from agent_economy.recording.live_topics import READINGS, SETPOINTS, TICKS
from agent_economy.runs.simulation import Simulation

INPUT = "/input"
"""The topic of the percepts that the run took."""

NO_INPUTS: Mapping[str, Any] = {"percepts": {}, "observed": {}}

Messages = Sequence[tuple[str, dict[str, Any]]]
"""Messages of a recording with their topics, in the order in which the loop took them."""


@dataclass(frozen=True)
class Mismatch:
    """The first step at which a recording is not reproduced, and what differs there."""

    tick: int
    what: str


class Verification:
    """Steps the run of a drive again, and compares everything with its recording.

    Recordings of earlier versions have no readings: theirs are made of the lines.
    """

    def __init__(
        self, plan: FleetPlan, team: Team, simulation: Simulation, messages: Messages
    ) -> None:
        """Create it at the first step."""
        self._team, self._simulation, self._messages = team, simulation, messages
        self._lines = LineReadings(plan)
        self._has_readings = any(topic.startswith(READINGS) for topic, _ in messages)
        self._inputs = {m["tick"]: _given(m) for topic, m in messages if topic == INPUT}
        self._motions = {m["tick"]: m["motions"] for topic, m in messages if topic == SETPOINTS}

    def run(self, steps: int) -> Mismatch | None:
        """Replay a number of steps; return the first mismatch, None without one."""
        found = None
        for topic, message in self._messages:
            tick = self._simulation.tick
            if topic != TICKS:
                what = self._take(topic, message)
            elif message["tick"] < steps:
                what = self._step(int(message["tick"]), message["t"])
            else:  # the file is truncated
                break
            if what and found is None:
                found = Mismatch(tick, what)
        return found

    def _step(self, tick: int, now_s: float) -> str:
        """Take a step; return what differs, in words."""
        percepts = self._team.percepts(tick, now_s)
        observed = self._team.observed(tick, now_s) if self._has_readings else {}
        commands = self._simulation.step(percepts=percepts, observed=observed)
        motions = self._team.motions(commands)
        given = strict({"percepts": percepts, "observed": observed})
        differ = {
            "percepts": given != self._inputs.get(tick, NO_INPUTS),
            "setpoints": strict(motions) != self._motions.get(tick),
        }
        return " and ".join(what for what, differs in differ.items() if differs)

    def _take(self, topic: str, message: Mapping[str, Any]) -> str:
        """Take a message between two steps; return what differs, in words."""
        is_line = message.get("type") == "line"
        if is_line and not self._has_readings:
            reading = self._lines.of(message)
            if reading is not None:
                self._team.add(reading)
        elif is_line or topic.startswith(READINGS):
            agree = self._lines.agree(message)
            self._team.add(message)
            return "" if agree else "readings"
        elif topic not in (INPUT, SETPOINTS):
            self._team.add(message)
        return ""


def _given(message: Mapping[str, Any]) -> dict[str, Any]:
    """Return the recorded percepts; older recordings have none of robots that only stood."""
    return {"percepts": message["percepts"], "observed": message.get("observed", {})}
