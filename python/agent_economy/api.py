"""Runs of a scenario of either engine: a single one, or a table of many."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np
import pyarrow as pa

from agent_economy import _core
from agent_economy.runs import factory
from agent_economy.runs.outcome import Outcome, table
from agent_economy.runs.python_brains import Brains, Controllers
from agent_economy.runs.simulation import Simulation
from agent_economy.runs.stepped import Stepped
from agent_economy.scenario import Scenario, as_scenario, validation


def run(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario | str | Path,
    seed: int = 0,
    run: int = 0,
    record: str | Path | None = None,
    brains: Brains | None = None,
    *,
    controllers: Controllers | None = None,
) -> Outcome:
    """Run a scenario once. Ctrl-C stops it within a second.

    Args:
        scenario: A scenario, its file, or the name of a bundled one.
        seed: Seed of all random numbers, 0 to 2^64 - 1.
        run: Run number, 0 to 2^63 - 10,000,001. Each number is a different world.
        record: File for a recording of the whole run, NAME.mcap (see `agent_economy.recording`).
        brains: Python brains by kind of robots: see `Simulation`.
        controllers: Python controllers by kind of controllers: see `Simulation`.

    Returns:
        The outcome. It equals row `run` of `replicate`, on any machine.

    Raises:
        InputError: If the scenario has errors or an argument is out of range; it lists all errors.
            If the file cannot be written, or a run to be recorded has no room for its team or
            items.
    """
    scenario = as_scenario(scenario)
    is_in_python = brains is not None or controllers is not None
    if record is not None:
        path = validation.path("record", record)
        if not is_in_python:
            return recorded(factory.create(scenario, seed, run), path)
        simulation = Simulation(scenario, seed, run, brains=brains, controllers=controllers)
        return recorded(simulation, path)
    if is_in_python:
        row = replicate(scenario, 1, seed, None, run, brains=brains, controllers=controllers)
        return Outcome.of(row.to_pylist()[0])
    configuration = scenario.configuration({})
    seed, run = validation.plain_value("seed", seed), validation.plain_value("run", run)
    outcome = _core.run_one(configuration, seed=seed, run=run)
    values = {name: np.array([value]) for name, value in outcome.items()}
    return Outcome.of(table(configuration.columns, values, scenario.merit, run).to_pylist()[0])


def replicate(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario | str | Path,
    runs: int,
    seed: int = 0,
    threads: int | None = None,
    first_run: int = 0,
    *,
    brains: Brains | None = None,
    controllers: Controllers | None = None,
) -> pa.Table:
    """Run a scenario many times. Ctrl-C stops it within a second.

    Args:
        scenario: A scenario, its file, or the name of a bundled one.
        runs: Number of runs, 0 to 10,000,000.
        seed: Seed of all random numbers, 0 to 2^64 - 1.
        threads: Number of threads, 1 to 1024; None for one per processor. It changes no result.
        first_run: Number of the first run; the others follow.
        brains: Python brains by kind of robots: see `Simulation`. The runs are then executed one
            after the other in this process, and each gets new brains.
        controllers: Python controllers by kind of controllers, as `brains`.

    Returns:
        One row per run: `run`, `time_s` (time until the run was complete; the time limit if it was
        not), `complete` (whether all targets were found, or the condition of the scenario's end was
        met), the other columns of the engine, and `merit`. The metric engine has `robots`, `price`,
        `found` and `missed` (of the targets), `false_alarms`, `collisions`, `energy_j` (null if no
        robot has a battery), `distance_m`, `robots_stopped`, in scenarios with goals those of goals
        and messages, for each item kind `found_KIND` and `missed_KIND`, and `found_KIND_1_s`,
        `found_KIND_2_s` and so on: the times of its first finds, at most 64. Counts are int64,
        `complete` is a bool. In a quarantined run (see `Outcome.status`), all columns but `run` are
        null; a time of something that never happened is null.

    Raises:
        InputError: If the scenario has errors or an argument is out of range; it lists all errors.
    """
    scenario = as_scenario(scenario)
    configuration = scenario.configuration({})
    runs = validation.plain_value("runs", runs)
    first_run = validation.plain_value("first_run", first_run)
    if brains is not None or controllers is not None:
        create = partial(
            Simulation, scenario, seed, threads=threads, brains=brains, controllers=controllers
        )
        rows = run_in_sequence(create, first_run, runs)
        names = [name for name, *_ in configuration.columns]
        values = {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}
    else:
        seed = validation.plain_value("seed", seed)
        threads = validation.plain_value("threads", threads)
        block = _core.run_block(
            [configuration], seed=seed, first_run=first_run, runs=runs, threads=threads
        )
        values = {name: array[0] for name, array in block.items()}
    return table(configuration.columns, values, scenario.merit, first_run)


def run_in_sequence(
    create: Callable[[int], Simulation], first_run: int, runs: int
) -> list[dict[str, float]]:
    """Return the outcome of each run by column; empty for a quarantined run."""
    validation.whole("runs", runs, 0, _core.MAX_RUNS)
    validation.whole("first_run", first_run, 0)
    return [finished(create, first_run + number) for number in range(runs)]


def finished(create: Callable[[int], Simulation], run: int) -> dict[str, float]:
    """Return the outcome of a run by column; empty if it is quarantined."""
    try:
        simulation = create(run)
    except _core.NoRoomError:
        return {}
    simulation.finish()
    return simulation._run.outcome() or {}  # noqa: SLF001  (ours)


def recorded(simulation: Stepped, path: Path) -> Outcome:
    """Run a simulation to its end and record it."""
    # Importing the writer takes longer than a typical run.
    from agent_economy.recording import Recording  # noqa: PLC0415

    with Recording(simulation, path) as recording:
        return recording.finish()
