"""Single runs of a study: consecutive ones, or a sample from the worst to the best."""

from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import arrow, study
from agent_economy.scenario.merit import Merit
from agent_economy.scenario.validation import whole
from agent_economy.study import Plan
from agent_economy.study.answer.labels import label

MAX_ROWS = 1000
"""Maximum number of runs in a response."""

OWN = ("configuration", "quarantined")
"""Columns that are not outcomes."""

Floats = NDArray[np.float64]


def listed(plan: Plan, folder: Path, configuration: int, first: int, count: int) -> dict[str, Any]:
    """Return consecutive runs of a configuration.

    Raises:
        InputError: If an argument is not allowed, or the study is damaged.
    """
    whole("first", first, 0)
    whole("count", count, 1, MAX_ROWS)
    runs = rows(plan, folder, configuration)
    found = runs.order("run").limit(count, first).to_arrow_table()
    return response(plan, configuration, counted(runs), found)


def sampled(plan: Plan, folder: Path, configuration: int, count: int) -> dict[str, Any]:
    """Return runs of a configuration at evenly spaced quantiles from the worst to the best.

    Raises:
        InputError: If an argument is not allowed, or the study is damaged.
    """
    whole("sample", count, 1, MAX_ROWS)
    found = rows(plan, folder, configuration).order("run").to_arrow_table()
    merits = scores(plan.scenario.merit, found)
    # A run without a merit is the worst.
    order = np.argsort(np.nan_to_num(merits, nan=-np.inf), kind="stable")
    quantiles = np.linspace(0, 1, min(count, len(order)))
    places = np.rint(quantiles * (len(order) - 1)).astype(int)
    answer = response(plan, configuration, len(found), found.take(order[places]))
    for run, quantile in zip(answer["runs"], quantiles.tolist(), strict=True):
        run["quantile"] = quantile
    return answer


def median(plan: Plan, folder: Path, configuration: int) -> dict[str, Any]:
    """Return the median run of a configuration, by what is typical of the study's question.

    Raises:
        InputError: If an argument is not allowed, or the study is damaged.
    """
    found = rows(plan, folder, configuration).order("run").to_arrow_table()
    typical = plan.question.typical
    if typical in found.column_names:
        values = floats(found[typical], arrow.numbers(found["quarantined"]))
    else:
        values = scores(plan.scenario.merit, found)
    order = np.argsort(np.nan_to_num(values, nan=-np.inf), kind="stable")
    middle = order[(len(order) - 1) // 2 :][:1]
    return response(plan, configuration, len(found), found.take(middle))


def rows(plan: Plan, folder: Path, configuration: int) -> Any:
    """Return the runs of a configuration as a relation of DuckDB.

    Raises:
        InputError: If there is no such configuration, or the study is damaged.
    """
    whole("configuration", configuration, 0, len(plan.configurations) - 1)
    return study.open(folder).runs().filter(f"configuration = {configuration}")


def counted(runs: Any) -> int:
    """Return the number of runs."""
    return int(runs.aggregate("count(*)").fetchall()[0][0])


def response(plan: Plan, configuration: int, total: int, found: pa.Table) -> dict[str, Any]:
    """Return runs as the page takes them."""
    merits = scores(plan.scenario.merit, found).tolist()
    columns = [name for name in found.column_names if name not in OWN]
    runs = found.select(columns).to_pylist()
    return {
        "configuration": configuration,
        "label": label(plan.configurations[configuration]),
        "total": total,
        "runs": [
            {**run, "run": str(run["run"]), "merit": merit if np.isfinite(merit) else None}
            for run, merit in zip(runs, merits, strict=True)
        ],
    }


def scores(merit: Merit, found: pa.Table) -> Floats:
    """Return the merit of each run; NaN if it has none."""
    if not found.num_rows:  # A study that has not begun does not have its columns yet.
        return np.empty(0)
    quarantined = arrow.numbers(found["quarantined"])
    columns = {name: floats(found[name], quarantined) for name in merit.columns}
    score: Floats = merit.score(columns)
    return np.where(np.isfinite(score), score, np.nan)


def floats(column: Any, quarantined: NDArray[np.uint8]) -> Floats:
    """Return a column of the store; null becomes infinity, or NaN in a quarantined run."""
    values = arrow.floats(column, np.nan)
    absent = np.where(quarantined, np.nan, np.inf)
    return np.where(np.isnan(values), absent, values)
