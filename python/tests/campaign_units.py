"""The parts of the campaign that are run by themselves: each gives some rows of the table."""

import sys
import tempfile
import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from http.client import HTTPException
from pathlib import Path
from subprocess import TimeoutExpired

from campaign_judge import Judge
from campaign_process_table import PROCESSES, REQUESTS, ProcessRow, fleets
from campaign_processes import process_trial
from campaign_results import Key, Machine, Row, Trial
from campaign_table import REACTION_S, ROWS, State, WireRow
from campaign_wire import wire_trial
from flooding_robot import FLOODS
from floods import stops_in_a_flood

from agent_economy.live.clock import now_s

MAX_REPEATS = 3
"""At most this many times the number of trials are run."""

MAX_STARTS = 5
"""A drive that does not reach its state is started again, up to this number of times in all."""

PER_DRIVE, PER_DRIVE_BY_HAND = 9, 6
"""Robots that are broken in one drive."""

LATE = ("loop_silent", "loop_late", "event_loop_gap")
"""Faults that no fault of a robot explains: the machine was late for the whole drive."""

QUICK = (
    "motors cut",
    "motors close",
    "motors stall",
    "compass close",
    "compass jump 90",
    "gps nan",
    "sonar stall",
    "sonar duplicate",
    "loop suspended",
    "warden killed",
    "request: stop",
    "flood: mixed",
)
"""Faults of the quick campaign; those of robots are also tried with one and two robots."""

Results = list[tuple[Row, Trial]]


@dataclass
class Unit:
    """A part of the campaign.

    Attributes:
        rows: Its rows.
        run: Runs a trial of some of its rows in a folder.
    """

    rows: list[Row]
    run: Callable[[Path, Sequence[Row]], Results]

    def complete(self, trials: int, machine: Machine) -> None:
        """Run trials until each row has enough, or the machine was late too often."""
        for _ in range(MAX_REPEATS * trials):
            missing = [row for row in self.rows if row.count < trials]
            if not missing:
                return
            self._try(missing, machine)

    def _try(self, rows: Sequence[Row], machine: Machine) -> None:
        results = self._results(rows)
        problems = [each for _, trial in results for each in trial.problems]
        if not results or any(fault in each for each in problems for fault in LATE):
            for row in rows:
                row.left_out += 1
            return
        for row, trial in results:
            row.add(trial, machine)
            for problem in trial.problems:
                sys.stderr.write(f"{row.key}: {problem}\n")

    def _results(self, rows: Sequence[Row]) -> Results:
        for _ in range(MAX_STARTS):
            try:
                with tempfile.TemporaryDirectory() as folder:
                    return self.run(Path(folder), rows)
            except (AssertionError, OSError, HTTPException, TimeoutExpired) as error:
                sys.stderr.write(f"no trial of {rows[0].key}: {str(error)[:200]}\n")
                traceback.print_tb(error.__traceback__, limit=-1)
        return []


def wire_unit(state: State, rows: Sequence[WireRow], *, is_alone: bool = False) -> Unit:
    """Return the trials of faults of robots in one drive."""
    robots = len(rows) + (not is_alone)
    faults: dict[Key, WireRow] = {}
    table = []
    for each in rows:
        key = Key(each.name, each.port, robots, state)
        faults[key] = each
        limit_s = each.limit_s(state) if state.moves or each.finding(state) else None
        table.append(Row(key, each.expected(state), limit_s))
    if not is_alone:
        other = Key("none (another robot)", table[0].key.port, robots, state)
        expected = "stop on request" if state.moves else "stands"
        table.append(Row(other, expected, REACTION_S if state.moves else None))

    def run(folder: Path, missing: Sequence[Row]) -> Results:
        broken = {row.key: faults[row.key] for row in missing if row.key in faults}
        trial = wire_trial(folder, state, list(broken.values()), is_alone=is_alone)
        judge = Judge(trial)
        found = dict(zip(broken, map(judge.trial, trial.broken), strict=True))
        other = judge.other()
        results = [(row, found.get(row.key, other)) for row in missing]
        return [(row, result) for row, result in results if result is not None]

    return Unit(table, run)


def process_unit(row: ProcessRow, state: State, robots: int) -> Unit:
    """Return the trials of a fault of the processes of one drive, or of a request."""
    has_delay = state.moves or not row.is_passed
    key = Key(row.name, "", robots, state)
    table = [Row(key, row.expected(state), row.limit_s if has_delay else None)]

    def run(folder: Path, missing: Sequence[Row]) -> Results:
        return [(missing[0], process_trial(folder, state, row, robots))]

    return Unit(table, run)


def flood_unit(name: str) -> Unit:
    """Return the trials of a robot that sends without end, beside one that does not."""
    table = [Row(Key(f"flood: {name}", "all", 2, State.STRAIGHT), "stop on request", REACTION_S)]

    def run(folder: Path, missing: Sequence[Row]) -> Results:
        delays_s = stops_in_a_flood(name, folder)
        ended_s = now_s()
        longest_s = max(delays_s)
        return [(missing[0], Trial(ended_s - longest_s, longest_s, (), ended_s))]

    return Unit(table, run)


def all_units(is_chosen: Callable[[str, State], bool], *, is_quick: bool) -> Iterator[Unit]:
    """Yield all parts, with the faults and states that are chosen."""
    for state in (State.STRAIGHT, State.HELD) if is_quick else State:
        for rows in _batches(state, is_chosen):
            yield wire_unit(state, rows)
    for each in ROWS:
        name = f"{each.port} {each.name}"
        if name in QUICK and is_chosen(name, State.STRAIGHT):
            yield wire_unit(State.STRAIGHT, [each], is_alone=True)
            yield from () if is_quick else (wire_unit(State.STRAIGHT, [each]),)
    for row in (*PROCESSES, *REQUESTS):
        for state, robots in fleets(row):
            if is_chosen(row.name, state) and not (is_quick and (state, robots) != QUICK_FLEET):
                yield process_unit(row, state, robots)
    for name in FLOODS:
        if is_chosen(f"flood: {name}", State.STRAIGHT):
            yield flood_unit(name)


QUICK_FLEET = (State.STRAIGHT, 2)


def _batches(state: State, is_chosen: Callable[[str, State], bool]) -> Iterator[Sequence[WireRow]]:
    rows = [each for each in ROWS if is_chosen(f"{each.port} {each.name}", state)]
    size = PER_DRIVE_BY_HAND if state is State.MANUAL else PER_DRIVE
    for begin in range(0, len(rows), size):
        yield rows[begin : begin + size]
