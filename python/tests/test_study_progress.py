"""The progress of studies on the terminal."""

import io

import pytest
from rich.console import Console

from agent_economy import Scenario, study
from agent_economy.cli.run_progress import durations
from agent_economy.cli.study_progress import ProgressDisplay

NAMES = tuple(f"team {number}" for number in range(1, 9))


@pytest.mark.parametrize(
    ("ends", "words"),
    [
        ((3.2, 3.4), "3 s"),
        ((2.0, 12.0), "2 to 12 s"),
        ((50.0, 300.0), "50 s to 5 min"),
        ((600.0, 3600.0), "10 to 60 min"),
        ((3600.0, 21600.0), "60 min to 6 h"),
    ],
)
def test_a_range_of_durations_names_a_unit_once(ends: tuple[float, float], words: str) -> None:
    assert durations(*ends) == words


def test_the_time_left_is_a_range_after_the_first_rounds() -> None:
    left: list[tuple[int, study.Progress, tuple[float, float] | None]] = []

    def look(now: study.Progress) -> None:
        left.append((now.round, now, now.estimate_remaining()))

    scenario = Scenario.load("classic")
    study.run(scenario, vary={"robots.wanderer.count": "1..5"}, delta=0.05, on_progress=look)
    assert {each for number, _, each in left if number < 12} == {None}
    known = [(now, each) for number, now, each in left if number >= 12 and not now.is_over]
    assert known
    for now, each in known:
        assert each
        assert 0 < each[0] < each[1]
        seconds = now.time_left_s(each)
        assert seconds
        assert seconds[1] / seconds[0] == pytest.approx(each[1] / each[0])


def test_the_statuses_of_teams_are_shown_while_a_requirement_is_studied() -> None:
    shown = Console(file=io.StringIO(), width=80)
    display = ProgressDisplay(NAMES)

    def look(now: study.Progress) -> None:
        shown.print(display._leaders(now))

    study.run(
        "classic",
        vary={"robots.wanderer.count": "1..6"},
        require="time_s <= 40",
        probability=0.8,
        tolerance=0.1,
        on_progress=look,
    )
    file = shown.file
    assert isinstance(file, io.StringIO)
    text = file.getvalue()
    assert all(word in text for word in ("share", "status", "may meet", "certified", "open"))
    assert "merit" not in text
