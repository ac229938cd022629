"""Compares a recorded drive with the program of 2002."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.live.plan import plan_of
from agent_economy.live.program_2002 import Comparison, compare
from agent_economy.live.replay import read_drive
from agent_economy.recording.fields import Entries
from agent_economy.recording.live_topics import LIVE
from agent_economy.recording.reading import named, read
from agent_economy.scenario import Scenario


@dataclass(frozen=True)
class Compared:
    """A recorded drive beside the program of 2002.

    Attributes:
        robots: The comparison of each robot.
        is_complete: Whether the file is complete; a truncated file is read up to its end, a
            damaged one up to the damage.
        damaged_tick: The step from which on the file is damaged; None if it is not.
    """

    robots: tuple[Comparison, ...]
    is_complete: bool
    damaged_tick: int | None


def compare_2002(path: str | Path, *, steers: bool = False) -> Compared:
    """Return what the program of 2002 would have sent to each robot, beside what was sent.

    Both steer to the first waypoint of the robot. The program of 2002 is given the recorded lines.

    Args:
        path: A recording of a drive.
        steers: Whether the program of 2002 turns to its waypoint. As printed, it never does.

    Raises:
        InputError: If the file cannot be read, is damaged before its first state, or is not a
            recording of a drive.
    """
    drive = read_drive(Path(path))
    if drive is None:
        message = f"{path}: is not a recording of a drive: must be one of `agent-economy drive`"
        raise InputError(message)
    with named(Path(path)):
        run = Entries(f"metadata {LIVE!r}", drive.values)
        plan, ordered_m = plan_of(run.json("plan")), run.json("waypoints_m")
    identity, recorded = read(Path(path))
    robots = tuple(
        compare(
            robot,
            plan.origin,
            first_waypoint_m(identity.scenario, robot.name, ordered_m),
            drive.lines_of(robot.name),
            steers=steers,
        )
        for robot in plan.robots
    )
    is_damaged = drive.is_damaged or recorded.damaged_tick is not None
    damaged_tick = drive.steps if is_damaged else None
    return Compared(robots, recorded.is_complete and not is_damaged, damaged_tick)


def first_waypoint_m(
    scenario: Scenario, robot: str, ordered_m: Mapping[str, Any]
) -> Sequence[float] | None:
    """Return the first waypoint of a robot: of its brain, or ordered; None without any."""
    kind = robot.rpartition("/")[0]
    behaviours = scenario.to_dict()["robots"][kind].get("brain", {}).get("behaviours", ())
    own_m = [at for behaviour in behaviours for at in behaviour.get("waypoints_m", ())]
    waypoints_m = [*own_m, *ordered_m.get(robot, ())]
    return waypoints_m[0] if waypoints_m else None
