"""The format of numbers in a report."""

import math

from agent_economy import shares
from agent_economy.study.answer.evidence import Interval

UNKNOWN, NOTHING, INFINITE = "unknown", "\N{EN DASH}", "never"
MINUS, TIMES = "\N{MINUS SIGN}", "\N{MULTIPLICATION SIGN}"


def finite(number: float) -> float | None:
    """Return a number rounded to six figures; None if it is not finite."""
    return float(f"{number:.6g}") if math.isfinite(number) else None


def places(scale: float) -> int:
    """Return the number of decimals that shows two figures of a number of this size."""
    return max(0, 1 - math.floor(math.log10(scale))) if 0 < scale < math.inf else 2


def decimal(number: float, decimals: int) -> str:
    """Return a number with separators and a typographic minus: -1,234.5."""
    if not math.isfinite(number):
        return UNKNOWN
    written = f"{number:,.{decimals}f}".replace("-", MINUS)
    return written.lstrip(MINUS) if not written.strip(f"{MINUS}0.,") else written


def brief(number: float) -> str:
    """Return a number without trailing zeros: 0.05, 120."""
    return f"{number:g}".replace("-", MINUS)


def percent(share: float, decimals: int) -> str:
    """Return a share as a percentage, which is never rounded to none or all."""
    if not math.isfinite(share):
        return UNKNOWN
    return f"{decimal(100 * share, shares.places(share, decimals))}%"


def percent_span(interval: Interval, decimals: int) -> str:
    """Return the bounds of a share, which may be rounded outwards: "0.0% to 4.7%"."""
    low, high = interval.low, interval.high
    if not math.isfinite(high - low):
        return f"{UNKNOWN} to {UNKNOWN}"
    lower, upper = shares.bound_places(low, high, decimals)
    return f"{decimal(100 * low, lower)}% to {decimal(100 * high, upper)}%"


def count(number: int, word: str) -> str:
    """Return "1 run", "1,200 runs"."""
    return f"{number:,} {word}" if number == 1 else f"{number:,} {word}s"


def span(interval: Interval, decimals: int) -> str:
    """Return the bounds of an interval: "1.2 to 3.4"."""
    return f"{decimal(interval.low, decimals)} to {decimal(interval.high, decimals)}"
