"""Messages to a run that is paused, or seeks a tick."""

import pytest
from page_client import Page

ENDLESS = [[0, "clock.time_limit_s", 10_000], [0, "items.mine.count", 0]]


def test_only_the_last_of_replaced_values_is_logged(page: Page) -> None:
    page.open(tick=40)
    for count in (5, 90, 6):
        page.send("change", path="robots.rover.count", value=count, replaces_last=count != 5)
    assert page.wait_for("setting", changes=[[40, "robots.rover.count", 6]])
    page.send("undo")
    assert page.wait_for("setting", changes=[])["kinds"][0]["count"] == 4


def test_a_seeking_run_reports_its_target(page: Page) -> None:
    page.open(changes=ENDLESS)
    page.send("step", steps=50_000)
    on_its_way = page.wait_for("state", target_tick=50_000)
    assert on_its_way["tick"] < 50_000
    page.send("pause")
    assert page.wait_for("state", target_tick=None)["tick"] < 50_000


@pytest.mark.parametrize("way", ["step", "seek", "open", "undo"])
def test_a_change_requested_during_a_seek_is_made_at_the_target(page: Page, way: str) -> None:
    page.open(changes=ENDLESS)
    page.step(300, to=300)
    match way:
        case "step":
            page.send("step", steps=-100)
        case "seek":
            page.send("seek", tick=200)
        case "open":
            page.send("open", scenario="search-beliefs", seed="7", changes=ENDLESS, tick=200)
        case "undo":
            page.seek(100)
            page.send("change", path="robots.rover.count", value=5)
            page.step(100, to=200)
            page.send("undo")
    page.send("change", path="robots.rover.count", value=3)
    assert page.wait_for("setting", changes=[*ENDLESS, [200, "robots.rover.count", 3]])


def test_playback_requested_during_a_seek_starts_at_the_target_unless_paused(page: Page) -> None:
    page.open(changes=ENDLESS)
    page.send("step", steps=150)
    page.send("play", speed=1)
    assert page.wait_for("state", is_playing=True)["tick"] >= 150
    page.send("pause")
    page.wait_for("state", is_playing=False)
    page.send("step", steps=90_000)
    page.send("play", speed=1)
    page.send("pause")
    page.send("step", steps=1)
    stood = page.wait_for("state", target_tick=None)
    assert not stood["is_playing"]
    assert stood["tick"] < 90_000
