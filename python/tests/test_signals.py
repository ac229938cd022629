"""Signals of a run: the same samples whatever a page has displayed of it."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest
from page_client import Page

import agent_economy as ae
from agent_economy.runs.stepped import Change
from agent_economy.server.runs.signals import sampler
from agent_economy.server.runs.signals.sampler import Sampler
from agent_economy.server.runs.timeline import Timeline

FOREVER_S = 60.0
ROVERS = "robots.rover.count"
SIGNALS = (
    "body/rover/1/x_m",
    "robot/rover/0/command/motion/speed_m_s",
    "robot/rover/2/percept/position/value/0",
)

Rows = list[tuple[int, list[float | None]]]


def begun(log: tuple[Change, ...] = ()) -> Timeline:
    return Timeline(ae.Scenario.load("search-beliefs"), 7, 0, log)


def sampled(made: Sampler) -> Rows:
    """Return all samples, after the run has been sampled to its latest tick."""
    made.advance(0.0)
    while made.is_behind:
        made.advance(1.0)
    return [*made._rows]


def straight(signals: Sequence[str], log: tuple[Change, ...], until: int) -> Rows:
    """Return the values of a run that is stepped once, with one inspector for each robot."""
    timelines = {robot: begun(log) for robot in ("rover/0", "rover/2")}
    rows: Rows = []
    values: dict[str, Any] = {}
    for tick in range(until + 1):
        for robot, timeline in timelines.items():
            timeline.seek(tick, FOREVER_S)
            simulation: Any = timeline.simulation
            simulation.inspect(robot)
            values[robot] = simulation.inspection() or values.get(robot)
            x_m = simulation.poses[1, 0] if len(simulation.robots) > 1 else None
        first, seen = values["rover/0"], values["rover/2"]
        speed = None if first is None else first["command"]["motion"]["speed_m_s"]
        place = None if seen is None else seen["percept"]["position"]
        rows.append((tick, [x_m, speed, place and place["value"][0]][: len(signals)]))
    return rows


def test_samples_are_the_values_of_the_run_at_each_step() -> None:
    timeline = begun()
    made = Sampler(timeline, SIGNALS)
    timeline.seek(60, FOREVER_S)
    assert sampled(made) == straight(SIGNALS, (), 60)
    assert timeline.seek(20, FOREVER_S)
    timeline.seek(80, FOREVER_S)
    assert sampled(made) == straight(SIGNALS, (), 80)


def test_a_change_replaces_the_samples_after_it_and_undo_brings_them_back() -> None:
    timeline = begun()
    timeline.seek(60, FOREVER_S)
    made = Sampler(timeline, SIGNALS)
    before = sampled(made)
    assert made.take() is not None
    timeline.seek(30, FOREVER_S)
    timeline.change(ROVERS, 6)
    timeline.seek(50, FOREVER_S)
    rows = sampled(made)
    log = (Change(30, ROVERS, 6),)
    assert rows[:31] == before[:31]
    assert rows[31:] == straight(SIGNALS, log, 50)[31:]
    sent = made.take()
    assert sent is not None
    assert (sent["since"], len(sent["rows"])) == (31, 20)
    timeline.undo()
    timeline.seek(60, FOREVER_S)
    assert sampled(made) == before


def test_samples_are_thinned_in_bounded_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sampler, "MAX_SAMPLES", 16)
    timeline = begun()
    timeline.seek(80, FOREVER_S)
    rows = sampled(Sampler(timeline, SIGNALS[:1]))
    assert len(rows) <= 16
    every = rows[1][0]
    assert [tick for tick, _ in rows] == list(range(0, 80 // every * every + 1, every))
    assert rows == straight(SIGNALS[:1], (), 80)[::every]


def test_a_signal_that_does_not_exist_has_no_values() -> None:
    timeline = begun()
    timeline.seek(3, FOREVER_S)
    names = (
        "",
        "body",
        "body/rover/99/x_m",
        "body/rover/0/colour",
        "robot/rover/0/percept/motion/value/99999999999999999999",
        "robot/rover/0",
        "controller/base/0/goals",
        "nothing/at/all",
        "body/../0/x_m",
    )
    assert all(value is None for _, values in sampled(Sampler(timeline, names)) for value in values)


def test_the_numbers_of_controllers_are_signals(page: Page) -> None:
    page.send("open", scenario="mines", seed="7", run="0", tick=100)
    offered = [each["id"] for each in page.wait_for("setting")["offer"]["signals"]]
    assert any(name.endswith("/risk") for name in offered)
    page.wait_for("state", tick=100)
    page.send("chart", signals=offered)
    rows: list[dict[str, Any]] = []
    while not rows or rows[-1]["tick"] < 100:
        answer = page.wait_for("signals")
        assert answer["signals"] == offered
        rows = [row for row in rows if row["tick"] < answer["since"]] + answer["rows"]
    assert [row["tick"] for row in rows] == list(range(101))
    simulation = ae.Simulation("mines", 7)
    simulation.step(100)
    (lane, *_) = simulation.lanes
    last = dict(zip(offered, rows[-1]["values"], strict=True))
    assert last[f"controller/{lane.controller}/risk"] == lane.risk.probability
    assert last[f"controller/{lane.controller}/marks"] == len(lane.marks)
    for controller in simulation.controllers:
        assert last[f"controller/{controller['name']}/goals"] == len(controller["goals"])


def test_signals_of_a_classic_run_are_sampled(page: Page) -> None:
    page.open(scenario="classic", tick=50)
    page.send("chart", signals=["body/wanderer/1/column"])
    rows: list[dict[str, Any]] = []
    while not rows or rows[-1]["tick"] < 50:
        rows += page.wait_for("signals")["rows"]
    simulation = ae.ClassicSimulation("classic", 7)
    simulation.step(50)
    assert rows[-1]["values"] == [simulation.team["column"][1].as_py()]


@pytest.mark.parametrize(
    ("signals", "reason"),
    [
        (["x"] * 17, "signals"),
        (["x" * 201], "signals"),
        ("body", "signals"),
        (None, "signals"),
    ],
)
def test_requests_of_signals_that_are_not_allowed_are_refused(
    page: Page, signals: object, reason: str
) -> None:
    page.open()
    assert reason in page.refusal("chart", signals=signals)


def test_a_recording_with_external_inputs_is_sampled_as_it_was_recorded(
    page: Page, tmp_path: Path
) -> None:
    path = tmp_path / "external.mcap"
    simulation = ae.Simulation("search", 3)
    with ae.Recording(simulation, path) as recording:
        for step in range(20):
            percept: Any = {
                "time_s": 0.1 * step,
                "position": {"value": [5.0 + 0.1 * step, 5.0], "age_s": 0.0},
                "heading_rad": {"value": 0.0, "age_s": 0.0},
            }
            recording.step(percepts={"rover/0": percept})
        poses = simulation.poses
    page.open_recording("external.mcap", tick=20)
    page.send("chart", signals=["body/rover/0/x_m"])
    rows: list[dict[str, Any]] = []
    while not rows or rows[-1]["tick"] < 20:
        rows += page.wait_for("signals")["rows"]
    assert rows[-1]["values"] == [poses[0, 0]]
