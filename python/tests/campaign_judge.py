"""What the trial of faults of single robots shows: the delay of each, and what must not happen."""

import math
from collections.abc import Sequence
from itertools import pairwise

from campaign_results import Trial
from campaign_scene import SLOW_VALUE, name_of
from campaign_table import RETURN_S, Finding, Kind
from campaign_wire import Broken, WireTrial, faults_of
from live_bench import STOP_LINE

from agent_economy.live.replay import read_drive

EARLY_S = 0.05
"""A fault that is found earlier than this before its limit is a false alarm."""

SILENT_S = 1.0
"""A robot that drives on has received a motion line within this time."""

UNHEARD_S = 0.5
"""A robot that is not disturbed receives a line at least this often."""


class Judge:
    """Judges a trial that has ended."""

    def __init__(self, trial: WireTrial) -> None:
        """Judge this trial."""
        self._trial, self._stage = trial, trial.stage

    def trial(self, each: Broken) -> Trial:
        """Return the result of a robot; after the end."""
        state, row = self._stage.state, each.row
        kind, finding = row.kind(state), row.finding(state)
        if finding is None:
            return self._on_request(each)
        begin_s = self._cause_s(each, finding) + finding.detect_s
        found_s = self._stage.found_s(each.robot, finding.names, each.at_s)
        problems = list(self._problems(each, begin_s))
        delay_s = None if found_s is None else self._delay_s(each, kind, found_s) - begin_s
        if found_s is None:
            problems.append(f"{finding.name} was not reported: {self._events(each)}")
        note = "" if found_s is None else f", reported after {1000 * (found_s - begin_s):.0f} ms"
        return self._result(begin_s, delay_s, problems, note)

    def other(self) -> Trial | None:
        """Return the result of the robot that was not broken; None if there is none."""
        if self._trial.healthy is None:
            return None
        stage, robot = self._stage, self._trial.healthy
        found = [
            each
            for each in stage.events(robot, self._trial.began_s)
            if each["t"] < self._trial.stopped_s
        ]
        problems = [f"a fault was reported: {each['faults']}" for each in found if _new(each)]
        lines = stage.wire(robot, "motors", "received")
        times_s = [at_s for at_s, _ in lines if self._trial.began_s <= at_s <= self._trial.ended_s]
        gap_s = max((after - before for before, after in pairwise(times_s)), default=math.inf)
        if gap_s > UNHEARD_S:
            problems.append(f"no line for {gap_s:.2f} s")
        if not stage.state.moves:
            return self._result(self._trial.began_s, None, problems)
        end_s = min(stage.stops(robot, self._trial.stopped_s), default=self._trial.ended_s)
        return self._result(self._trial.stopped_s, end_s - self._trial.stopped_s, problems)

    def _result(
        self, begin_s: float, delay_s: float | None, problems: Sequence[str], note: str = ""
    ) -> Trial:
        behind_s = self._stage.behind_s(self._trial.began_s, self._trial.ended_s)
        return Trial(begin_s, delay_s, tuple(problems), self._trial.ended_s, behind_s, note)

    def _cause_s(self, each: Broken, finding: Finding) -> float:
        fault_s = self._fault_s(each)
        sent = [at_s for at_s, _ in self._stage.wire(each.robot, each.row.port, "sent")]
        match finding.cause:
            case "before":
                return max(at_s for at_s in sent if at_s < fault_s)
            case "after":
                return min(at_s for at_s in sent if at_s >= fault_s)
            case "written":
                return min(at_s for at_s in self._written_s(each.robot) if at_s >= fault_s)
        return fault_s

    def _fault_s(self, each: Broken) -> float:
        """Return when the emulator switched the fault on: requests take their time."""
        times_s = [at_s for at_s, _ in self._stage.wire(each.robot, each.row.port, "fault")]
        return times_s[len(faults_of(each.row)) - 1]

    def _written_s(self, robot: int) -> list[float]:
        drive = read_drive(self._stage.drive.record)
        assert drive is not None
        lines = drive.lines_of(name_of(robot))
        return [
            each["t"] for each in lines if each["type"] == "written" and each["port"] == "motors"
        ]

    def _delay_s(self, each: Broken, kind: Kind, found_s: float) -> float:
        """Return when what has to happen has happened: where possible, on the wire."""
        if each.row.is_link or kind is Kind.REPORT:
            return found_s
        lines = self._stage.wire(each.robot, "motors", "received")
        is_fast = (lambda line: line != STOP_LINE) if kind is Kind.STOP else is_full_speed
        before = [at_s for at_s, line in lines if is_fast(line) and at_s < self._trial.stopped_s]
        after = [at_s for at_s, line in lines if not is_fast(line) and at_s > max(before)]
        return min(after, default=self._trial.ended_s)

    def _problems(self, each: Broken, begin_s: float) -> list[str]:
        """Return what must not happen with a fault that is found."""
        state, row, stage = self._stage.state, each.row, self._stage
        problems = []
        finding = row.finding(state)
        first = next((e for e in stage.events(each.robot, each.at_s) if _new(e)), None)
        if finding and first and first["t"] < self._trial.stopped_s:
            if not set(finding.names) & {*first["faults"], *first["warnings"]}:
                problems.append(f"the first report was {first['faults']}, {first['warnings']}")
            if first["t"] < begin_s - EARLY_S:
                problems.append(f"reported {begin_s - first['t']:.2f} s too early")
        if not state.moves and (moves := stage.moves(each.robot, self._trial.began_s)):
            problems.append(f"{len(moves)} motion lines while it had to stand")
        if row.kind(state) is Kind.SLOW and not self._moved_until_stopped(each):
            problems.append("it did not drive on")
        if each.was_armed:
            problems.append("it could be armed")
        if each.healed_s and not any(
            at_s < each.healed_s + RETURN_S for at_s in stage.stops(each.robot, each.healed_s)
        ):
            problems.append(f"no stop within {RETURN_S} s of the return of its motor port")
        if state.moves and stage.moves(
            each.robot, self._trial.stopped_s + max(row.request_limit_s, 0.2)
        ):
            problems.append("motion lines after the stop")
        return problems

    def _on_request(self, each: Broken) -> Trial:
        """Return the result of a robot that has to drive on, or to stand, until it is stopped."""
        state, row, stage = self._stage.state, each.row, self._stage
        problems = self._problems(each, self._trial.stopped_s)
        for event in stage.events(each.robot, each.at_s):
            names = {*event["faults"], *event["warnings"]}
            before = {"held", "emergency_stop", *row.allowed}
            if event["t"] < self._trial.stopped_s and names - before:
                problems.append(f"a fault was reported: {sorted(names)}")
        if not state.moves:
            return self._result(each.at_s, None, problems)
        if row.is_deaf:
            end_s = stage.found_s(each.robot, ("moves_while_stopped",), self._trial.stopped_s)
            missing = "moves_while_stopped was not reported"
        else:
            end_s = min(stage.stops(each.robot, self._trial.stopped_s), default=None)
            missing = "no stop on request"
            if not row.allowed and not self._moved_until_stopped(each):
                problems.append("it did not drive on")
        if end_s is None:
            return self._result(self._trial.stopped_s, None, [*problems, missing])
        return self._result(self._trial.stopped_s, end_s - self._trial.stopped_s, problems)

    def _moved_until_stopped(self, each: Broken) -> bool:
        stopped_s = self._trial.stopped_s
        moves_s = self._stage.moves(each.robot, stopped_s - SILENT_S)
        return any(at_s < stopped_s for at_s in moves_s)

    def _events(self, each: Broken) -> list[tuple[str, list[str]]]:
        events = self._stage.events(each.robot, each.at_s)
        return [(event["action"], event["faults"] + event["warnings"]) for event in events]


def _new(event: dict[str, list[str]]) -> bool:
    """Whether a report has other faults than those of the state itself."""
    return bool({*event["faults"], *event["warnings"]} - {"held", "emergency_stop"})


def is_full_speed(line: str) -> bool:
    """Return whether a motor line is faster than the limit of the speed."""
    return line != STOP_LINE and int(line.split(",")[2]) > SLOW_VALUE
