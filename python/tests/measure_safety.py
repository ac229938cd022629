"""Measures how soon robots stop: every fault, in every state, with one and more robots.

`make safety` runs it. Each row of the table is a fault, a state and a number of robots, with the
delay from the moment at which the fault can be detected to the stop on the wire, its limit, and a
verdict. Beside each delay are the lateness of a bare timer in the same time, and the busy share of
the cores. A trial that the machine was too late for is left out and repeated. The exit code is 1 if
a verdict is not `ok`.
"""

import argparse
import os
import signal
import sys
from concurrent.futures import ThreadPoolExecutor, as_completed

from campaign_results import COLUMNS, Machine, Row, counted, grouped, head
from campaign_table import State
from campaign_units import QUICK, Unit, all_units

JOBS = 3
"""Drives at the same time: most of their time they wait."""


def arguments() -> argparse.Namespace:
    """Return the arguments."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--trials", type=int, default=1, help="Trials of each row (1).")
    parser.add_argument("--quick", action="store_true", help="A few faults only.")
    parser.add_argument("--only", default="", help="Faults whose name contains this.")
    parser.add_argument("--state", choices=list(State), help="This state only.")
    parser.add_argument("--jobs", type=int, default=JOBS, help=f"Drives at a time ({JOBS}).")
    return parser.parse_args()


def measured(units: list[Unit], trials: int, jobs: int) -> list[Row]:
    """Run all parts; print each row as soon as it is known, and return all."""
    machine, rows = Machine(), list[Row]()
    with ThreadPoolExecutor(jobs) as pool:
        running = {pool.submit(each.complete, trials, machine): each for each in units}
        try:
            for number, done in enumerate(as_completed(running), 1):
                done.result()
                for row in running[done].rows:
                    print(row, flush=True)
                    rows.append(row)
                sys.stderr.write(f"{number} of {len(units)} drives: {counted(rows)}\n")
        finally:
            pool.shutdown(wait=False, cancel_futures=True)
    return rows


def silence_processes() -> None:
    """Drop what processes print on standard error, and keep that of this one."""
    sys.stderr = os.fdopen(os.dup(2), "w", buffering=1)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 2)


def main() -> int:
    """Print the table; return an exit code."""
    given = arguments()
    silence_processes()
    signal.signal(signal.SIGTERM, signal.default_int_handler)

    def is_chosen(fault: str, state: State) -> bool:
        is_state = given.state in (None, state)
        return is_state and given.only in fault and (not given.quick or fault in QUICK)

    units = list(all_units(is_chosen, is_quick=given.quick))
    print(head(COLUMNS), flush=True)
    rows = measured(units, given.trials, given.jobs)
    print(f"\n{grouped(rows)}")
    return int(not rows or any(row.verdict != "ok" for row in rows))


if __name__ == "__main__":
    sys.exit(main())
