"""A trial of faults of single robots: each of a drive is broken in its way, and one is not."""

import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from campaign_scene import Scene, scene
from campaign_table import RETURN_S, UNSEEN_S, State, WireRow

from agent_economy.live.clock import now_s

WATCH_S = 6.0
"""Time in which a fault without effect must have none."""

AFTER_STOP_S = 2.0
"""Time after the stop in which nothing may move."""

HEALS = {"cut": "cut", "unplug": "refuse"}


@dataclass
class Broken:
    """A robot that has been broken.

    Attributes:
        robot: Its number.
        row: What was done to it.
        at_s: When.
        healed_s: When its motor port could be reached again; None if it always could.
        was_armed: Whether it could be armed although it must not; None if that was not tried.
    """

    robot: int
    row: WireRow
    at_s: float
    healed_s: float | None = None
    was_armed: bool | None = None


@dataclass
class WireTrial:
    """A trial of rows: the robots with these faults, and the times of what was done.

    Attributes:
        stage: The robots.
        broken: Those that are broken.
        healthy: The one that is not; None if there is none.
        began_s: When the first fault began.
        stopped_s: When all were stopped.
        ended_s: When the drive was ended.
    """

    stage: Scene
    broken: list[Broken]
    healthy: int | None
    began_s: float
    stopped_s: float = 0.0
    ended_s: float = 0.0

    def run(self) -> None:
        """Wait for what has to be found, heal the links, stop all, and end the drive."""
        stage = self.stage
        deadline_s = self.began_s + WATCH_S
        latest_s = self.began_s + UNSEEN_S + 1.0
        while now_s() < deadline_s or (not self._is_all_found() and now_s() < latest_s):
            time.sleep(0.1)
            self._try_to_arm()
        self._heal()
        self.stopped_s = now_s()
        stage.ask("/stop")
        latest_s = self.stopped_s + UNSEEN_S + 1.0
        time.sleep(AFTER_STOP_S)
        while not self._is_deafness_found() and now_s() < latest_s:
            time.sleep(0.1)
        self.ended_s = now_s()
        stage.end()

    def _is_all_found(self) -> bool:
        state = self.stage.state
        return all(self._is_found(each) for each in self.broken if each.row.finding(state))

    def _is_found(self, each: Broken) -> bool:
        finding = each.row.finding(self.stage.state)
        names = () if finding is None else finding.names
        return self.stage.found_s(each.robot, names, each.at_s) is not None

    def _is_deafness_found(self) -> bool:
        return all(
            self.stage.found_s(each.robot, ("moves_while_stopped",), self.stopped_s)
            for each in self.broken
            if each.row.is_deaf and self.stage.state.moves
        )

    def _try_to_arm(self) -> None:
        """Try to arm each robot once, as soon as its fault is reported: some faults then end."""
        for each in self.broken:
            is_due = self.stage.state is State.UNARMED and each.was_armed is None
            if is_due and self._is_found(each):
                each.was_armed = not self.stage.refuses_to_arm(each.robot)

    def _heal(self) -> None:
        healed = [each for each in self.broken if each.row.is_link]
        for each in healed:
            fault = HEALS[each.row.fault]
            each.healed_s = self.stage.bench.fault(each.robot, each.row.port, fault, on=False)
        if healed:
            time.sleep(RETURN_S)


def faults_of(row: WireRow) -> tuple[str, ...]:
    """Return the faults of the emulator of a row."""
    return ("refuse", "close") if row.fault == "unplug" else (row.fault,)


def inject(stage: Scene, robot: int, row: WireRow) -> Broken:
    """Break a robot."""
    at_s = now_s()
    for fault in faults_of(row):
        at_s = stage.bench.fault(robot, row.port, fault, row.value)
    return Broken(robot, row, at_s)


def wire_trial(folder: Path, state: State, rows: Sequence[WireRow], *, is_alone: bool) -> WireTrial:
    """Run a trial of some rows, with one more robot that is not broken unless they are alone."""
    robots = len(rows) + (not is_alone)
    by_hand = range(len(rows)) if state is State.MANUAL else ()
    with scene(folder, state, robots, by_hand) as stage:
        began_s = now_s()
        broken = [inject(stage, robot, row) for robot, row in enumerate(rows)]
        trial = WireTrial(stage, broken, None if is_alone else len(rows), began_s)
        trial.run()
        return trial
