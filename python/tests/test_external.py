"""External inputs of a run: percepts of external bodies, and commands for robots."""

import math
from typing import Any

import numpy as np
import pytest
from metric import search
from numpy.typing import NDArray

from agent_economy import Brain, ExternalBody, InputError, Scenario, Simulation
from agent_economy.recording.metric_writer import moment_of
from agent_economy.runs.brain import Command, Percept

STOP: Command = {
    "motion": {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0},
    "heading_rad": None,
    "requests": [],
    "outbox": [],
}


def percept_at(x_m: float, y_m: float, heading_rad: float, **more: Any) -> Percept:
    """Return the percept of a body at a pose."""
    percept: Percept = {
        "position": {"value": [x_m, y_m], "age_s": 0.0},
        "heading_rad": {"value": heading_rad, "age_s": 0.0},
    }
    return percept | more  # type: ignore[return-value]


def scans(far_m: float | None) -> list[dict[str, Any]]:
    """Return a scan of a rover with the same range in all directions."""
    first = Simulation("search").percept("rover/0")
    assert first is not None
    rays = len(first["scans"][0]["ranges_m"])
    return [{"age_s": 0.0, "ranges_m": [far_m] * rays}]


def test_an_external_body_has_the_pose_of_its_percepts() -> None:
    simulation = Simulation("search", seed=2)
    others = simulation.poses[[0, 2, 3]]
    simulation.step(percepts={"rover/1": percept_at(3.5, 7.25, 0.5)})
    np.testing.assert_allclose(simulation.poses[1], [3.5, 7.25, 0.5])
    assert simulation.external.tolist() == [False, True, False, False]
    assert (simulation.poses[[0, 2, 3]] != others).any()
    simulation.step(10)
    np.testing.assert_allclose(simulation.poses[1], [3.5, 7.25, 0.5])
    assert simulation.percept("rover/1") is None


def test_a_declared_body_stands_where_it_starts_until_its_first_percept() -> None:
    simulation = Simulation("search", seed=2, external=["rover/1"])
    assert list(simulation.declared_external) == ["rover/1"]
    assert simulation.external.tolist() == [False, True, False, False]
    assert simulation.hash != Simulation("search", seed=2).hash
    start = simulation.poses
    simulation.step(20)
    assert simulation.poses[1].tolist() == start[1].tolist()
    assert (simulation.poses[[0, 2, 3]] != start[[0, 2, 3]]).any(axis=1).all()
    simulation.step(percepts={"rover/1": percept_at(3.5, 7.25, 0.5)})
    np.testing.assert_allclose(simulation.poses[1], [3.5, 7.25, 0.5])


def test_all_errors_of_declared_bodies_are_reported() -> None:
    with pytest.raises(InputError) as raised:
        Simulation("search", external=["rover/9", "rover/0", "rovre/0"])
    assert [error["value"] for error in raised.value.errors] == ['"rover/9"', '"rovre/0"']
    with pytest.raises(InputError, match=r"external = 'rover/0': must be a list of robot names"):
        Simulation("search", external="rover/0")
    with pytest.raises(InputError, match=r"external = .* must be a list of robot names"):
        Simulation("search", external=["\udcff"])
    twice = ["rover/1", "rover/0", "rover/1"]
    with pytest.raises(InputError, match=r"external = \['rover/1'\]: must be different robots"):
        Simulation("search", external=twice)
    brains = {"rover": lambda _: Brain.of("search", "rover")}
    with pytest.raises(
        InputError, match=r"external = \['rover/0'\]: must be robots with the brain"
    ):
        Simulation("search", brains=brains, external=["rover/0"])
    with pytest.raises(InputError, match="commands"):
        Simulation("search", external=["rover/0"]).step(commands={"rover/0": STOP})


def test_a_percept_that_is_not_later_repeats_the_motion() -> None:
    simulation = Simulation("search", seed=2)
    far, near = scans(3.0), scans(0.3)
    first = simulation.step(percepts={"rover/0": percept_at(5, 8, 0.1, time_s=1.0, scans=far)})
    late = percept_at(9, 9, 0.1, time_s=1.0, scans=near)
    assert simulation.step(percepts={"rover/0": late}) == first
    # Not at the place of that percept: the command of the first one moves it a little.
    np.testing.assert_allclose(simulation.poses[0], [5, 8, 0.1], atol=0.02)
    assert simulation.step(percepts={"rover/0": {**late, "time_s": 1.1}}) != first


