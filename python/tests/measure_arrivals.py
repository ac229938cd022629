"""Measures emulated Benders with errors of their drives and sensors, in virtual time.

`measure_arrivals.py arrivals` drives robots with different lags and fixes to two waypoints behind a
wall. `measure_arrivals.py belief` compares where the brain believes that the robot is with where it
is, for drives that move otherwise than commanded. Both print a Markdown table; `--json FILE` also
writes every run.

To measure another checkout, whose extension module is built:
`PYTHONPATH=CHECKOUT/python python measure_arrivals.py arrivals`.
"""

import argparse
import json
import os
import statistics
from collections.abc import Callable, Iterable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from imperfect_robot import DriveErrors, SensorErrors
from virtual_drive import ARMED_S, Case, Record, VirtualDrive

import agent_economy

PROCESSES = 2
ARRIVAL_NOISES_M, BELIEF_NOISES_M = (0.1, 0.5, 1.5), (0.2,)
ARRIVAL_LAGS_S, BELIEF_LAGS_S = (0.02, 0.05, 0.1, 0.2, 0.25, 0.35, 0.5), (0.0, 0.25)
GAINS = (0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2)
ASYMMETRY, MAX_SLIP, BLOCKED_FROM_S = 1.05, 0.4, 40.0
SIGMAS, EXPECTED_SHARE = 2.0, 0.865
"""A circle of two standard deviations of a normal error in the plane contains this share."""

Label = tuple[str, ...]
Row = tuple[str, ...]
Runs = list[Record]

ARRIVAL_COLUMNS = (
    "lag s",
    "fix noise m",
    "runs that arrive",
    "waypoints of 2",
    "time s",
    "runs with a turn without end",
    "longest turn to a heading s",
    "longest turn on the spot s",
    "lines that turn on the spot %",
    "contacts",
    "true distance when complete m: median, max",
)
BELIEF_COLUMNS = (
    "drive",
    "lag s",
    "fix noise m",
    f"share within 2 sd ({EXPECTED_SHARE:g} is right)",
    "error m: median",
    "error m: max",
    "stated sd m: median",
    "waypoints",
    "time s",
    "true distance when complete m: median, max",
)


