"""Shares of runs in words. A share is never rounded to none or all of the runs."""

import math

MIN_SHARE = 1e-9
"""Shares that differ by less from none or all are rounding errors."""


def percent(share: float, decimals: int = 1) -> str:
    """Return a share as a percentage: 4.7%, 0.005%, 99.995%."""
    return f"{share:z.{places(share, decimals)}%}"


def percent_bounds(low: float, high: float, decimals: int = 1) -> tuple[str, str]:
    """Return the bounds of a share as percentages.

    They may be rounded outwards: "0.0% to 4.7%", but not "0.0% to 0.0%".
    """
    lower, upper = bound_places(low, high, decimals)
    return f"{low:z.{lower}%}", f"{high:z.{upper}%}"


def of_runs(share: float, runs: int, noun: str, decimals: int = 1) -> str:
    """Return a share of runs: "4.7% of missions".

    Where that would be rounded to none or all, it is their number: "1 of 20,000 missions".
    """
    if vanishes(share, decimals):
        return f"{round(share * runs):,} of {runs:,} {noun}"
    return f"{share:.{decimals}%} of {noun}"


def places(share: float, decimals: int) -> int:
    """Return the decimals of a percentage, more where it would be rounded to none or all."""
    if not vanishes(share, decimals):
        return decimals
    return -math.floor(math.log10(100 * min(share, 1 - share)))


def bound_places(low: float, high: float, decimals: int) -> tuple[int, int]:
    """Return the decimals of two bounds: the lower is not rounded to all, nor the upper to none."""
    return places(max(low, 0.5), decimals), places(min(high, 0.5), decimals)


def vanishes(share: float, decimals: int) -> bool:
    """Return whether a share that is neither none nor all would be rounded to it."""
    is_between = MIN_SHARE < share < 1 - MIN_SHARE
    return is_between and round(100 * share, decimals) in (0.0, 100.0)
