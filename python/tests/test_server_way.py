"""What is said to a run that stands at a moment, or is on its way to one."""

import pytest
from watching import Page


def test_of_values_said_instead_of_each_other_the_last_is_the_change(page: Page) -> None:
    page.open(tick=40)
    for count in (5, 90, 6):
        page.say("change", path="robots.rover.count", value=count, replaces_last=count != 5)
    assert page.until("setting", changes=[[40, "robots.rover.count", 6]])
    page.say("undo")
    assert page.until("setting", changes=[])["kinds"][0]["count"] == 4


def test_a_run_on_its_way_to_a_moment_says_where_it_goes(page: Page) -> None:
    page.open(tick=0, changes=[[0, "clock.time_limit_s", 10_000], [0, "items.mine.count", 0]])
    page.say("step", steps=50_000)
    on_its_way = page.until("state", target_tick=50_000)
    assert on_its_way["tick"] < 50_000
    page.say("pause")
    assert page.until("state", target_tick=None)["tick"] < 50_000


ENDLESS = [[0, "clock.time_limit_s", 10_000], [0, "items.mine.count", 0]]


@pytest.mark.parametrize("way", ["step", "seek", "open", "undo"])
def test_a_change_said_on_the_way_to_a_moment_is_made_there(page: Page, way: str) -> None:
    page.open(changes=ENDLESS)
    page.say("step", steps=300)
    page.until("state", tick=300)
    match way:
        case "step":
            page.say("step", steps=-100)
        case "seek":
            page.say("seek", tick=200)
        case "open":
            page.say("open", scenario="search-beliefs", seed="7", changes=ENDLESS, tick=200)
        case "undo":
            page.say("seek", tick=100)
            page.until("state", tick=100)
            page.say("change", path="robots.rover.count", value=5)
            page.say("step", steps=100)
            page.until("state", tick=200)
            page.say("undo")
    page.say("change", path="robots.rover.count", value=3)
    assert page.until("setting", changes=[*ENDLESS, [200, "robots.rover.count", 3]])


def test_who_plays_on_the_way_plays_from_where_it_leads_unless_they_pause(page: Page) -> None:
    page.open(changes=ENDLESS)
    page.say("step", steps=150)
    page.say("play", speed=1)
    assert page.until("state", is_playing=True)["tick"] >= 150
    page.say("pause")
    page.until("state", is_playing=False)
    page.say("step", steps=90_000)
    page.say("play", speed=1)
    page.say("pause")
    page.say("step", steps=1)
    stood = page.until("state", target_tick=None)
    assert not stood["is_playing"]
    assert stood["tick"] < 90_000
