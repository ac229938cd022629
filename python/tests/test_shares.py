"""Shares in words are never rounded to none or all of the runs."""

from typing import Any

import pytest

from agent_economy.cli.lane_rows import lane_rows
from agent_economy.shares import of_runs, percent, percent_bounds
from agent_economy.study.answer.best import failed_cell
from agent_economy.study.answer.evidence import Interval
from agent_economy.study.answer.verdict import in_runs
from agent_economy.study.report import formatting, tables


@pytest.mark.parametrize(
    ("share", "written"),
    [
        (0.0, "0.0%"),
        (1.0, "100.0%"),
        (0.047, "4.7%"),
        (0.0006, "0.1%"),
        (0.0004, "0.04%"),
        (1 / 20_000, "0.005%"),
        (1 - 1 / 20_000, "99.995%"),
        (0.9996, "99.96%"),
        (1e-12, "0.0%"),
    ],
)
def test_a_percentage_has_as_many_decimals_as_tell_it_from_none_and_all(
    share: float, written: str
) -> None:
    assert percent(share) == formatting.percent(share, 1) == written


def test_bounds_are_rounded_outwards_only() -> None:
    assert percent_bounds(0.0002, 0.9998) == ("0.0%", "100.0%")
    assert percent_bounds(0.9998, 1.0) == ("99.98%", "100.0%")
    assert percent_bounds(0.0, 0.0002) == ("0.0%", "0.02%")
    cell = tables.shares(Interval(0.0001, 0.0, 0.0002), 1)
    assert (cell.text, cell.range) == ("0.01%", "0.0% to 0.02%")


def test_rare_runs_are_counted() -> None:
    assert of_runs(1 / 20_000, 20_000, "missions") == "1 of 20,000 missions"
    assert of_runs(0.047, 1000, "missions") == "4.7% of missions"
    assert of_runs(0.0, 1000, "runs", decimals=2) == "0.00% of runs"
    assert in_runs(0.9999) == "9,999 in 10,000"
    assert in_runs(1.0) == "100 in 100"


def test_a_terminal_shows_rare_failures() -> None:
    rare = Interval(0.00002, 0.0, 0.00004)
    assert failed_cell(rare, ranges=True) == "0.002% (0.00%..0.004%)"
    assert failed_cell(Interval(0.0, 0.0, 0.00004), ranges=True) == "none (..0.004%)"
    row: dict[str, Any] = {"declared": True, "declared_s": 60.0, "stated_risk": 0.0002}
    ((_, stated),) = lane_rows({**row, "declared_not_clear": False})
    assert stated == "declared clear at 60 s with a stated risk of 0.02%"
