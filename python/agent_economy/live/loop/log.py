"""The recording of a drive: the run, and everything that was received, written and decided."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.live.fleet import Fleet
from agent_economy.recording import Recording
from agent_economy.recording.file import strict
from agent_economy.recording.live_topics import (
    LIVE,
    SETPOINTS,
    TICKS,
    live_schema,
    topic_of,
)
from agent_economy.recording.output import create_new
from agent_economy.recording.selection import Selection
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.simulation import Simulation

FLUSH_S = 0.5
"""Time that a kill of the process loses at most, besides that of the last tick."""


@dataclass(frozen=True)
class LogOptions:
    """How a drive is recorded.

    Attributes:
        path: The file, NAME.mcap.
        is_numbered: Whether NAME-2, NAME-3 and so on are used if it exists.
        every: Number of steps per recorded state, 1 or more; also of percepts, commands and scans.
            What a replay needs is recorded in each step.
    """

    path: Path
    is_numbered: bool = False
    every: int = 1


class Log:
    """Steps a run and records it, with the lines of robots and the reactions of the warden.

    Attributes:
        path: The file, which did not exist before.
    """

    def __init__(
        self, simulation: Simulation, options: LogOptions, fleet: Fleet, start_s: float
    ) -> None:
        """Start a recording.

        Raises:
            InputError: If the file exists, has the wrong suffix, or cannot be written.
        """
        plan = fleet.plan
        self.path = create_new(options.path, is_numbered=options.is_numbered)
        robots = tuple(each.name for each in plan.robots)
        selection = Selection(robots, options.every)
        try:
            self._recording = Recording(
                simulation, self.path, every=options.every, percepts=selection, flush_s=FLUSH_S
            )
        except InputError:
            self.path.unlink()
            raise
        self._start_s = start_s
        self._recording.note_values(
            LIVE,
            {
                "plan": json.dumps(plan.to_dict()),
                "waypoints_m": json.dumps(strict(fleet.waypoints_m)),
                "start_s": repr(start_s),
            },
        )

    def add(self, message: Mapping[str, Any]) -> None:
        """Record a message of the warden."""
        at_s, topic = message["t"], topic_of(message)
        self._recording.write_json(topic, live_schema(topic), message, at_s - self._start_s)

    def tick(self, tick: int, now_s: float, lateness_s: float, behind_s: float = 0.0) -> None:
        """Record that a tick begins."""
        # In microseconds: noise does not compress.
        behind_s = round(behind_s, 6)
        values = {"tick": tick, "t": now_s, "lateness_s": lateness_s, "behind_s": behind_s}
        topic = TICKS
        self._recording.write_json(topic, live_schema(topic), values, now_s - self._start_s)

    def step(
        self, percepts: Mapping[str, Percept], observed: Mapping[str, Percept] | None = None
    ) -> dict[str, Command]:
        """Take a step of the run."""
        return self._recording.step(percepts=percepts, observed=observed)

    def setpoints(
        self, tick: int, motions: Mapping[str, Sequence[float | None]], now_s: float
    ) -> None:
        """Record the setpoints of a tick."""
        topic = SETPOINTS
        values = {"tick": tick, "motions": motions}
        self._recording.write_json(topic, live_schema(topic), values, now_s - self._start_s)

    def close(self) -> None:
        """Close the recording."""
        self._recording.close()

    def discard(self) -> None:
        """Close and remove the recording of a drive that has not begun: its name is free again."""
        self._recording.close()
        self.path.unlink(missing_ok=True)
