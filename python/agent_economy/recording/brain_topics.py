"""What chosen robots perceive, and what their brains want then."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.recording import schemas
from agent_economy.recording.file import File, strict
from agent_economy.recording.foxglove import SECOND_NS, scan
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.simulation import Simulation


class Minds:
    """What goes into and comes out of the brains of some robots, in every step."""

    def __init__(
        self,
        file: File,
        simulation: Simulation,
        chosen: Sequence[str],
        bodies: Mapping[str, Mapping[str, Any]],
    ) -> None:
        """Declare what will be written of each of the chosen robots that is in the team."""
        places = {name: place for place, name in enumerate(simulation.robots)}
        self._robots = {name: places[name] for name in chosen if name in places}
        self._file, self._simulation = file, simulation
        self._bearings: dict[str, list[list[float]]] = {}
        for name in self._robots:
            body = bodies[name.rpartition("/")[0]]
            # A ring's bearings may pass from pi to -pi; those of a scan only grow.
            rings = body["rings"]
            self._bearings[name] = [np.unwrap(ring["bearings_rad"]).tolist() for ring in rings]
            about = {"robot": name, "body": json.dumps(body)}
            file.declare(f"/percept/{name}", schemas.exchanged("Percept"), about)
            file.declare(f"/command/{name}", schemas.exchanged("Command"), about)

    def step(
        self,
        steps: int,
        percepts: Mapping[str, Percept] | None,
        commands: Mapping[str, Command] | None,
        time_ns: int,
    ) -> dict[str, Command]:
        """Take steps, and write what came into them from outside, and what chosen robots had."""
        simulation = self._simulation
        tick = simulation.tick
        perceived = self._perceive(percepts or {})
        try:
            return simulation.step(steps, percepts=percepts, commands=commands)
        finally:
            # Also after Ctrl-C: a step that was taken cannot be taken again without its input.
            if simulation.tick > tick:
                decided = {**simulation.decided, **(commands or {})}
                inputs = {"percepts": percepts or {}, "commands": decided}
                if any(inputs.values()):
                    self._file.write_json("/input", strict({"tick": tick, **inputs}), time_ns)
                if perceived:
                    self._write(perceived, time_ns)

    def _perceive(self, outside: Mapping[str, Percept]) -> dict[str, Mapping[str, Any]]:
        """Return what they will perceive in the next step, who decide in it."""
        given = strict({name: outside[name] for name in self._robots if name in outside})
        percepts = {
            name: given.get(name) or self._simulation.percept(name) for name in self._robots
        }
        return {name: percept for name, percept in percepts.items() if percept is not None}

    def _write(self, percepts: Mapping[str, Mapping[str, Any]], time_ns: int) -> None:
        """Write what they perceived, and what they wanted then."""
        moment = _core.recorded_moment(self._simulation._run)  # noqa: SLF001  (ours)
        wanted = moment["wanted"].tolist()
        for name, percept in percepts.items():
            self._file.write_json(f"/percept/{name}", percept, time_ns)
            self._write_scans(name, percept, time_ns)
            speed_m_s, turn_rate_rad_s = wanted[self._robots[name]]
            motion = {"speed_m_s": speed_m_s, "turn_rate_rad_s": turn_rate_rad_s}
            self._file.write_json(f"/command/{name}", {"motion": motion}, time_ns)

    def _write_scans(self, name: str, percept: Mapping[str, Any], time_ns: int) -> None:
        for number, each in enumerate(percept.get("scans", ())):
            age_s = each.get("age_s")
            if age_s is None:
                continue
            ranges = [np.inf if value is None else float(value) for value in each["ranges_m"]]
            # No viewer has times before the run; a body outside may say any age.
            taken_ns = time_ns - round(min(max(age_s, 0.0), time_ns / SECOND_NS) * SECOND_NS)
            message = scan(name, taken_ns, self._bearings[name][number], ranges)
            self._file.write(f"/scan/{name}/{number}", message, time_ns)
