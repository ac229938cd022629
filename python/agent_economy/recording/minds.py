"""What chosen robots perceive, and what their brains want then."""

import json
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from agent_economy.brain import Percept
from agent_economy.recording import schemas
from agent_economy.recording.file import File, strict
from agent_economy.recording.messages import SECOND_NS, scan
from agent_economy.simulation import Simulation


class Minds:
    """What goes into and comes out of the brains of some robots, in every step."""

    def __init__(
        self, file: File, robots: Mapping[str, int], bodies: Mapping[str, Mapping[str, Any]]
    ) -> None:
        """Declare what will be written of each of the robots, given with its place in the team."""
        self._file, self._robots = file, robots
        self._bearings: dict[str, list[list[float]]] = {}
        for name in robots:
            body = bodies[name.rpartition("/")[0]]
            # A ring's bearings may pass from pi to -pi; those of a scan only grow.
            rings = body["rings"]
            self._bearings[name] = [np.unwrap(ring["bearings_rad"]).tolist() for ring in rings]
            about = {"robot": name, "body": json.dumps(body)}
            file.declare(f"/percept/{name}", schemas.exchanged("Percept"), about)
            file.declare(f"/command/{name}", schemas.exchanged("Command"), about)

    def perceive(
        self, simulation: Simulation, outside: Mapping[str, Percept]
    ) -> dict[str, Mapping[str, Any]]:
        """Return what they will perceive in the next step, who decide in it."""
        given = strict({name: outside[name] for name in self._robots if name in outside})
        percepts = {name: given.get(name) or simulation.percept(name) for name in self._robots}
        return {name: percept for name, percept in percepts.items() if percept is not None}

    def write(
        self, percepts: Mapping[str, Mapping[str, Any]], wanted: Sequence[Any], time_ns: int
    ) -> None:
        """Write what they perceived, and what they wanted then: of each robot speed and turn."""
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
