"""Recordings of the metric engine."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.recording import schemas
from agent_economy.recording.brain_topics import BrainTopics
from agent_economy.recording.clock import Clock
from agent_economy.recording.economy_topic import EconomyTopic
from agent_economy.recording.event_log import EventLog
from agent_economy.recording.fields import hash_text
from agent_economy.recording.file import File
from agent_economy.recording.foxglove import scene
from agent_economy.recording.inputs import ExternalInputs
from agent_economy.recording.item_scene import Items
from agent_economy.recording.lane_topics import LaneTopics
from agent_economy.recording.logged import Logged
from agent_economy.recording.robot_scene import BLUE, RED, YELLOW, Frames, robot
from agent_economy.recording.selection import Selection
from agent_economy.recording.static_scene import grid, still
from agent_economy.runs.brain import Command
from agent_economy.runs.simulation import STATUSES, Simulation

Moment = Mapping[str, Any]
"""The state of a run at one step: see `recorded_moment` of the compiled part."""

TOPICS = {
    "/run": schemas.RUN,
    "/team": schemas.TEAM,
    "/robots": schemas.ROBOTS,
    "/input": schemas.INPUT,
    "/outcome": schemas.OUTCOME,
}

PAINTS = {"active": BLUE, "empty": YELLOW, "broken": RED}
"""Colours of robots, by status."""

AIR_M = 1.5
"""Drawn height of a flying robot; the simulator has no heights."""


def moment_of(simulation: Simulation) -> Moment:
    """Return the state of a run at its current step."""
    return _core.recorded_moment(simulation._run)  # noqa: SLF001  (ours)


class MetricMoments:
    """The steps of a run until its scenario changes: see `engines.Moments`.

    A viewer that jumps in time displays the last message of each topic. Therefore, each message is
    complete, and rarely changing data has its own topic, which is written when the data changes.
    """

    def __init__(
        self,
        file: File,
        simulation: Simulation,
        percepts: Selection,
        logged: Logged,
        clock: Clock,
    ) -> None:
        """Write the static topics and the first step; see `engines.Engine`."""
        time_ns = clock.time_ns(simulation.tick)
        setting = _core.recorded_setting(simulation._run)  # noqa: SLF001  (ours)
        self._brains = BrainTopics(file, simulation, percepts, setting["bodies"])
        for topic, schema in TOPICS.items():
            file.declare(topic, schema)
        self._economy = EconomyTopic(file, simulation, logged.warnings)
        self._lane = LaneTopics(file, simulation)
        self._file, self._simulation, self._clock = file, simulation, clock
        self._changes = len(simulation.changes)
        self._names = simulation.robots
        self._frames = Frames(self._names)
        self._bodies = {name: setting[name].tolist() for name in ("radius_m", "is_flying")}
        document = simulation.scenario.to_dict()
        kinds = document.get("items", {})
        target = {name: kind.get("target", True) for name, kind in kinds.items()}
        self._items = Items(file, simulation.items, target, logged.finds)
        self._events = EventLog(file, simulation, clock, self._items, logged)
        self._last = moment_of(simulation)
        file.write_json("/team", {"robots": self._names, **self._bodies}, time_ns)
        file.write("/scene/world", scene(still(document, setting["shapes"]), time_ns), time_ns)
        for number, given in enumerate(setting["maps"]):
            file.write(f"/map/{number}", grid(given, time_ns), time_ns)
        self._write_bodies(self._last, time_ns)
        self._items.write_all(self._last["found_s"], time_ns)
        self._write_numbers(self._last, time_ns)

    @property
    def tick(self) -> int:
        """Tick of the step written last."""
        return int(self._last["tick"])

    @property
    def hash(self) -> int:
        """Hash of the step written last."""
        return int(self._last["hash"])

    @property
    def decision_hash(self) -> int | None:
        """Hash of the decisions until then; None if they are not hashed."""
        decisions: int | None = self._last["decisions"]
        return decisions

    def step(self, steps: int, inputs: ExternalInputs) -> dict[str, Command]:
        """Advance as `Simulation.step` does, and write the external inputs."""
        return self._brains.step(steps, inputs, self._clock.time_ns(self._simulation.tick))

    def log_events(self) -> None:
        """Write the events since the last call to the log, each at its own time."""
        self._events.write()

    def write(self) -> None:
        """Write the current step, and the events since the last call."""
        before, self._last = self._last, moment_of(self._simulation)
        moment, time_ns = self._last, self._clock.time_ns(self.tick)
        self._events.write(until=self.tick - 1)
        self._write_numbers(moment, time_ns)
        if (moment["status"] != before["status"]).any():
            self._write_bodies(moment, time_ns)
        self._items.write_finds(moment["found_s"], time_ns)
        self._events.write()

    def close(self) -> None:
        """Collect no more events: nothing will be written."""
        self._events.close()

    def _write_numbers(self, moment: Moment, time_ns: int) -> None:
        poses, half_turns = moment["poses"], moment["half_turns"]
        self._file.write("/tf", self._frames.at(time_ns, poses, half_turns), time_ns)
        self._file.write_json("/robots", states(moment), time_ns)
        run = {
            "tick": moment["tick"],
            "hash": hash_text(self.hash),
            "decisions": None if self.decision_hash is None else hash_text(self.decision_hash),
            "changes": self._changes,
            "found": int(np.isfinite(moment["found_s"]).sum()),
            "stopped": int((moment["status"] != 0).sum()),
        }
        self._file.write_json("/run", run, time_ns)
        self._economy.write(time_ns)
        self._lane.write(time_ns)

    def _write_bodies(self, moment: Moment, time_ns: int) -> None:
        rows = zip(self._names, STATUSES[moment["status"]], *self._bodies.values(), strict=True)
        bodies = [
            robot(name, PAINTS[status], radius_m, AIR_M if is_flying else 0)
            for name, status, radius_m, is_flying in rows
        ]
        self._file.write("/scene/robots", scene(bodies, time_ns), time_ns)


def errors(simulation: Simulation, percepts: Sequence[str]) -> list[str]:
    """Return the errors of the names of robots whose percepts are to be recorded."""
    unknown = set(percepts) - set(simulation.robots)
    if not unknown:
        return []
    team = simulation.robots
    names = ", ".join(sorted(map(repr, unknown)))
    robots = f"robots: {team[0]} to {team[-1]}" if team else "robots, and it has none"
    return [f"percepts: {names}: must be among the run's {robots}"]


def states(moment: Moment) -> dict[str, list[Any]]:
    """Return the state of each robot, as lists."""
    x_m, y_m, heading_rad = moment["poses"].T.tolist()
    speed_m_s, turn_rate_rad_s = moment["commanded"].T.tolist()
    return {
        "x_m": x_m,
        "y_m": y_m,
        "heading_rad": heading_rad,
        "speed_m_s": moment["speeds"].tolist(),
        "commanded_speed_m_s": speed_m_s,
        "commanded_turn_rate_rad_s": turn_rate_rad_s,
        "status": STATUSES[moment["status"]].tolist(),
        "battery": moment["battery"].tolist(),
        "collisions": moment["collisions"].tolist(),
    }
