"""Measures how soon a robot stops after each fault on the wire: `make safety`.

Each trial breaks an emulated fleet in every way of `wire_faults`, or every process of
`process_faults`. Beside each stop is the lateness of a bare timer in the same time. A stop in whose
time the timer was late by more than 50 ms measures the machine: it is counted, left out, repeated.
"""

import argparse
import statistics
import sys
import tempfile
from collections import defaultdict
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path

import process_faults
import wire_faults
from bare_timer import BareTimer
from live_bench import driving, emulated, fleet_text

MAX_LATE_S = 0.05
MAX_REPEATS = 3
"""At most this many times the number of trials are run."""


@dataclass
class Stops:
    """The stops after one fault: delays, lateness of the timer, and how many are left out."""

    delays_s: list[float] = field(default_factory=list)
    late_s: list[float] = field(default_factory=list)
    left_out: int = 0

    def add(self, delay_s: float, late_s: float) -> None:
        """Add a stop, or leave it out."""
        if late_s > MAX_LATE_S:
            self.left_out += 1
        else:
            self.delays_s.append(delay_s)
            self.late_s.append(late_s)

    def row(self, name: str) -> str:
        """Return the row of a table, in milliseconds."""
        if not self.delays_s:
            return f"| {name} | 0 | {self.left_out} | | | |"
        numbers = (
            statistics.median(self.delays_s),
            max(self.delays_s),
            max(self.late_s),
        )
        cells = " | ".join(f"{1000 * number:.0f}" for number in numbers)
        return f"| {name} | {len(self.delays_s)} | {self.left_out} | {cells} |"


def break_robots(folder: Path, timer: BareTimer, stops: dict[str, Stops]) -> None:
    """Break each robot of a fleet in its way."""
    faults = wire_faults.FAULTS
    scenario = wire_faults.lanes(folder, len(faults))
    fleet = folder / "fleet.toml"
    with emulated(folder, len(faults), arguments=("--scenario", str(scenario))) as bench:
        fleet.write_text(fleet_text(bench, scenario=str(scenario)), encoding="utf-8")
        with driving(fleet) as drive:
            bench.wait_for_motion(len(faults))
            wire_faults.inject(bench, faults)
            for robot, fault in enumerate(faults):
                drive.wait_for_fault(f"bender/{robot}", fault.expected)
            drive.wait()
            evidence = wire_faults.Evidence.of(bench, drive.record)
    for robot, fault in enumerate(faults):
        limit_s = evidence.limit_s(robot, fault)
        delay_s = evidence.stop_delay_s(robot, fault)
        stops[fault.name].add(delay_s, timer.late_s(limit_s, limit_s + delay_s))


def break_processes(folder: Path, timer: BareTimer, stops: dict[str, Stops]) -> None:
    """Break each drive of some in its way."""
    faults = process_faults.FAULTS
    scenario = wire_faults.lanes(folder, len(faults))
    with ExitStack() as stack:
        arguments = ("--scenario", str(scenario))
        bench = stack.enter_context(emulated(folder, len(faults), arguments=arguments))
        drives = process_faults.Drives(bench, scenario, folder, stack)
        drives.inject()
        for robot, fault in enumerate(faults):
            limit_s, delay_s = drives.limit_s(robot), drives.stop_delay_s(robot)
            stops[fault.name].add(delay_s, timer.late_s(limit_s, limit_s + delay_s))


def main() -> int:
    """Print the table; return an exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=20, help="Stops per fault.")
    trials = parser.parse_args().trials
    timer = BareTimer()
    print("| fault | stops | left out | median, ms | maximum, ms | timer, ms |")
    print("|---|---|---|---|---|---|")
    for break_all in (break_robots, break_processes):
        stops: dict[str, Stops] = defaultdict(Stops)
        for trial in range(MAX_REPEATS * trials):
            with tempfile.TemporaryDirectory() as folder:
                break_all(Path(folder), timer, stops)
            fewest = min(len(each.delays_s) for each in stops.values())
            print(f"trial {trial + 1}: at least {fewest} of {trials}", file=sys.stderr)
            if fewest >= trials:
                break
        for name, each in stops.items():
            print(each.row(name), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
