"""A live run that is fed while pages display it: they share it, and none moves it."""

import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from page_client import HEADER, OWN, WS, Page
from starlette.testclient import TestClient

import agent_economy as ae
from agent_economy import InputError
from agent_economy.recording.stops import Stop
from agent_economy.server import Workspace, app
from agent_economy.server.runs.display import MAX_IN_FLIGHT
from agent_economy.server.runs.live_run import LiveRun

ROBOT = "rover/0"
FOREVER_S = 60.0


class Feeder:
    """Feeds a live run with the percepts of one robot, and simulates the same run itself."""

    def __init__(self) -> None:
        """Begin a run; its other robots are simulated."""
        self.scenario = ae.Scenario.load("search-beliefs")
        self.live = LiveRun(self.scenario, 7, [ROBOT])
        self.same = ae.Simulation(self.scenario, 7, external=[ROBOT])
        self.twin = ae.Simulation(self.scenario, 7)

    def feed(self, steps: int) -> None:
        """Add the inputs of some steps."""
        for _ in range(steps):
            percept = self.twin.percept(ROBOT)
            inputs: dict[str, Any] = {"percepts": {} if percept is None else {ROBOT: percept}}
            self.live.append(self.same.tick, inputs)
            self.same.step(**inputs)
            self.twin.step()

    @property
    def hash(self) -> str:
        """The state that the live run has when it has used all inputs."""
        return f"{self.same.hash:016x}"


@pytest.fixture
def feeder() -> Feeder:
    """Return a feeder of a live run."""
    return Feeder()


@pytest.fixture
def live_client(tmp_path: Path, feeder: Feeder) -> Iterator[TestClient]:
    """Return a client of a server with that live run."""
    with TestClient(app(Workspace(tmp_path), "127.0.0.1", live=feeder.live), OWN) as client:
        yield client


def join(page: Page) -> dict[str, Any]:
    """Join the live run, and return the first state."""
    page.send("open", live=True)
    assert page.wait_for("opened")["is_live"]
    return page.wait_for("state")


def test_all_pages_see_the_present_also_those_that_join_late(
    live_client: TestClient, feeder: Feeder
) -> None:
    feeder.feed(30)
    with live_client.websocket_connect(WS) as one, live_client.websocket_connect(WS) as other:
        early, late = Page(one), Page(other)
        join(early)
        feeder.feed(30)
        assert early.wait_for("state", tick=60)["hash"] == feeder.hash
        assert join(late)["tick"] == 60
        feeder.feed(1)
        for page in (early, late):
            assert page.wait_for("state", tick=61)["hash"] == feeder.hash


@pytest.mark.parametrize(
    ("kind", "rest"),
    [
        ("step", {"steps": -1}),
        ("step", {"steps": 1}),
        ("seek", {"tick": 0}),
        ("change", {"path": "robots.rover.count", "value": 9}),
        ("undo", {}),
        ("play", {"speed": 1.0}),
        ("pause", {}),
    ],
)
def test_no_page_moves_or_changes_a_live_run(
    live_client: TestClient, feeder: Feeder, kind: str, rest: dict[str, Any]
) -> None:
    feeder.feed(20)
    with live_client.websocket_connect(WS) as socket:
        page = Page(socket)
        join(page)
        assert "This run is live" in page.refusal(kind, **rest)
        feeder.feed(5)
        assert page.wait_for("state", tick=25)["hash"] == feeder.hash


def test_a_page_that_is_frozen_delays_neither_the_run_nor_other_pages(
    live_client: TestClient, feeder: Feeder
) -> None:
    with live_client.websocket_connect(WS) as one, live_client.websocket_connect(WS) as other:
        frozen, page = Page(one, draws=False), Page(other)
        join(frozen)
        join(page)
        for _ in range(20):
            feeder.feed(10)
            time.sleep(0.04)
        assert page.wait_for("state", tick=200)["hash"] == feeder.hash
        assert frozen.refusal("pause")
        assert len(frozen.frames) <= MAX_IN_FLIGHT
        frozen.draws = True
        frozen.send("acknowledge", frame=HEADER.unpack_from(frozen.frames[-1])[6])
        assert frozen.wait_for("state", tick=200)["hash"] == feeder.hash


def test_each_page_of_a_live_run_selects_a_robot_of_its_own(
    live_client: TestClient, feeder: Feeder
) -> None:
    feeder.feed(20)
    with live_client.websocket_connect(WS) as one, live_client.websocket_connect(WS) as other:
        pages = [Page(one), Page(other)]
        for page, robot in zip(pages, ["rover/0", "rover/1"], strict=True):
            join(page)
            page.send("select", robot=robot)
            page.wait_for("map", robot=robot)
        feeder.feed(1)
        for page, robot in zip(pages, ["rover/0", "rover/1"], strict=True):
            shown = page.wait_for("state", tick=21)["inspection"]
            assert shown["robot"] == robot
            assert shown["belief_state"] == feeder.same.belief_state(robot)


