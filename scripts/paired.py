"""Comparison of two searches in the same worlds, for docs/validation.md."""

from collections.abc import Mapping, Sequence

from scipy import stats

Z99 = 2.576
"""Standard errors on either side of a 99% interval."""

ALL = 100
"""Percent."""

CAMERAS = [(100, 600), (30, 600), (10, 2400)]
"""Detection probability per scan in percent, and the time limit in seconds."""

HEADER = [
    "camera",
    "`lawnmower`, mean s",
    "`bayesian_search`, mean s",
    "ratio, 99% interval",
    "incomplete runs",
]


Worlds = Sequence[Mapping[str, float]]
"""The times of each world, by column."""


def compared(worlds: Worlds) -> list[list[str]]:
    """Return a line per camera."""
    return [line(worlds, percent, time_limit_s) for percent, time_limit_s in CAMERAS]


def line(worlds: Worlds, percent: int, time_limit_s: float) -> list[str]:
    """Return the times of both searches with a camera."""
    searches = ("lawnmower", "bayesian_search")
    both = [[world[f"{percent}_{search}_s"] for world in worlds] for search in searches]
    low, ratio, high = interval(*both)
    means = [f"{sum(each) / len(each):.1f}" for each in both]
    capped = [str(sum(time >= time_limit_s for time in each)) for each in both]
    with_interval = f"{ratio:.3f} ({low:.3f} to {high:.3f})"
    camera = "detects all in view" if percent == ALL else f"detects {percent}% per scan"
    return [camera, *means, with_interval, f"{' and '.join(capped)} after {time_limit_s:,} s"]


def interval(slow: list[float], fast: list[float]) -> tuple[float, float, float]:
    """Return the ratio of the means of paired values, between the bounds of its 99% interval."""
    ratio = sum(fast) / sum(slow)
    off = [after - ratio * before for before, after in zip(slow, fast, strict=True)]
    error = stats.sem(off) * len(off) / sum(slow)
    return ratio - Z99 * error, ratio, ratio + Z99 * error
