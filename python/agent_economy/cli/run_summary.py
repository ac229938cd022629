"""Means of many runs with 95% intervals; quarantined runs count as in a study."""

from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from agent_economy import _core, arrow
from agent_economy.runs.outcome import find_times
from agent_economy.scenario import Scenario
from agent_economy.scenario.merit import Bounds
from agent_economy.study.answer import estimate

EVENTS = {
    "collisions",
    "false_alarms",
    "goals_refused",
    "leases_lapsed",
    "messages_dropped",
    "messages_sent",
    "paints",
}
"""Counts of events: their greatest possible value, if any, is too large to limit a mean."""

PARTS_OF_GOALS = {
    "waiting_s",
    "travel_s",
    "blocked_s",
    "service_s",
    "served_twice",
    "expired",
    "issued",
    "open",
    "reported",
    "unknown",
    "done_in_error",
}
"""Columns of goals of which a quarantined run has no worst value."""

NOT_JUDGED = EVENTS | PARTS_OF_GOALS | {"energy_j", "distance_m", "robots_stopped"}
"""Columns without a worst value: their means leave quarantined runs out.

So do those of the times of finds, which also leave out the runs without that find.
"""

BEST_IF_GREAT = ("complete", "found", "merit", "served")
"""First words of columns whose worst value is the smallest; of others, it is the greatest."""

Floats = NDArray[np.float64]
Summary = list[dict[str, Any]]


def summarised(scenario: Scenario, table: pa.Table) -> Summary:
    """Return the mean of each column with its 95% interval; for a flag, the share.

    A quarantined run counts with the worst value of a column, if it has one.
    """
    columns = scenario.configuration({}).columns
    bounds: dict[str, Bounds] = {name: (low, high) for name, _, low, high in columns}
    bounds |= {"complete": (0.0, 1.0), "merit": scenario.merit.bounds(bounds)}
    are_quarantined = quarantined(table)
    are_not_judged = NOT_JUDGED | find_times(bounds)
    rows: Summary = []
    for name in table.column_names[1:]:
        values = arrow.floats(table[name], np.nan)
        if name not in are_not_judged:
            values[are_quarantined] = worst(name, bounds[name])
        counted = values[np.isfinite(values)]
        rows.append({"column": name, **summary_of(name, counted, bounds[name])})
    return rows


def quarantined(table: pa.Table) -> NDArray[np.bool_]:
    """Return which runs of a table are quarantined."""
    return np.isnan(arrow.floats(table["complete"], np.nan))


def worst(name: str, bounds: Bounds) -> float:
    """Return the worst value of a column; NaN if it has none."""
    low, high = bounds
    end = low if name.partition("_")[0] in BEST_IF_GREAT else high
    return np.nan if end is None else end


def summary_of(name: str, values: Floats, bounds: Bounds) -> dict[str, Any]:
    """Return the number of values, their mean, its interval, minimum and maximum."""
    count = len(values)
    if count == 0:
        return dict.fromkeys(("mean", "low", "high", "minimum", "maximum")) | {"runs": 0}
    mean, low, high = interval(name, values, bounds)
    is_share = name == "complete"
    ends = {
        "minimum": None if is_share else float(values.min()),
        "maximum": None if is_share else float(values.max()),
    }
    return {"runs": count, "mean": mean, "low": low, "high": high, **ends}


def interval(name: str, values: Floats, bounds: Bounds) -> tuple[float, float | None, float | None]:
    """Return a mean and the ends of its 95% interval, which are possible values; None for none.

    Shares have exact intervals, and means of bounded values those of `mean_bounds`, which hold for
    any distribution. Student's interval remains for counts of events; it is undefined if all values
    are the same.
    """
    if name == "complete":
        share = estimate.share(int(values.sum()), len(values))
        return share.value, share.low, share.high
    mean = float(values.mean())
    low = -np.inf if bounds[0] is None else bounds[0]
    high = np.inf if bounds[1] is None else bounds[1]
    if np.isfinite([low, high]).all() and name not in EVENTS:
        low, high = _core.mean_bounds(values, low, high, (1 - estimate.CONFIDENCE) / 2)
        return mean, min(low, mean), max(high, mean)  # a mean at a bound may be rounded
    if np.ptp(values) == 0:
        return mean, None, None
    student = estimate.mean(values)
    return mean, max(student.low, low), min(student.high, high)
