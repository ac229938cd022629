"""A trial of a fault of the processes of a drive, or of a request: all its robots have to obey."""

import time
from pathlib import Path

from campaign_process_table import ProcessRow
from campaign_results import Trial
from campaign_scene import Scene, scene
from campaign_table import Kind, State

from agent_economy.live.clock import now_s

WATCH_S = 2.5
"""Time in which it has to happen, and after which robots that stop must still stand."""

ALIVE_S = 1.0
"""A robot that drives on has received a motion line within this time."""


def process_trial(folder: Path, state: State, row: ProcessRow, robots: int) -> Trial:
    """Run a trial; the delay is that of the robot that stops last."""
    by_hand = range(robots) if state is State.MANUAL else ()
    with scene(folder, state, robots, by_hand) as stage:
        began_s = now_s()
        at_s = row.inject(stage)
        time.sleep(WATCH_S)
        stopped_s = now_s()
        if row.is_passed:
            stage.ask("/stop")
            time.sleep(ALIVE_S)
        ended_s = now_s()
        stage.end()
        begin_s = stopped_s if row.is_passed and state.moves else at_s + row.detect_s
        problems: list[str] = []
        delays_s = []
        for robot in range(robots):
            delay_s = delay_of(stage, robot, row, (began_s, begin_s, stopped_s), problems)
            delays_s += [] if delay_s is None else [delay_s]
        behind_s = stage.behind_s(began_s, ended_s)
        return Trial(begin_s, max(delays_s, default=None), tuple(problems), ended_s, behind_s)


def delay_of(
    stage: Scene,
    robot: int,
    row: ProcessRow,
    times_s: tuple[float, float, float],
    problems: list[str],
) -> float | None:
    """Return the delay of one robot, and add what must not have happened to its problems."""
    began_s, begin_s, stopped_s = times_s
    kind, moves = row.kind(stage.state), stage.moves(robot, began_s)
    if not stage.state.moves and moves:
        problems.append(f"{len(moves)} motion lines while it had to stand")
    found_s = stage.found_s(robot, row.names, began_s)
    if row.names and found_s is None:
        problems.append(f"{' or '.join(row.names)} was not reported")
    if kind is Kind.NOTHING:
        problems += [f"a fault was reported: {each}" for each in early(stage, robot, times_s)]
        if not stage.state.moves:
            return None
    if kind is Kind.REPORT:
        if stage.state.moves and max(moves, default=0.0) < stopped_s - ALIVE_S:
            problems.append("it did not drive on")
        return None if found_s is None else found_s - begin_s
    # A robot that stands gets stop again; one that moves gets it behind its last motion line.
    last_s = max(stage.moves(robot, 0.0)) if stage.state.moves else begin_s
    after_s = min(stage.stops(robot, last_s), default=None)
    if after_s is None:
        problems.append("no stop")
    return None if after_s is None else after_s - begin_s


def early(stage: Scene, robot: int, times_s: tuple[float, float, float]) -> list[list[str]]:
    """Return the faults that were reported although nothing had to happen."""
    began_s, _, stopped_s = times_s
    events = [each for each in stage.events(robot, began_s) if each["t"] < stopped_s]
    found = [{*each["faults"], *each["warnings"]} for each in events]
    return [sorted(each) for each in found if each - {"held", "emergency_stop"}]
