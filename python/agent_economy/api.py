"""Runs of a scenario, of whatever engine: one, or a table of many."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow as pa

from agent_economy import _core
from agent_economy.runs import factory
from agent_economy.runs.outcome import Outcome, table
from agent_economy.runs.python_brains import Brains
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario, as_scenario, validation


def run(
    scenario: Scenario | str | Path,
    seed: int = 0,
    run: int = 0,
    record: str | Path | None = None,
    brains: Brains | None = None,
) -> Outcome:
    """Run a scenario once; Ctrl-C stops it within a second.

    Args:
        scenario: A scenario, its file, or the name of one that ships.
        seed: Of all chance, 0 to 2^64 - 1.
        run: Its number, 0 to 2^63 - 10,000,001; each is another world.
        record: A file for a recording of all of it, NAME.mcap (see `agent_economy.recording`).
        brains: By kind of robots, what makes their brains in Python: see `Simulation`.

    Returns:
        The same, on any machine, as row `run` of `replicate`.

    Raises:
        InputError: If the scenario is wrong, or an argument out of range; all faults at once. If
            the file cannot be written, or a run to be recorded has no room for its team or items.
    """
    scenario = as_scenario(scenario)
    if record is not None:
        path = validation.path("record", record)
        if brains is None:
            return recorded(factory.create(scenario, seed, run), path)
        return recorded(Simulation(scenario, seed, run, brains=brains), path)
    if brains is not None:
        row = replicate(scenario, 1, seed, first_run=run, brains=brains)
        return Outcome.of(row.to_pylist()[0])
    configuration = scenario.configuration({})
    told = _core.run_one(configuration, seed=seed, run=run)
    values = {name: np.array([value]) for name, value in told.items()}
    return Outcome.of(table(configuration.columns, values, scenario.merit, run).to_pylist()[0])


def replicate(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario | str | Path,
    runs: int,
    seed: int = 0,
    threads: int | None = None,
    first_run: int = 0,
    *,
    brains: Brains | None = None,
) -> pa.Table:
    """Run a scenario many times; Ctrl-C stops it within a second.

    Args:
        scenario: A scenario, its file, or the name of one that ships.
        runs: How many, 0 to 10,000,000.
        seed: Of all chance, 0 to 2^64 - 1.
        threads: 1 to 1024; None for as many as there are processors. It changes no result.
        first_run: The number of the first; the others follow.
        brains: By kind of robots, what makes their brains in Python: see `Simulation`. Runs are
            then taken one after the other, by this process, and each has new brains.

    Returns:
        A row a run: `run`, `time_s` (of the last find; the cap if not all was found), `complete`
        (whether it was), then what else the engine tells, and `merit`. Of the metric engine that is
        `robots`, `price`, `found` and `missed` (of the targets), `false_alarms`, `collisions`,
        `energy_j`, `distance_m`, `robots_stopped`, and `found_KIND` and `missed_KIND` of each kind
        of items. Counts are int64, `complete` is a bool. A run that is quarantined (see
        `Outcome.status`) has nulls everywhere but in `run`; what never happened is null.

    Raises:
        InputError: If the scenario is wrong, or an argument out of range; all faults at once.
    """
    scenario = as_scenario(scenario)
    configuration = scenario.configuration({})
    if brains is not None:
        begin = partial(Simulation, scenario, seed, threads=threads, brains=brains)
        rows = one_by_one(begin, first_run, runs)
        names = [name for name, *_ in configuration.columns]
        values = {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}
    else:
        told = _core.run_block(
            [configuration], seed=seed, first_run=first_run, runs=runs, threads=threads
        )
        values = {name: array[0] for name, array in told.items()}
    return table(configuration.columns, values, scenario.merit, first_run)


def one_by_one(
    begin: Callable[[int], Simulation], first_run: int, runs: int
) -> list[dict[str, float]]:
    """Return what each run gives, by column; nothing of one that is quarantined."""
    most = _core.MAX_RUNS
    validation.check(
        validation.is_whole(runs, 0, most), "runs", runs, f"a whole number from 0 to {most}"
    )
    validation.check(
        validation.is_whole(first_run, 0), "first_run", first_run, "a whole number, 0 or more"
    )
    return [told_by(begin, first_run + number) for number in range(runs)]


def told_by(begin: Callable[[int], Simulation], run: int) -> dict[str, float]:
    """Return what a run gives, by column; nothing if it is quarantined."""
    try:
        simulation = begin(run)
    except _core.NoRoomError:
        return {}
    simulation.finish()
    return simulation._run.outcome() or {}  # noqa: SLF001  (ours)


def recorded(simulation: Stepped, path: Path) -> Outcome:
    """Run to the end, and record it."""
    # What writes recordings takes longer to load than most runs take.
    from agent_economy.recording import Recording  # noqa: PLC0415

    with Recording(simulation, path) as recording:
        return recording.finish()