def test_the_heading_of_a_turn_is_in_the_command_of_an_external_body() -> None:
    layers = [{"kind": "cruise"}, {"kind": "correct", "waypoints_m": [[5, 18]]}, {"kind": "avoid"}]
    scenario = search({"robots.rover.brain": {"behaviours": layers}})
    simulation = Simulation(scenario, external=["rover/0"])

    def command(heading_rad: float, far_m: float) -> Command:
        percept = percept_at(5, 8, heading_rad, time_s=simulation.time_s, scans=scans(far_m))
        return simulation.step(percepts={"rover/0": percept})["rover/0"]

    assert command(0.0, 3.0)["heading_rad"] == pytest.approx(math.pi / 2)
    assert command(0.2, 3.0)["heading_rad"] == pytest.approx(math.pi / 2)
    assert command(0.3, 0.2)["heading_rad"] is None  # avoid
    simulation = Simulation(scenario, external=["rover/0"])
    straight = command(1.57, 3.0)
    assert straight["motion"]["speed_m_s"] > 0
    assert straight["heading_rad"] is None


def test_a_simulated_body_ignores_a_heading() -> None:
    plain, ahead = Simulation("search", seed=4), Simulation("search", seed=4)
    motion = {"motion": {"speed_m_s": 0.5, "turn_rate_rad_s": 0.3}}
    for heading_rad in [None, 0.5, -1e9]:
        plain.step(commands={"rover/0": motion})  # type: ignore[dict-item]
        ahead.step(commands={"rover/0": motion | {"heading_rad": heading_rad}})  # type: ignore[dict-item]
    assert plain.hash == ahead.hash


def test_a_snapshot_is_of_a_run_with_the_same_external_bodies() -> None:
    simulation = Simulation("search", external=["rover/1"])
    snapshot = simulation.snapshot()
    simulation.step(percepts={"rover/0": percept_at(3.5, 7.25, 0.5)})
    simulation.restore(snapshot)
    assert simulation.external.tolist() == [False, True, False, False]
    with pytest.raises(InputError, match=r"external=\('rover/1',\): must be of this run"):
        Simulation("search").restore(snapshot)


@pytest.mark.parametrize(("rate_hz", "steps"), [(10, 1), (5, 2), (1, 10)])
def test_a_command_holds_until_the_brain_decides_again(rate_hz: float, steps: int) -> None:
    simulation = Simulation(search({"robots.rover.brain.rate_hz": rate_hz}), seed=2)
    simulation.step(20)
    simulation.step(commands={"rover/0": STOP})
    held = 0
    while moment_of(simulation)["commanded"][0].tolist() == [0, 0]:
        simulation.step()
        held += 1
    assert held == steps


def test_the_command_of_an_external_body_is_that_of_its_brain() -> None:
    simulation = Simulation("search", seed=2)
    brain = Brain.of("search", "rover")
    near, far = scans(0.4), scans(3.0)
    motions = set()
    for step in range(80):
        percept = percept_at(
            5 + step / 100,
            8,
            0.1,
            random_words=[step, 2, 3, 4],
            time_s=step / 10,
            scans=near if step % 9 == 0 else far,
        )
        command = brain.step(percept)
        assert simulation.step(percepts={"rover/0": percept}) == {"rover/0": command}
        motions.add(tuple(command["motion"].values()))
    assert len(motions) == 2, "straight ahead, and a turn"


def test_items_in_the_contacts_of_an_external_body_are_found() -> None:
    simulation = Simulation("search", seed=2)
    item = simulation.items.to_pylist()[0]
    contact = {"kind": 0, "range_m": 0.5, "bearing_rad": 0.0, "age_s": 0.0}
    percept = percept_at(item["x_m"] - 0.5, item["y_m"], 0.0, contacts=[contact])
    simulation.step(percepts={"rover/0": percept})
    assert simulation.items["found_s"].to_pylist() == [0.0, None, None, None]
    assert simulation.outcome().found == {"mine": 1}


