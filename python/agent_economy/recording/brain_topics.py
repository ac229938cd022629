"""The topics of selected robots: their percepts, commands and scans."""

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.recording import schemas
from agent_economy.recording.file import File, strict
from agent_economy.recording.foxglove import SECOND_NS, scan
from agent_economy.recording.inputs import ExternalInputs
from agent_economy.recording.selection import Selection
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.simulation import Simulation


class BrainTopics:
    """Writes the percepts and commands of selected robots, in each step or in each n-th."""

    def __init__(
        self,
        file: File,
        simulation: Simulation,
        selected: Selection,
        bodies: Mapping[str, Mapping[str, Any]],
    ) -> None:
        """Declare the topics of the selected robots that are in the team."""
        indices = {name: index for index, name in enumerate(simulation.robots)}
        self._robots = {name: indices[name] for name in selected.robots if name in indices}
        self._every, self._due = selected.every, dict.fromkeys(self._robots, simulation.tick)
        self._file, self._simulation = file, simulation
        self._bearings: dict[str, list[list[float]]] = {}
        for name in self._robots:
            body = bodies[name.rpartition("/")[0]]
            # The bearings of a ring may wrap from pi to -pi; those of a scan must ascend.
            rings = body["rings"]
            self._bearings[name] = [np.unwrap(ring["bearings_rad"]).tolist() for ring in rings]
            about = {"robot": name, "body": json.dumps(body)}
            file.declare(f"/percept/{name}", schemas.exchanged("Percept"), about)
            file.declare(f"/command/{name}", schemas.exchanged("Command"), about)

    def step(self, steps: int, inputs: ExternalInputs, time_ns: int) -> dict[str, Command]:
        """Advance the simulation, and write its external inputs and the topics."""
        simulation = self._simulation
        tick = simulation.tick
        perceived = self._perceive(inputs.percepts or {})
        try:
            return simulation.step(steps, **inputs._asdict())
        finally:
            # Also after Ctrl-C: a completed step cannot be replayed without its inputs.
            if simulation.tick > tick:
                decided = {**simulation.decided, **(inputs.commands or {})}
                written = {
                    "percepts": inputs.percepts or {},
                    "observed": inputs.observed or {},
                    "commands": decided,
                }
                if any(written.values()):
                    self._file.write_json("/input", strict({"tick": tick, **written}), time_ns)
                if perceived:
                    self._write(self._completed(perceived), time_ns)

    def _perceive(self, external: Mapping[str, Percept]) -> dict[str, Mapping[str, Any]]:
        """Return the percepts in the next step that are due, of robots whose brains step in it."""
        due = [name for name in self._robots if self._due[name] <= self._simulation.tick]
        given = strict({name: external[name] for name in due if name in external})
        percepts = {name: given.get(name) or self._simulation.percept(name) for name in due}
        return {name: percept for name, percept in percepts.items() if percept is not None}

    def _completed(self, percepts: Mapping[str, Mapping[str, Any]]) -> dict[str, Any]:
        """Return percepts with what the run added to those of external bodies."""
        added = {name: self._simulation.perceived(name) for name in percepts}
        return {name: added[name] or percept for name, percept in percepts.items()}

    def _write(self, percepts: Mapping[str, Mapping[str, Any]], time_ns: int) -> None:
        """Write the percepts, the scans, and the resulting motion commands."""
        moment = _core.recorded_moment(self._simulation._run)  # noqa: SLF001  (ours)
        motions = moment["commanded"].tolist()
        # The tick is already that of the next step. Brains may step less often than each n-th.
        before = self._simulation.tick - 1
        for name, percept in percepts.items():
            self._due[name] = before - before % self._every + self._every
            self._file.write_json(f"/percept/{name}", percept, time_ns)
            self._write_scans(name, percept, time_ns)
            speed_m_s, turn_rate_rad_s = motions[self._robots[name]]
            motion = {"speed_m_s": speed_m_s, "turn_rate_rad_s": turn_rate_rad_s}
            self._file.write_json(f"/command/{name}", {"motion": motion}, time_ns)

    def _write_scans(self, name: str, percept: Mapping[str, Any], time_ns: int) -> None:
        for number, each in enumerate(percept.get("scans", ())):
            age_s = each.get("age_s")
            if age_s is None:
                continue
            ranges = [np.inf if value is None else float(value) for value in each["ranges_m"]]
            # A time before the run is invalid; the age in an external percept can be any number.
            taken_ns = time_ns - round(min(max(age_s, 0.0), time_ns / SECOND_NS) * SECOND_NS)
            message = scan(name, taken_ns, self._bearings[name][number], ranges)
            self._file.write(f"/scan/{name}/{number}", message, time_ns)
