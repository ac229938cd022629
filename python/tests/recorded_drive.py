"""The recording of a drive without a wire: made-up lines through the parts of the loop."""

from pathlib import Path
from typing import Any

from agent_economy.live import fleet
from agent_economy.live.line_readings import LineReadings
from agent_economy.live.loop.log import Log, LogOptions
from agent_economy.live.loop.team import Team
from agent_economy.runs.simulation import Simulation

STEP_S = 0.1
ROBOT = "bender/0"


def made(options: LogOptions | Path, steps: int = 60, start_s: float = 100.0) -> Path:
    """Record a drive of one Bender as the loop does, and return its file."""
    if isinstance(options, Path):
        options = LogOptions(options)
    loaded = fleet.load("bender")
    simulation = Simulation(loaded.scenario, external=[ROBOT])
    team = Team(loaded.plan, simulation, loaded.waypoints_m, seed=0, start_s=start_s)
    log, lines = Log(simulation, options, loaded, start_s), LineReadings(loaded.plan)
    for tick in range(steps):
        at_s = start_s + (tick + 1) * STEP_S
        for message in messages(tick, at_s, lines):
            team.add(message)
            log.add(message)
        log.tick(tick, at_s, 0.0)
        log.setpoints(tick, team.motions(log.step(team.percepts(tick, at_s))), at_s)
    log.close()
    return log.path


def messages(tick: int, at_s: float, readings: LineReadings) -> list[dict[str, Any]]:
    """Return what the warden sends before a step."""
    lines = {"compass": f"{10 + tick % 30}.0", "sonar": "9,9,9,9,9,9"}
    if tick % 10 == 0:
        lines["gps"] = f"36,35.7{160 + tick % 40},N,121,52.5002,W"
    event = {"type": "event", "t": at_s, "robot": ROBOT, "action": "move", "is_armed": True}
    faults: dict[str, Any] = {"mode": "auto", "is_confirmed": False, "reasons": {}}
    faults |= {name: [] for name in ("faults", "latched", "blockers", "warnings")}
    read = []
    for port, line in lines.items():
        message = {"type": "line", "robot": ROBOT, "port": port, "t": at_s, "line": line}
        read += [each for each in (message, readings.of(message)) if each is not None]
    return read if tick else [event | faults, *read]
