"""Tables on narrow terminals and in pipes: no column and no name is lost."""

import re
from pathlib import Path

import pytest
from command_line import succeed

PATHS = [f"robots.rover.sensors.{sensor}.range_m" for sensor in ("camera", "lidar")]


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the folder of a study of three factors, two of which have long names."""
    folder = tmp_path_factory.mktemp("study")
    factors = ["robots.rover.count=1..2", *(f"{path}=5,10" for path in PATHS)]
    options = [word for each in factors for word in ("--vary", each)]
    succeed("study", "search", *options, "--runs", "2", "--out", folder)
    return folder


@pytest.fixture(params=["20", "40", "60"])
def columns(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Set the width of the terminal."""
    monkeypatch.setenv("COLUMNS", request.param)


@pytest.fixture
def terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    """Have rich print as on a terminal."""
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("NO_COLOR", "1")


def lines(*arguments: str | Path) -> list[str]:
    """Return what a command prints, without styles."""
    return re.sub(r"\x1b\[[0-9;]*m", "", succeed(*arguments).stdout).splitlines()


@pytest.mark.usefixtures("columns")
def test_a_piped_answer_has_one_line_per_configuration(answered: Path) -> None:
    printed = lines("report", answered)
    for robots in ("1 rover", "2 rovers"):
        for camera in (5, 10):
            for lidar in (5, 10):
                name = f"  {robots}, {PATHS[0]} {camera}, {PATHS[1]} {lidar} "
                (line,) = (line for line in printed if line.startswith(name))
                assert re.search(r"(best|undecided|worse|tied.*) *$", line)


@pytest.mark.usefixtures("columns", "terminal")
def test_a_narrow_terminal_shows_all_columns_of_an_answer(answered: Path) -> None:
    printed = lines("report", answered)
    rows = [line for line in printed if re.match(r"  [12] rovers?,", line)]
    assert len(rows) == 8
    assert all(re.search(r"(%|none).*(best|undecided|worse|tied.*) *$", row) for row in rows)


@pytest.mark.parametrize("is_terminal", [False, True])
@pytest.mark.usefixtures("columns")
def test_a_run_and_a_table_of_runs_have_all_values(
    request: pytest.FixtureRequest, *, is_terminal: bool
) -> None:
    if is_terminal:
        request.getfixturevalue("terminal")
    assert any(re.match(r"  time +[\d.]+ s of 120 s *$", line) for line in lines("run", "search"))
    assert any(
        re.match(r"  time_s +3 +[\d.]+ +[\d.]+ \.\. [\d.]+ +[\d.]+ +[\d.]+ *$", line)
        for line in lines("replicate", "search", "--runs", "3")
    )