def test_commands_of_equal_brains_give_the_same_run() -> None:
    scripted, plain = (Simulation("search", seed=4) for _ in range(2))
    brains = {robot: Brain.of(scripted.scenario, "rover") for robot in scripted.robots}
    for _ in range(150):
        percepts = {robot: scripted.percept(robot) for robot in scripted.robots}
        commands = {
            robot: brains[robot].step(percept) for robot, percept in percepts.items() if percept
        }
        assert scripted.step(commands=commands) == {}
        plain.step()
    assert scripted.hash == plain.hash
    assert not scripted.external.any()


def test_reading_percepts_changes_nothing() -> None:
    read, plain = (Simulation("open-field", seed=4) for _ in range(2))
    for _ in range(40):
        for robot in read.robots:
            read.percept(robot)
        read.step()
        plain.step()
    assert read.hash == plain.hash


def test_a_robot_has_percepts_only_when_its_brain_steps() -> None:
    simulation = Simulation(search({"robots.rover.brain.rate_hz": 5}), seed=4)
    perceived = []
    for _ in range(10):
        perceived.append(simulation.percept("rover/0") is not None)
        simulation.step()
    assert sum(perceived) == 5
    assert perceived[:2] in ([True, False], [False, True])


def test_scripted_robots_execute_their_commands() -> None:
    simulation = Simulation("search", seed=4)
    begun = simulation.poses
    for _ in range(30):
        simulation.step(commands={"rover/2": STOP})
    moved = np.abs(simulation.poses - begun).sum(axis=1) > 0.01
    assert moved.tolist() == [True, True, False, True]
    simulation.step(30)
    assert np.abs(simulation.poses[2] - begun[2]).sum() > 0.01


def test_external_poses_are_part_of_a_snapshot() -> None:
    simulation = Simulation("search", seed=4)
    simulation.step(percepts={"rover/0": percept_at(4, 4, 1)})
    snapshot = simulation.snapshot()
    simulation.step(percepts={"rover/0": percept_at(6, 6, 1)})
    simulation.step(20)
    after = simulation.hash
    simulation.restore(snapshot)
    assert simulation.external[0]
    simulation.step(percepts={"rover/0": percept_at(6, 6, 1)})
    simulation.step(20)
    assert simulation.hash == after


ERRORS: list[tuple[dict[str, Any], str]] = [
    ({"percepts": {"rvoer/1": {}}}, r'percepts = "rvoer/1": must be .*did you mean rover/1\?'),
    ({"percepts": {"rover/4": {}}}, r"must be one of the run's robots: rover/0 to rover/3"),
    ({"percepts": {"rover/01": {}}}, "must be one of the run's robots"),
    ({"percepts": {1: {}}}, 'percepts = "1": must be one of'),
    ({"percepts": [1]}, r"percepts = \[1\]: must be a dict by robot names"),
    ({"commands": "rover/1"}, "commands = 'rover/1': must be a dict"),
    (
        {"percepts": {"rover/1": {"tiem_s": 1}}},
        r'percepts."rover/1".tiem_s is not a known key: expected one of',
    ),
    ({"percepts": {"rover/1": {"time_s": math.nan}}}, r'percepts."rover/1".time_s = nan: must be'),
    (
        {"commands": {"rover/1": {"heading_rad": "north"}}},
        r'commands."rover/1".heading_rad = "north": must be a number',
    ),
    ({"commands": {"rover/1": {"heading_rad": math.nan}}}, "heading_rad = nan: must be a finite"),
    ({"percepts": {"rover/1": []}}, r'percepts."rover/1" = \[\]: must be a dict'),
    ({"commands": {"rover/1": ()}}, r'commands."rover/1" = \[\]: must be a dict'),
    (
        {"percepts": {"rover/1": {"time_s": "\ud800"}}},
        r'percepts."rover/1".time_s = .*: must be a string of valid Unicode',
    ),
    ({"commands": {"rover/1": {"motion": 3}}}, r'commands."rover/1".motion = 3: must be a dict'),
    ({"steps": 2, "commands": {"rover/1": STOP}}, "steps = 2: must be 1 with percepts or commands"),
    (
        {"percepts": {"rover/1": {}}, "commands": {"rover/1": STOP}},
        'commands = "rover/1": must be a robot without an external body',
    ),
]


@pytest.mark.parametrize(("arguments", "expected"), ERRORS)
def test_invalid_inputs_are_named_and_the_run_does_not_advance(
    arguments: dict[str, Any], expected: str
) -> None:
    simulation = Simulation("search", seed=4)
    before = simulation.hash
    with pytest.raises(InputError, match=expected):
        simulation.step(**arguments)
    assert simulation.hash == before
    assert not simulation.external.any()


