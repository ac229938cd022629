"""`check` states what a pass of each item detector detects."""

from pathlib import Path

from command_line import run
from metric import world

import agent_economy as ae

LANE = world("""
clock.time_limit_s = 10
world.size_m = [20, 20]
items.clutter = { count = 1, target = false }
items.mine.count = 1
[robots.rover]
count = 1
radius_m = 0.2
drive.max_speed_m_s = 1
[robots.rover.sensors.camera]
kind = "items"
range_m = 1
detection_probability.mine = 0.1
blind_share.mine = 0.25
""")

NAME = "robots.rover.sensors.camera, mine"
TEXT = (
    "a pass at 1 m/s, with a measurement every 0.1 m, detects 65.9% on its path and 58.7% in its "
    "swath of 2.000 m; at most 75.0% however often it passes"
)


def test_check_prints_the_share_that_a_pass_and_all_passes_detect(tmp_path: Path) -> None:
    file = tmp_path / "lane.toml"
    file.write_text(LANE)
    assert ae.Scenario.load(file).derived == ((NAME, TEXT),)
    assert run("check", file).stdout.splitlines()[1:] == [f"    {NAME}: {TEXT}"]


def test_classic_scenarios_have_no_derived_quantities() -> None:
    assert ae.Scenario.load("classic").derived == ()


def test_errors_of_the_confusion_and_the_blind_share_are_listed_together(tmp_path: Path) -> None:
    file = tmp_path / "lane.toml"
    text = LANE.replace("mine = 0.25", "mien = 0.25")
    file.write_text(text + "confusion = { mine = { mine = 0.9, clutter = 0.2 } }\n")
    given = run("check", file)
    assert given.returncode == 2
    assert "blind_share.mien is not a known key: expected one of clutter, mine" in given.stderr
    assert "they sum to 1.1" in given.stderr
