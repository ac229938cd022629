"""The endpoint of the warden over real sockets: authority, limits, and a stop that never waits."""

import asyncio
import itertools
import json
import math
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from http.client import HTTPConnection
from typing import Any

import pytest
from bare_timer import repeated_if_late

from agent_economy.live import fleet, rules
from agent_economy.live.clock import now_s
from agent_economy.live.frame import frame_of, heading_rad, place_deg, position_m
from agent_economy.live.plan import FleetPlan
from agent_economy.live.readings import Quantity, Reading
from agent_economy.live.rules import Inputs, LoopInputs, Mode, Requests
from agent_economy.live.warden import authority, sentences
from agent_economy.live.warden.control import Control, Drive
from agent_economy.live.warden.endpoint import MAX_CONNECTIONS, Endpoint
from agent_economy.live.warden.event_log import MAX_EVENTS, EventLog
from agent_economy.live.warden.robot import DriveContext, Robot
from agent_economy.live.warden.warden import Warden

PLAN = fleet.load("bender").plan
FRAME = frame_of(PLAN.origin)
ORIGIN = "http://127.0.0.1:8000"


@dataclass
class Served:
    """An endpoint of a warden whose turns a test takes."""

    warden: Warden
    endpoint: Endpoint
    events: EventLog
    orders: list[Any]
    memory: rules.Memory

    def turn(self) -> Requests:
        """Take a turn of the rules; return the requests."""
        requests = self.warden.operator.take()
        now = now_s()
        robots = {name: robot.inputs(now) for name, robot in self.warden.robots.items()}
        inputs = Inputs(robots, LoopInputs(is_alive=True, last_message_s=now))
        self.memory, self.warden.outputs = rules.update(self.memory, PLAN, now, inputs, requests)
        return requests

    def ask(self, path: str, **body: Any) -> tuple[int, dict[str, Any]]:
        """Send a request; return the status and the answer."""
        link: HTTPConnection | None = body.pop("link", None)
        own = link or HTTPConnection(*self.endpoint.address, timeout=5)
        body = {"token": self.endpoint.token, **body}
        own.request("POST", path, json.dumps(body), {"Content-Type": "text/plain"})
        response = own.getresponse()
        answer = json.loads(response.read())
        if link is None:
            own.close()
        return response.status, answer


@contextmanager
def serving(plan: FleetPlan = PLAN) -> Iterator[Served]:
    """Serve a warden in a thread with an event loop of its own."""
    warden, events, orders = Warden(lambda _: None, is_headless=False), EventLog(), []
    context = DriveContext(frame_of(plan.origin), now_s, lambda *_: None)
    warden.robots = {each.name: Robot(each, context) for each in plan.robots}
    warden.order = lambda robot, point_m: orders.append((robot, point_m))  # type: ignore[method-assign]
    control = Control(warden, Drive(plan, "bender.toml", "bender.mcap"), events)
    endpoint = Endpoint(control.actions())
    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=loop.run_forever, daemon=True)
    thread.start()
    asyncio.run_coroutine_threadsafe(endpoint.start(), loop).result(5)
    served = Served(warden, endpoint, events, orders, rules.initial(PLAN))
    served.turn()
    try:
        yield served
    finally:
        loop.call_soon_threadsafe(endpoint.close)
        time.sleep(0.05)  # connections end
        loop.call_soon_threadsafe(loop.stop)
        thread.join(5)


@pytest.fixture
def served() -> Iterator[Served]:
    with serving() as each:
        yield each


def test_many_requests_use_one_connection_and_one_connection_per_request_works_too(
    served: Served,
) -> None:
    link = HTTPConnection(*served.endpoint.address, timeout=5)
    for _ in range(50):
        assert served.ask("/state", link=link, client="a", since=0)[0] == 200
    assert all(served.ask("/state", client="a", since=0)[0] == 200 for _ in range(20))
    link.close()


def test_a_stop_and_a_hold_are_in_the_state_from_their_requests_on(served: Served) -> None:
    for path, key in (("/stop", "is_stopped"), ("/hold", "is_held")):
        assert not served.ask("/state")[1][key]
        served.ask(path)
        assert served.ask("/state")[1][key]
        served.turn()
        assert served.ask("/state")[1][key]


