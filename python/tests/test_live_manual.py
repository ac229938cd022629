"""Driving by hand on the wire: what each control sends, and that silence sends stop."""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from live_bench import STOP_LINE, Bench, Drive, driving, emulated, fleet_text

import agent_economy as ae
from agent_economy.live.clock import now_s

ROBOT = "bender/0"


@dataclass
class Hand:
    """A client that drives a robot by hand."""

    drive: Drive
    bench: Bench
    number: int = 0
    state: dict[str, Any] = field(default_factory=dict)

    def ask(self, path: str, **body: Any) -> dict[str, Any]:
        """Send a request that must be accepted."""
        status, answer = self.drive.ask(path, client="hand", **body)
        assert status == 200, answer
        return answer

    def hold(self, left: int, right: int, time_s: float = 0.5) -> list[str]:
        """Hold a control for a time; return the motor lines that it caused, once each."""
        began_s = now_s()
        while now_s() - began_s < time_s:
            self.number += 1
            values = {"left": left, "right": right, "number": self.number}
            self.state = self.ask("/manual", robot=ROBOT, **values)["robots"][0]
            time.sleep(0.1)
        time.sleep(0.05)
        lines = [row["line"] for row in self.bench.lines(0) if row["t_s"] > began_s + 0.05]
        return list(dict.fromkeys(lines))

    def start(self) -> "Hand":
        """Switch to manual mode and arm the robot; return itself."""
        if self.ask("/state")["operator"] != "you":
            self.ask("/operator", take=True)
        if self.robot()["mode"] != "manual":
            self.ask("/mode", robot=ROBOT, mode="manual")
            time.sleep(0.1)  # the next turn
        self.arm(lambda: self.hold(150, 150, 0.2))
        deadline_s = now_s() + 20
        self.hold(150, 150, 0.3)
        while self.state["warnings"]:  # a stale input limits the speed
            assert now_s() < deadline_s, self.state["warnings"]
            self.hold(150, 150, 0.2)
        assert self.state["is_armed"], self.state
        return self

    def robot(self) -> dict[str, Any]:
        """Return the state of the robot."""
        return dict(self.ask("/state")["robots"][0])

    def arm(self, wait: Callable[[], object]) -> None:
        """Arm the robot as soon as nothing stops it."""
        deadline_s = now_s() + 20
        while not (robot := self.robot())["is_armed"] or robot["blockers"]:
            assert now_s() < deadline_s, robot["blockers"]
            self.drive.ask("/arm", client="hand")
            wait()


@pytest.fixture(scope="module")
def hand(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Hand]:
    """Drive an emulated robot by hand."""
    folder = tmp_path_factory.mktemp("hand")
    with emulated(folder) as bench:
        fleet = folder / "fleet.toml"
        fleet.write_text(fleet_text(bench), encoding="utf-8")
        with driving(fleet, headless=False) as drive:
            drive.wait_for(lambda each: each["type"] == "event")
            yield Hand(drive, bench)


@pytest.mark.parametrize(
    ("left", "right", "lines"),
    [
        (175, 175, ["x,2,175,"]),
        (100, 100, ["x,2,100,"]),
        (100, 200, ["x,0,100,", "x,1,200,"]),
        (155, 150, ["x,0,155,", "x,1,150,"]),
    ],
)
@repeated_if_late
def test_a_control_sends_what_it_shows_and_stop_sends_stop_only(
    hand: Hand, left: int, right: int, lines: list[str]
) -> None:
    armed = hand.start()
    assert armed.hold(left, right) == lines
    assert armed.state["written"]["line"] == " ".join(lines)
    assert armed.state["written"]["is_acknowledged"]
    assert armed.hold(150, 150) == [STOP_LINE]


@repeated_if_late
def test_a_silent_control_stops_the_robot_after_04_s(hand: Hand) -> None:
    armed = hand.start()
    armed.hold(160, 160, 0.5)
    last_s = armed.bench.moves_after(0, 0.0)[-1]
    time.sleep(1.0)
    stopped_s = armed.bench.stops_after(0, last_s)[0]
    assert armed.bench.moves_after(0, stopped_s) == []
    assert stopped_s - last_s < 0.8
    state = armed.ask("/state")["robots"][0]
    assert [each["name"] for each in state["faults"]] == ["no_setpoint"]
    assert state["requested"] is None


@repeated_if_late
def test_an_emergency_stop_of_any_client_wins_over_a_control_that_is_held(hand: Hand) -> None:
    armed = hand.start()
    armed.hold(160, 160, 0.3)
    assert armed.drive.ask("/stop")[0] == 200
    stopped_s = now_s() + 0.1
    assert armed.hold(160, 160, 1.0)[-1] == STOP_LINE
    assert armed.bench.moves_after(0, stopped_s) == []
    assert armed.ask("/state")["is_stopped"]
    armed.ask("/release")
    assert armed.hold(160, 160, 1.0) == [STOP_LINE]


@repeated_if_late
def test_a_robot_in_manual_mode_does_not_follow_its_waypoints(hand: Hand) -> None:
    armed = hand.start()
    quiet_s = now_s()
    armed.hold(150, 150, 2.0)
    assert armed.bench.moves_after(0, quiet_s) == []
    armed.ask("/mode", robot=ROBOT, mode="auto")
    time.sleep(3.0)
    assert armed.bench.moves_after(0, quiet_s) == []
    assert armed.drive.ask("/arm", client="hand")[0] == 200
    time.sleep(2.0)
    assert armed.bench.moves_after(0, quiet_s)
    armed.ask("/hold")
    held_s = now_s() + 0.2
    time.sleep(1.5)
    assert armed.bench.moves_after(0, held_s) == []
    state = armed.ask("/state")
    assert state["is_held"]
    assert state["robots"][0]["is_armed"]
    armed.ask("/resume")
    time.sleep(2.0)
    assert armed.bench.moves_after(0, held_s)
    armed.ask("/navigate", robot=ROBOT, is_on=False)
    off_s = now_s() + 0.2
    time.sleep(1.0)
    assert armed.bench.moves_after(0, off_s) == []


def test_an_ordered_waypoint_is_in_the_state_and_the_recording_replays(
    hand: Hand, tmp_path: Path
) -> None:
    del tmp_path
    hand.ask("/waypoint", robot=ROBOT, point_m=[20, 22])
    if hand.robot()["mode"] != "auto":
        hand.ask("/mode", robot=ROBOT, mode="auto")
    if not hand.robot()["navigates"]:
        hand.ask("/navigate", robot=ROBOT, is_on=True)
    hand.arm(lambda: time.sleep(0.2))
    hand.drive.wait_for(lambda each: each["type"] == "goal" and each["at_m"] == [20, 22])
    ordered = hand.ask("/state")["robots"][0]["waypoints"][-1]
    assert (ordered["x_m"], ordered["y_m"], ordered["verdict"]) == (20, 22, "pending")
    time.sleep(1.0)
    hand.drive.process.send_signal(2)
    assert hand.drive.wait() == 130
    replayed = ae.replay(hand.drive.record)
    assert replayed.mismatch_tick is None
