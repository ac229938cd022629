"""Real robots, as a page receives them: where they may be, and what their sensors report."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from page_client import Page

import agent_economy as ae
from agent_economy.server.runs.live_run import LiveRun
from agent_economy.server.runs.shown import real_robots, subjects
from agent_economy.server.runs.shown.grown_polygon import grown
from agent_economy.server.runs.shown.subject import Request

ROBOT, OTHER = "rover/0", "rover/1"
LAYERS = "uncertainty", "real-readings", "virtual-readings"
ALL = Request(layers=frozenset(LAYERS), panels=frozenset({"real-robot"}), robot=ROBOT)
FENCE = ((8.0, 8.0), (12.0, 8.0), (12.0, 12.0), (8.0, 12.0))

SCENARIO = """
engine = "metric"
merit = "equation-5.2"
summary = "A real robot faces a simulated one."
clock = { step_s = 0.1, time_limit_s = 100 }
world = { size_m = [40, 20] }
items.mine = { count = 1, placement = { kind = "fixed", at_m = [[12, 10.5]] } }
[robots.rover]
count = 2
radius_m = 0.3
start = { kind = "fixed", at_m = [[10, 10], [14, 10]], heading_deg = [0, 180] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
sensors.sonar = { kind = "range", rays = 8, range_m = 6 }
sensors.eye = { kind = "robots", range_m = 6 }
sensors.finder = { kind = "items", range_m = 3 }
sensors.gps = { kind = "position" }
sensors.compass = { kind = "heading" }
brain = { rate_hz = 5, behaviours = [] }
"""


def mixed(**body: Any) -> ae.Simulation:
    """Return a run in which a real robot faces a simulated one."""
    scenario = ae.Scenario.loads(SCENARIO, "mixed.toml")
    sensors = {"eye": "virtual", "finder": "virtual", "sonar": "both"}
    external = {ROBOT: ae.ExternalBody(**{"sensors": sensors} | body)}
    return ae.Simulation(scenario, seed=1, external=external)


def percept(time_s: float) -> Any:
    """Return what the real sensors of the real robot report: a wall 2 m ahead."""
    ranges_m = [2.0] + 7 * [math.inf]
    return {
        "time_s": time_s,
        "position": {"value": [10, 10], "age_s": 0.0},
        "heading_rad": {"value": 0.0, "age_s": 0.0},
        "scans": [{"age_s": 0.0, "ranges_m": ranges_m}],
    }


def perceive(simulation: ae.Simulation) -> None:
    """Take a step with a percept."""
    simulation.step(percepts={ROBOT: percept(simulation.time_s)})


def shown(simulation: ae.Simulation, request: Request = ALL) -> Any:
    """Return what a page is sent."""
    found = subjects.shown(simulation, request)
    assert found is not None
    return found


def places(layer: Any) -> list[tuple[float, float]]:
    """Return the places of the markers of a layer."""
    return [tuple(round(value, 3) for value in marker["at"]) for marker in layer["markers"]]


def words(simulation: ae.Simulation) -> dict[str, str]:
    """Return the rows of the panel."""
    rows = shown(simulation)["panels"]["real-robot"]["sections"][0]["table"]["rows"]
    return {row["cells"][0]["text"]: row["cells"][1]["text"] for row in rows}


def test_runs_without_real_robots_offer_nothing_of_them() -> None:
    for simulation in (ae.Simulation("search"), ae.ClassicSimulation("classic")):
        offered = subjects.offer(simulation)
        assert not {layer["id"] for layer in offered["layers"]} & set(LAYERS)
        assert "real-robot" not in {panel["id"] for panel in offered["panels"]}
        assert subjects.shown(simulation, ALL) is None


def test_runs_with_real_robots_offer_their_layers_which_are_on_at_first() -> None:
    offered = {layer["id"]: layer for layer in subjects.offer(mixed())["layers"]}
    assert set(LAYERS) <= set(offered)
    assert all(offered[name]["is_on"] for name in LAYERS)


def test_a_robot_that_becomes_real_is_one_from_then_on() -> None:
    simulation = ae.Simulation(ae.Scenario.loads(SCENARIO, "mixed.toml"), seed=1)
    assert subjects.shown(simulation, ALL) is None
    perceive(simulation)
    assert words(simulation)["Real sensors"] == "compass, eye, finder, gps, sonar"


def test_real_and_virtual_readings_are_apart() -> None:
    simulation = mixed()
    perceive(simulation)
    layers = shown(simulation)["layers"]
    real, virtual = places(layers["real-readings"]), places(layers["virtual-readings"])
    assert len(real) == 1
    assert math.dist(real[0], (10, 10)) == pytest.approx(2, abs=1e-3)
    assert (12, 10.5) in virtual
    assert any(math.dist(place, (14, 10)) < 0.01 for place in virtual)


def test_symbols_of_real_and_virtual_readings_differ_in_shape_and_in_colour() -> None:
    def looks(source: Any) -> set[tuple[str, ...]]:
        glyphs = [glyph for glyphs in real_robots.SYMBOLS[source].values() for glyph in glyphs]
        colours = {(part or outline)["colour"] for _, part, outline in map(parts, glyphs)}
        return {(*sorted({shape for shape, *_ in map(parts, glyphs)}), *sorted(colours))}

    def parts(glyph: Any) -> tuple[str, Any, Any]:
        return glyph["shape"], glyph["fill"], glyph["outline"]

    (real,), (virtual,) = looks("real"), looks("virtual")
    assert not set(real) & set(virtual)


def test_without_a_percept_there_are_no_readings() -> None:
    simulation = mixed()
    for _ in range(2):
        layers = shown(simulation)["layers"]
        assert not layers["real-readings"]["markers"]
        assert not layers["virtual-readings"]["markers"]
        simulation.step()


def test_readings_are_the_same_after_a_run_was_moved_in_time() -> None:
    simulation = mixed()
    before = simulation.snapshot()
    perceive(simulation)
    first = shown(simulation)
    simulation.step(5)
    simulation.restore(before)
    shown(simulation)
    perceive(simulation)
    assert shown(simulation) == first


def test_the_area_of_a_real_robot_is_its_body_grown_by_the_uncertainty() -> None:
    simulation = mixed()
    perceive(simulation)
    (area,) = shown(simulation)["layers"]["uncertainty"]["areas"]
    assert area["circle"] == {"at": (10, 10), "robot": ROBOT, "radius": pytest.approx(0.3)}
    assert not area["outline"]["is_dashed"]


def silent(**body: Any) -> Any:
    """Return what is shown of a robot that has been silent for 3 s."""
    simulation = mixed(max_age_s=1.0, **body)
    perceive(simulation)
    simulation.step(30)
    return shown(simulation)


def test_a_silent_robot_may_be_wherever_it_can_have_come() -> None:
    found = silent()
    (area,) = found["layers"]["uncertainty"]["areas"]
    assert area["outline"]["is_dashed"]
    assert area["circle"]["radius"] == pytest.approx(0.3 + 3.0, abs=0.2)
    (marker,) = found["layers"]["uncertainty"]["markers"]
    assert marker["label"].startswith("rover/0 silent for 3.")
    (statement,) = found["panels"]["real-robot"]["sections"][0]["paragraphs"]
    assert statement["text"].startswith("Silent for 3.")


def test_a_silent_robot_is_within_its_fence_by_its_radius() -> None:
    (area,) = silent(fence_m=FENCE)["layers"]["uncertainty"]["areas"]
    assert area["circle"] is None
    low, high = np.min(area["polygon"], axis=0), np.max(area["polygon"], axis=0)
    np.testing.assert_allclose([low, high], [[7.7, 7.7], [12.3, 12.3]])


def test_the_area_of_a_robot_that_is_silent_for_long_is_not_much_larger_than_the_world() -> None:
    simulation = mixed(max_age_s=1.0)
    perceive(simulation)
    simulation.step(900)
    (area,) = shown(simulation)["layers"]["uncertainty"]["areas"]
    assert area["circle"]["radius"] == pytest.approx(0.3 + math.hypot(40, 20))


def test_the_panel_states_which_sensors_are_real_virtual_or_both() -> None:
    simulation = mixed()
    perceive(simulation)
    assert words(simulation) == {
        "Real sensors": "compass, gps",
        "Virtual sensors": "eye, finder",
        "Real and virtual": "sonar",
        "Uncertainty": "0.00 m",
    }
    assert not shown(simulation, ALL._replace(robot=OTHER))["panels"]


@pytest.mark.parametrize("by_m", [0.1, 1.0])
def test_a_polygon_grows_by_the_same_distance_at_outer_and_inner_corners(by_m: float) -> None:
    angle = [(0.0, 0.0), (0.0, 0.0), (10.0, 0.0), (10.0, 4.0), (4.0, 4.0), (4.0, 10.0), (0.0, 10.0)]
    outline = grown(angle, by_m)
    low, high = np.min(outline, axis=0), np.max(outline, axis=0)
    np.testing.assert_allclose([low, high], [[-by_m, -by_m], [10 + by_m, 10 + by_m]])
    assert any(np.allclose(point, (4 + by_m, 4 + by_m)) for point in outline)
    nearest = min(math.dist(point, (10.0, 0.0)) for point in outline)
    assert nearest == pytest.approx(by_m)


def test_a_recording_shows_the_readings_at_any_tick_that_it_is_opened_at(
    page: Page, tmp_path: Path
) -> None:
    simulation, file = mixed(), tmp_path / "mixed.mcap"
    with ae.Recording(simulation, file) as recording:
        for _ in range(6):
            recording.step(percepts={ROBOT: percept(simulation.time_s)})
    page.send("show", layers=list(LAYERS), panels=[])
    page.open_recording("mixed.mcap", tick=5)
    message = page.wait_for("shown", tick=5)
    assert len(message["layers"]["real-readings"]["markers"]) == 1
    page.send("seek", tick=0)
    assert not page.wait_for("shown", tick=0)["layers"]["virtual-readings"]["markers"]


def test_a_live_run_shows_the_readings() -> None:
    simulation = mixed()
    live = LiveRun(simulation.scenario, 1, simulation.declared_external)
    live.append(0, {"percepts": {ROBOT: percept(0.0)}})
    assert live.seek(1, 10.0)
    perceive(simulation)
    assert shown(live.simulation) == shown(simulation)