def test_pages_of_other_origins_read_no_answers_and_can_only_stop_robots(served: Served) -> None:
    served.endpoint.allow(ORIGIN)
    evil = "http://evil.example"
    for sender, path, status in (
        ({"Origin": ORIGIN}, "/state", 200),
        ({"Origin": ORIGIN, "Sec-Fetch-Site": "same-site"}, "/state", 200),
        ({}, "/state", 200),
        ({"Sec-Fetch-Site": "none"}, "/state", 200),
        *(
            ({name: value}, path, status)
            for name, value in (
                ("Origin", evil),
                ("Sec-Fetch-Site", "cross-site"),
                ("Sec-Fetch-Site", "same-site"),
            )
            for path, status in (("/state", 403), ("/arm", 403), ("/stop", 200), ("/hold", 200))
        ),
    ):
        link = HTTPConnection(*served.endpoint.address, timeout=5)
        fields = {"Content-Type": "text/plain", **sender}
        link.request("POST", path, json.dumps({"token": served.endpoint.token}), fields)
        response = link.getresponse()
        assert response.status == status
        allowed = ORIGIN if sender.get("Origin") == ORIGIN else None
        assert response.getheader("Access-Control-Allow-Origin") == allowed
        link.close()


@repeated_if_late
def test_a_stop_is_not_delayed_by_requests_that_never_end_and_many_that_do(served: Served) -> None:
    idle = [socket.create_connection(served.endpoint.address) for _ in range(MAX_CONNECTIONS)]
    for each in idle:
        each.sendall(b"POST /state HTTP/1.1\r\nContent-Length: 60000\r\n\r\n{")
    ended = threading.Event()

    def flood() -> None:
        link = HTTPConnection(*served.endpoint.address, timeout=5)
        while not ended.wait(0.1):
            served.ask("/state", link=link, client="page", since=0)

    pages = [threading.Thread(target=flood) for _ in range(5)]
    for page in pages:
        page.start()
    delays_s = []
    for _ in range(20):
        began_s = time.monotonic()
        assert served.ask("/stop")[0] == 200
        delays_s.append(time.monotonic() - began_s)
        assert served.turn().stop
    ended.set()
    for page in pages:
        page.join(5)
    for each in idle:
        each.close()
    assert sorted(delays_s)[len(delays_s) // 2] < 0.1
    assert max(delays_s) < 1.0


def test_stop_and_hold_need_no_operator_and_are_never_refused(served: Served) -> None:
    assert served.ask("/operator", client="a", take=True)[0] == 200
    for client in ("a", "b", None):
        assert served.ask("/stop", client=client)[0] == 200
        assert served.turn().stop
        assert served.ask("/hold", client=client)[0] == 200
        assert served.turn().hold
    state = served.ask("/state", client="b", since=0)[1]
    assert (state["is_stopped"], state["is_held"], state["operator"]) == (True, True, "other")


GUARDED: dict[str, dict[str, Any]] = {
    "/release": {},
    "/arm": {},
    "/resume": {},
    "/mode": {"robot": "bender/0", "mode": "manual"},
    "/waypoint": {"robot": "bender/0", "point_m": [10, 10]},
    "/navigate": {"robot": "bender/0", "is_on": False},
}


@pytest.mark.parametrize("path", GUARDED)
def test_another_client_is_refused_while_one_is_the_operator(served: Served, path: str) -> None:
    served.ask("/operator", client="a", take=True)
    served.ask("/stop")
    served.ask("/hold")
    served.turn()
    status, answer = served.ask(path, client="b", **GUARDED[path])
    assert (status, answer["message"]) == (409, "another client is the operator")
    status, answer = served.ask(path, client="a", **GUARDED[path])
    assert status == (409 if path == "/arm" else 200), answer


def test_a_client_that_is_silent_for_three_seconds_is_the_operator_no_more(
    served: Served, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(authority, "SEEN_S", 0.3)
    served.ask("/operator", client="a", take=True)
    for _ in range(5):
        time.sleep(0.1)
        assert served.ask("/state", client="a")[1]["operator"] == "you"
    assert served.ask("/operator", client="b", take=True)[0] == 409
    time.sleep(0.5)
    assert served.ask("/state", client="a")[1]["operator"] is None
    assert served.ask("/operator", client="b", take=True)[0] == 200
    assert served.ask("/state", client="a")[1]["operator"] == "other"


def by_hand(served: Served, number: int, left: int = 160, **body: Any) -> tuple[int, Any]:
    values = {"client": "a", "robot": "bender/0", "left": left, "right": 150, "number": number}
    return served.ask("/manual", **values | body)


def tracks(served: Served) -> tuple[int, int] | None:
    setpoint = served.warden.robots["bender/0"].manual
    return None if setpoint is None else setpoint.motion.tracks


@pytest.fixture
def manual(served: Served) -> Served:
    served.ask("/operator", client="a", take=True)
    served.ask("/mode", client="a", robot="bender/0", mode="manual")
    assert served.turn().mode == {"bender/0": Mode.MANUAL}
    return served


def test_a_control_acts_for_the_operator_in_manual_mode_only(served: Served) -> None:
    assert by_hand(served, 1)[0] == 409
    served.ask("/operator", client="a", take=True)
    status, answer = by_hand(served, 1)
    assert (status, answer["message"]) == (409, "bender/0 is not in manual mode")
    served.ask("/mode", client="a", robot="bender/0", mode="manual")
    served.turn()
    status, state = by_hand(served, 1)
    assert status == 200
    assert state["robots"][0]["requested"]["speed_m_s"] == pytest.approx(0.1)
    assert by_hand(served, 2, client="b")[0] == 409


def test_a_request_that_a_newer_one_overtook_is_refused(manual: Served) -> None:
    assert by_hand(manual, 5, 170)[0] == 200
    for late in (4, 5):
        status, answer = by_hand(manual, late, 200)
        assert status == 409
        assert answer["message"] == (
            f"number {late} is overtaken: a request with number 5 came before"
        )
        assert tracks(manual) == (170, 150)
    by_hand(manual, 6, 180)
    assert tracks(manual) == (180, 150)


def test_a_takeover_stops_what_the_other_drives_by_hand(manual: Served) -> None:
    by_hand(manual, 1)
    assert manual.ask("/operator", client="b", take=True)[0] == 409
    assert tracks(manual) == (160, 150)
    assert manual.ask("/operator", client="b", take=True, take_over=True)[0] == 200
    assert tracks(manual) is None
    assert by_hand(manual, 2)[0] == 409
    assert by_hand(manual, 1, client="b")[0] == 200


@pytest.mark.parametrize(
    "body",
    [
        {"left": 99},
        {"left": 150.0},
        {"left": True},
        {"number": "2"},
        {"robot": "bender/7"},
        {"robot": []},
    ],
)
def test_a_control_with_values_that_no_slider_has_is_refused(
    manual: Served, body: dict[str, Any]
) -> None:
    values: dict[str, Any] = {"client": "a", "robot": "bender/0", "left": 160, "right": 150}
    assert manual.ask("/manual", **{"number": 2, **values, **body})[0] == 409
    assert tracks(manual) is None


@pytest.mark.parametrize(
    "place",
    [
        {"point_m": [0.5, 15]},  # outside the fence
        {"point_m": [50, 15]},
        {"point_m": [1e400, 2]},
        {"point_m": [10**400, 2]},
        {"point_m": ["a", 2]},
        {"point_m": [2]},
        {},
        {"latitude": {"degrees": 36, "minutes": 35.7, "hemisphere": "N"}},
        {
            "latitude": {"degrees": 36, "minutes": 75, "hemisphere": "N"},
            "longitude": {"degrees": 121, "minutes": 52.5, "hemisphere": "W"},
        },
    ],
)
def test_a_waypoint_that_is_no_place_of_the_fence_is_refused(
    served: Served, place: dict[str, Any]
) -> None:
    status, answer = served.ask("/waypoint", client="a", robot="bender/0", **place)
    assert status == 409, answer
    assert not served.orders


def test_the_errors_of_latitude_and_longitude_are_reported_together(served: Served) -> None:
    place = {"latitude": {"degrees": 91, "minutes": 0, "hemisphere": "N"}, "longitude": 5}
    _, answer = served.ask("/waypoint", client="a", robot="bender/0", **place)
    assert "latitude must be" in answer["message"]
    assert "longitude must have" in answer["message"]


def test_a_waypoint_may_be_in_degrees_and_minutes(served: Served) -> None:
    latitude_deg, longitude_deg = FRAME.to_geographic(20.0, 10.0)
    angles: dict[str, Any] = {
        name: {"degrees": int(value), "minutes": value % 1 * 60, "hemisphere": letter}
        for name, value, letter in (
            ("latitude", latitude_deg, "N"),
            ("longitude", -longitude_deg, "W"),
        )
    }
    assert served.ask("/waypoint", client="a", robot="bender/0", **angles)[0] == 200
    [(robot, point_m)] = served.orders
    assert robot == "bender/0"
    assert point_m == pytest.approx((20.0, 10.0), abs=1e-4)


def test_geographic_positions_are_the_inverse_of_those_in_the_world() -> None:
    for x_m, y_m in itertools.product((0.0, 37.0, 900.0), (-400.0, 0.0, 20.0)):
        place = place_deg(FRAME, x_m, y_m)
        assert place is not None
        assert position_m(FRAME, *place) == pytest.approx((x_m, y_m), abs=1e-6)


def test_a_state_has_the_events_after_a_number_and_the_last_thousand_at_most(
    served: Served,
) -> None:
    for number in range(MAX_EVENTS + 10):
        served.events.add("info", None, f"event {number}")
    events = served.ask("/state", since=0)[1]["events"]
    assert len(events) == MAX_EVENTS
    assert events[-1]["number"] == MAX_EVENTS + 10
    assert [each["number"] for each in served.ask("/state", since=1005)[1]["events"]] == list(
        range(1006, 1011)
    )


def test_before_anything_is_known_of_a_robot_its_state_claims_nothing(served: Served) -> None:
    [robot] = served.ask("/state", client="a", since=0)[1]["robots"]
    nothing = ("requested", "written", "position", "heading", "ranges")
    assert all(robot[key] is None for key in nothing)
    assert not robot["is_standing"]
    assert not robot["is_armed"]
    assert {link["state"] for link in robot["links"]} == {"connecting"}
    assert robot["battery"] == {"share": pytest.approx(1.0), "is_estimated": True}
    assert {"lost_link", "missing_input", "no_setpoint"} <= {
        each["name"] for each in robot["blockers"]
    }


def test_each_reading_of_a_state_names_its_port(served: Served) -> None:
    robot = served.warden.robots["bender/0"]
    robot.readings["compass"] = (
        Reading(Quantity.HEADING, (heading_rad(FRAME, 187.5),)),
        now_s(),
    )
    robot.readings["sonar"] = (Reading(Quantity.RANGES, (2.0,) * 6), now_s())
    [state] = served.ask("/state", client="a", since=0)[1]["robots"]
    heading = state["heading"]
    assert (heading["port"], heading["magnetic_deg"]) == ("compass", pytest.approx(187.5))
    # East of north by 187.5 and 14.5 degrees of declination, anticlockwise from east.
    assert heading["world_deg"] == pytest.approx(90 - 187.5 - 14.5 + 360)
    assert state["ranges"]["port"] == "sonar"


def test_a_position_far_from_the_world_is_shown_without_latitude_and_longitude(
    served: Served,
) -> None:
    robot = served.warden.robots["bender/0"]
    for values, shown in (
        ((9e6, 2.0), {"x_m": 9e6, "y_m": 2.0, "latitude_deg": None, "longitude_deg": None}),
        ((0.0, 0.0), {"latitude_deg": pytest.approx(36.595267), "x_m": 0.0}),
    ):
        robot.readings["gps"] = (Reading(Quantity.POSITION, values), now_s())
        [state] = served.ask("/state", client="a", since=0)[1]["robots"]
        assert {key: state["position"][key] for key in shown} == shown
    robot.readings["gps"] = (Reading(Quantity.POSITION, (math.nan, math.nan)), now_s())
    robot.readings["compass"] = (Reading(Quantity.HEADING, (math.nan,)), now_s())
    [state] = served.ask("/state", client="a", since=0)[1]["robots"]
    assert (state["position"], state["heading"]) == (None, None)


def test_only_the_value_of_a_doubted_port_is_confirmed_by_hand(served: Served) -> None:
    served.turn()
    body = {"client": "a", "robot": "bender/0", "port": "compass"}
    status, answer = served.ask("/confirm", **body)
    assert (status, answer["message"]) == (
        409,
        "compass of bender/0 is not doubted: there is nothing to confirm",
    )
    decision = served.warden.outputs.robots["bender/0"]
    robots = {"bender/0": replace(decision, doubted=("compass",))}
    served.warden.outputs = replace(served.warden.outputs, robots=robots)
    assert served.ask("/state")[1]["robots"][0]["doubted"] == ["compass"]
    assert served.ask("/confirm", **body | {"port": "motors"})[0] == 409
    assert served.ask("/confirm", **body)[0] == 200
    assert served.turn().confirm == {"bender/0": {"compass"}}


@pytest.mark.parametrize(
    ("speed_m_s", "shown"), [(0.2101, "0.22"), (0.22, "0.22"), (0.07, "0.07"), (0.29, "0.29")]
)
def test_the_motion_that_would_go_unseen_is_rounded_up_in_words(
    speed_m_s: float, shown: str
) -> None:
    text = sentences.confirmation({"unconfirmed": [], "unseen_speed_m_s": speed_m_s})
    assert text == f" All robots stand: slower than {shown} m/s."


def test_the_end_of_a_drive_with_an_open_connection_is_no_error(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def drive() -> None:
        endpoint = Endpoint({})
        await endpoint.start()
        await asyncio.open_connection(*endpoint.address)
        await asyncio.sleep(0.1)
        endpoint.close()

    asyncio.run(drive())
    assert caplog.records == []