def options() -> argparse.Namespace:
    """Return the command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", choices=["arrivals", "belief"])
    parser.add_argument("--seeds", type=int, default=3, help="number of runs per robot")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument("--noises", type=numbers, help="standard deviations of a fix, in m")
    parser.add_argument("--lags", type=numbers, help="time constants of the tracks, in s")
    parser.add_argument("--gains", type=numbers, default=GAINS, help="of belief")
    parser.add_argument("--delay", type=float, default=0.05, help="dead time of the tracks, in s")
    parser.add_argument("--compass", type=float, default=0.5, help="its noise, in degrees")
    parser.add_argument("--drift", type=float, default=0.0, help="of fixes, in m")
    parser.add_argument("--drift-time", type=float, default=60.0, help="its time constant, in s")
    parser.add_argument(
        "--unstated", action="store_true", help="the scenario states the drift as noise"
    )
    parser.add_argument("--limit", type=float, default=240.0, help="time limit of a run, in s")
    parser.add_argument("--json", type=Path, help="write all runs to a file")
    return parser.parse_args()


def numbers(text: str) -> tuple[float, ...]:
    """Return the numbers of a list with commas."""
    return tuple(float(each) for each in text.split(","))


def arrival_cases(given: argparse.Namespace) -> dict[Label, list[Case]]:
    """Return the runs of `arrivals`, by robot."""
    return {
        (f"{lag_s:g}", f"{noise_m:g}"): runs_of("bender", {"lag_s": lag_s}, noise_m, given)
        for noise_m in given.noises or ARRIVAL_NOISES_M
        for lag_s in given.lags or ARRIVAL_LAGS_S
    }


def belief_cases(given: argparse.Namespace) -> dict[Label, list[Case]]:
    """Return the runs of `belief`, by drive."""
    drives: dict[str, dict[str, float]] = {f"gain {gain:g}": {"gain": gain} for gain in given.gains}
    drives |= {
        f"left/right {ASYMMETRY}": {"gain_left_right": ASYMMETRY},
        f"slip to {MAX_SLIP}": {"max_slip": MAX_SLIP},
        "blocked for 10 s": {"blocked_from_s": ARMED_S + BLOCKED_FROM_S},
    }
    return {
        (name, f"{lag_s:g}", f"{noise_m:g}"): runs_of(
            "bender-team", {**drive, "lag_s": lag_s}, noise_m, given
        )
        for noise_m in given.noises or BELIEF_NOISES_M
        for name, drive in drives.items()
        for lag_s in given.lags or BELIEF_LAGS_S
    }


def runs_of(
    scenario: str, drive: Mapping[str, float], noise_m: float, given: argparse.Namespace
) -> list[Case]:
    """Return the runs of a robot, one per seed."""
    seeds = range(given.first_seed, given.first_seed + given.seeds)
    errors = DriveErrors(delay_s=given.delay, **drive)
    sensors = SensorErrors(
        noise_m, given.compass, given.drift, given.drift_time, not given.unstated
    )
    return [Case(scenario, errors, sensors, seed, given.limit) for seed in seeds]


def run(case: Case) -> Record:
    """Run a case."""
    return VirtualDrive(case).run()


def use_one_thread() -> None:
    """Let the worlds of this process, of one robot each, use one thread."""
    os.environ["RAYON_NUM_THREADS"] = "1"


def run_all(cases: Mapping[Label, list[Case]]) -> dict[Label, Runs]:
    """Run all cases, in two processes."""
    flat = [case for each in cases.values() for case in each]
    with ProcessPoolExecutor(PROCESSES, get_context("spawn"), use_one_thread) as pool:
        records = iter(list(pool.map(run, flat, chunksize=1)))
    return {label: [next(records) for _ in each] for label, each in cases.items()}


def is_complete(record: Record) -> bool:
    """Return whether all waypoints are complete."""
    return 0 < record.waypoints == len(record.complete)


def has_arrived(record: Record) -> bool:
    """Return whether all are complete, and the warden would not have stopped the robot before."""
    return is_complete(record) and record.turn_fault_s is None


def arrival_row(label: Label, runs: Runs) -> Row:
    """Return a row of `arrivals`."""
    share = sum(each.motor_lines[1] for each in runs) / sum(each.motor_lines[0] for each in runs)
    return (
        *label,
        f"{sum(map(has_arrived, runs))} of {len(runs)}",
        " ".join(str(len(each.complete)) for each in runs),
        " ".join(f"{each.end_s:.0f}" for each in runs),
        str(sum(each.turn_fault_s is not None for each in runs)),
        f"{max(each.turns.longest_s for each in runs):.1f}",
        f"{max(each.spot_turns.longest_s for each in runs):.1f}",
        f"{100 * share:.0f}",
        str(sum(each.contacts for each in runs)),
        distances(runs),
    )


def belief_row(label: Label, runs: Runs) -> Row:
    """Return a row of `belief`."""
    beliefs = [belief for each in runs for belief in each.beliefs]
    if not beliefs:
        return (*label, *["-"] * (len(BELIEF_COLUMNS) - len(label)))
    error_m = [error_m for _, error_m, _ in beliefs]
    within = sum(error_m <= SIGMAS * stated_m for _, error_m, stated_m in beliefs)
    return (
        *label,
        f"{within / len(beliefs):.2f}",
        f"{statistics.median(error_m):.2f}",
        f"{max(error_m):.2f}",
        f"{statistics.median(stated_m for *_, stated_m in beliefs):.3f}",
        " ".join(f"{len(each.complete)}/{each.waypoints}" for each in runs),
        " ".join(f"{each.end_s:.0f}" for each in runs),
        distances(runs),
    )


def distances(runs: Runs) -> str:
    """Return the median and the maximum of the true distances of complete waypoints."""
    distances_m = [distance_m for each in runs for *_, distance_m in each.complete]
    if not distances_m:
        return "-"
    return f"{statistics.median(distances_m):.2f}, {max(distances_m):.2f}"


def summary(found: Mapping[Label, Runs]) -> Iterable[str]:
    """Yield how many robots of `arrivals` arrive, for each seed."""
    by_seed = list(zip(*found.values(), strict=True))
    arrived = " ".join(str(sum(map(has_arrived, runs))) for runs in by_seed)
    complete = " ".join(str(sum(map(is_complete, runs))) for runs in by_seed)
    yield f"Robots that arrive, of {len(found)}, for each seed: {arrived}."
    yield f"If a turn without end does not stop them: {complete}."


def table(columns: Sequence[str], rows: Iterable[Row]) -> str:
    """Return a table in Markdown."""
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def write_json(file: Path, cases: Mapping[Label, list[Case]], found: Mapping[Label, Runs]) -> None:
    """Write each run with its case."""
    runs: list[dict[str, Any]] = [
        {"label": label, "case": asdict(case), "record": asdict(record)}
        for label, records in found.items()
        for case, record in zip(cases[label], records, strict=True)
    ]
    file.write_text(json.dumps(runs, default=sorted), encoding="utf-8")


PROGRAMS: Mapping[
    str,
    tuple[
        Callable[[argparse.Namespace], dict[Label, list[Case]]],
        Sequence[str],
        Callable[[Label, Runs], Row],
    ],
] = {
    "arrivals": (arrival_cases, ARRIVAL_COLUMNS, arrival_row),
    "belief": (belief_cases, BELIEF_COLUMNS, belief_row),
}


def main() -> None:
    """Run a program, and print its table."""
    given = options()
    cases_of, columns, row = PROGRAMS[given.program]
    cases = cases_of(given)
    found = run_all(cases)
    print(f"Measured: {Path(agent_economy.__file__).parent}\n")
    print(table(columns, (row(label, runs) for label, runs in found.items())))
    if given.program == "arrivals":
        print("", *summary(found), sep="\n")
    if given.json is not None:
        write_json(given.json, cases, found)


if __name__ == "__main__":
    main()