def test_errors_of_several_robots_are_reported_together() -> None:
    percepts: Any = {"rover/1": {"random_words": 3}, "rover/9": {}}
    with pytest.raises(InputError) as caught:
        Simulation("search").step(percepts=percepts, commands={"rover/7": STOP})
    assert len(str(caught.value).splitlines()) == 3
    assert len(caught.value.errors) == 3


def test_an_external_body_may_be_far_outside_the_world() -> None:
    simulation = Simulation("search", seed=4)
    for far in (1e308, -1e308, 25.5, -0.1):
        simulation.step(percepts={"rover/0": percept_at(far, far, far)})
        simulation.step(2)
    assert simulation.finish().status in {"complete", "incomplete"}


def test_an_unknown_robot_has_no_percept() -> None:
    with pytest.raises(InputError, match=r'robot = "rover/7": must be one of the run\'s robots'):
        Simulation("search").percept("rover/7")


def test_an_unknown_kind_has_no_brain() -> None:
    with pytest.raises(InputError, match=r'kind = "rovre": .*did you mean "rover"\?'):
        Brain.of("search", "rovre")
    with pytest.raises(InputError, match="engine = 'classic': must be 'metric'"):
        Brain.of("classic", "wanderer")


def test_a_brain_of_a_scenario_has_the_body_of_its_kind() -> None:
    slow = search({"robots.rover.drive.max_speed_m_s": 0.25})
    open_space: Any = {"scans": scans(None)}
    commands = [
        Brain.of(each, "rover").step(open_space) for each in (slow, Scenario.load("search"))
    ]
    assert [command["motion"]["speed_m_s"] for command in commands] == [0.25, 1.0]
    assert {*Brain.of("open-field", "bird").step({})} == {*STOP, "acts"}


def standing_at(place: NDArray[np.float64], time_s: float) -> Percept:
    """Return the percept of a real robot that knows its pose and does not move."""
    x_m, y_m, _ = map(float, place)
    return {
        "time_s": time_s,
        "position": {"value": (x_m, y_m), "age_s": 0.0},
        "heading_rad": {"value": 0.0, "age_s": 0.0},
        "motion": {"value": {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}, "age_s": 0.0},
    }


def test_the_goals_of_a_real_robot_that_falls_silent_return_to_their_controller() -> None:
    # Within its fence, every other robot must expect it.
    fence_m = ((145.0, 145.0), (155.0, 145.0), (155.0, 155.0), (145.0, 155.0))
    body = ExternalBody(max_age_s=3.0, fence_m=fence_m)
    simulation = Simulation("waypoints", seed=3, external={"rover/0": body})
    place = np.array([150.0, 150.0, 0.0])
    for step in range(1, 400):
        percept = standing_at(place, step * simulation.step_s)
        simulation.step(percepts={"rover/0": percept})
    held = {each["goal"] for each in simulation.served_goals("rover/0")}
    assert held
    simulation.finish()
    served_by = {each["name"]: each["served_by"] for each in simulation.goals.to_pylist()}
    assert all(served_by.values())
    assert "rover/0" not in {served_by[goal] for goal in held}


def test_what_a_body_cannot_be_is_refused_by_path() -> None:
    sensors: Any = {"gps": "virtual", "scaner": "both", "compass": "both"}
    body = ExternalBody(sensors, max_age_s=-1.0, fence_m=((0, 0),))
    with pytest.raises(InputError) as raised:
        Simulation("waypoints", external={"rover/0": body})
    at = 'external."rover/0"'
    assert [each["path"] for each in raised.value.errors] == [
        f"{at}.sensors.compass",
        f"{at}.sensors.gps",
        f"{at}.sensors.scaner",
        f"{at}.max_age_s",
        f"{at}.fence_m",
    ]
    assert "scanner" in str(raised.value)
    with pytest.raises(InputError, match=r"agent_economy\.ExternalBody"):
        Simulation("waypoints", external={"rover/0": {"sensors": {}}})
    simulation = Simulation("waypoints", external=["rover/0"])
    both = {"rover/0": standing_at(np.zeros(3), 1.0)}
    with pytest.raises(InputError, match="observed"):
        simulation.step(percepts=both, observed=both)