def decided_tick(state: dict[str, Any], robot: str) -> int | None:
    """Return the tick of the decision in a state; the brains of the scenario step at even ones."""
    shown = state["inspection"]
    assert shown["robot"] == robot
    tick: int | None = shown["tick"]
    return tick


def test_a_page_that_selects_a_robot_keeps_the_decision_that_another_page_sees(
    live_client: TestClient, feeder: Feeder
) -> None:
    feeder.feed(20)
    with live_client.websocket_connect(WS) as one, live_client.websocket_connect(WS) as other:
        pages = {"rover/1": Page(one), "rover/2": Page(other)}
        for robot, page in pages.items():
            join(page)
            page.send("select", robot=robot)
            while page.wait_for("state")["inspection"] is None:
                pass
        for tick in range(21, 27):
            feeder.feed(1)
            for robot, page in pages.items():
                state = page.wait_for("state", tick=tick)
                assert decided_tick(state, robot) == tick - tick % 2


def test_external_robots_are_named_in_the_setting_of_a_live_run_and_of_its_recording(
    live_client: TestClient, feeder: Feeder
) -> None:
    feeder.feed(10)
    with live_client.websocket_connect(WS) as socket:
        page = Page(socket)
        page.send("open", live=True)
        assert page.wait_for("setting")["external"] == [ROBOT]
        page.send("save")
        name = page.wait_for("saved")["recording"]["id"]
        page.send("open", recording=name)
        page.wait_for("opened")
        assert page.wait_for("setting")["external"] == [ROBOT]
        page.send("open", scenario="classic")
        page.wait_for("opened")
        assert page.wait_for("setting")["external"] == []


def stops_of(page: Page) -> list[dict[str, Any]]:
    """Return the stops among the events that a page has received."""
    rows = [row for each in page.received if each["type"] == "events" for row in each["rows"]]
    return [row for row in rows if row["kind"] == "stopped"]


def test_the_stops_of_real_robots_are_events_at_their_steps_and_only_once_they_are_simulated(
    live_client: TestClient, feeder: Feeder
) -> None:
    feeder.feed(3)
    feeder.live.append(5, {}, [Stop(5, ROBOT, "stop", ("gps: too old",))])
    feeder.live.append(6, {}, [Stop(6, ROBOT, "move", ())])
    with live_client.websocket_connect(WS) as socket:
        page = Page(socket)
        join(page)
        while not (stops := stops_of(page)) or stops[-1]["tick"] < 6:
            page.next()
    assert [(each["tick"], each["of"], each["text"]) for each in stops] == [
        (5, ROBOT, "stopped: gps: too old"),
        (6, ROBOT, "may move again"),
    ]


def test_a_live_run_that_ended_is_displayed_as_ended(
    live_client: TestClient, feeder: Feeder
) -> None:
    with live_client.websocket_connect(WS) as socket:
        page = Page(socket)
        assert join(page)["is_playing"]
        feeder.feed(3)
        feeder.live.end()
        assert page.wait_for("state", is_playing=False)["tick"] == 3
        with pytest.raises(InputError, match="before the end of the live run"):
            feeder.live.append(3, {})


def test_a_live_run_is_saved_as_a_recording_that_replays(
    live_client: TestClient, feeder: Feeder
) -> None:
    feeder.feed(40)
    with live_client.websocket_connect(WS) as socket:
        page = Page(socket)
        join(page)
        page.send("save")
        name = page.wait_for("saved")["recording"]["id"]
        opened = page.open_recording(name, tick=40)
        assert (opened["hash"], opened["mismatch_tick"]) == (feeder.hash, None)
        assert join(page)["tick"] == 40


def test_a_server_without_a_live_run_refuses_to_open_it(page: Page) -> None:
    assert "a server with a live run" in page.refusal("open", live=True)


def test_an_input_that_is_not_allowed_ends_the_run_before_it(
    live_client: TestClient, feeder: Feeder
) -> None:
    with live_client.websocket_connect(WS) as socket:
        page = Page(socket)
        join(page)
        feeder.feed(3)
        feeder.live.append(3, {"percepts": {"other/0": {}}})
        assert "other/0" in page.wait_for("refused")["errors"][0]["message"]
        assert page.wait_for("state", is_playing=False)["tick"] == 3


def test_inputs_are_simulated_in_the_order_of_their_ticks_and_steps_between_have_none() -> None:
    live = LiveRun(ae.Scenario.load("search"), 7, [ROBOT])
    live.append(5, {})
    assert live.seek(live.latest_tick, FOREVER_S)
    assert live.tick == 6
    with pytest.raises(InputError, match="6 or more"):
        live.append(5, {})
