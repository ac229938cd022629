"""Single brains: percepts and commands have the names of the Rust types, and errors name paths."""

import math
import re
from typing import Any

import numpy as np
import pytest

import agent_economy as ae
from agent_economy.runs.brain import Body, Percept

ROVER: Body = {
    "radius_m": 0.25,
    "max_speed_m_s": 1.0,
    "max_turn_rate_rad_s": 1.5,
    "max_acceleration_m_s2": 1.0,
    "period_s": 0.1,
    "rings": [
        {
            "bearings_rad": [math.remainder(i * math.tau / 16, math.tau) for i in range(16)],
            "range_m": 3.0,
            "period_s": 0.1,
            "latency_s": 0.0,
        }
    ],
}
OPEN: Percept = {"scans": [{"age_s": 0.0, "ranges_m": [math.inf] * 16}]}
NAVIGATE = {"kind": "navigate", "waypoints_m": [[9, 2]]}
WALLED: Percept = {"random_words": [7, 7, 7, 7], "scans": [{"age_s": 0.0, "ranges_m": [0.5] * 16}]}


def test_a_brain_drives_into_free_space() -> None:
    rover = ae.Brain(None, ROVER)
    command = rover.step(OPEN)
    assert command["motion"] == {"speed_m_s": 1.0, "turn_rate_rad_s": 0.0}
    assert (command["requests"], command["outbox"]) == ([], [])
    assert ae.Brain(None, ROVER).step({})["motion"]["speed_m_s"] == 0.0


def test_a_copy_is_equal_and_independent() -> None:
    rover = ae.Brain(None, ROVER)
    rover.step(OPEN)
    rover.step(WALLED)
    copy = rover.copy()
    commands = [rover.step(WALLED) for _ in range(5)]
    assert [copy.step(WALLED) for _ in range(5)] == commands
    assert commands[0]["motion"]["turn_rate_rad_s"] != 0.0


def test_arrays_none_and_integers_are_read_as_lists_missing_values_and_numbers() -> None:
    arrays: Any = {
        "touch": None,
        "random_words": np.zeros(4, dtype=np.uint32),
        "scans": [{"age_s": 0, "ranges_m": np.full(16, np.inf)}],
    }
    assert ae.Brain(None, ROVER).step(arrays) == ae.Brain(None, ROVER).step(OPEN)


def test_all_errors_of_spec_and_body_are_reported_with_their_paths() -> None:
    spec = {"rate_hz": -1, "behaviours": [{"kind": "cruise"}, {"kind": "avoid", "neer_m": 0.2}]}
    body: Any = {name: value for name, value in ROVER.items() if name != "radius_m"}
    body["period_s"] = 0
    with pytest.raises(ae.InputError) as caught:
        ae.Brain(spec, body)
    lines = str(caught.value).splitlines()
    assert len(lines) == 4
    assert lines[0].startswith("brain.behaviours[1].neer_m is not a known key: expected")
    assert lines[0].endswith("did you mean near_m?")
    assert lines[1].startswith("brain.rate_hz = -1: must be")
    assert lines[2].startswith("body.period_s = 0: must be")
    assert lines[3].startswith("body.radius_m is missing")


def test_the_belief_state_has_beliefs_and_goals_and_is_none_without_beliefs() -> None:
    spec = {"arbitration": {"kind": "goals"}, "behaviours": [NAVIGATE]}
    rover = ae.Brain(spec, ROVER)
    before = rover.belief_state()
    assert before is not None
    assert before["pose"] is None
    here: Percept = {
        "position": {"value": [1.0, 2.0], "age_s": 0.0},
        "heading_rad": {"value": 0.5, "age_s": 0.0},
    }
    rover.step(OPEN | here)
    beliefs = rover.belief_state()
    assert beliefs is not None
    assert beliefs["pose"] is not None
    assert (beliefs["pose"]["at"], beliefs["pose"]["heading_rad"]) == ([1.0, 2.0], 0.5)
    assert [goal["to"] for goal in beliefs["goals"]] == [[9.0, 2.0]]
    assert rover.copy().belief_state() == beliefs
    assert ae.Brain(None, ROVER).belief_state() is None


def test_none_in_body_and_spec_counts_as_omitted() -> None:
    other = {"radius_m": 0.2, "is_in_the_way": True, "max_acceleration_m_s2": None}
    body: Any = ROVER | {"field": None, "others": [other]}
    spec = {"beliefs": {"area_m": None}, "behaviours": [{"kind": "cruise", "speed_m_s": None}]}
    assert ae.Brain(spec, body).step(OPEN)["motion"]["speed_m_s"] == 1.0
    none: Any = None
    nameless: Any = ROVER | {"radius_m": none}
    with pytest.raises(ae.InputError, match=r"body\.radius_m is missing"):
        ae.Brain(None, nameless)
    listed: Any = ROVER | {"others": [none]}
    with pytest.raises(ae.InputError, match=r"body\.others"):
        ae.Brain(None, listed)
    with pytest.raises(ae.InputError, match="None"):
        ae.Scenario.load("search").replace("clock.time_limit_s", none)


CONTACT = {"kind": 0, "range_m": 1.0, "bearing_rad": 0.0, "age_s": 0.0}
RECEIVED = {"from": {"kind": 0, "index": 0}, "age_s": 0.0}


@pytest.mark.parametrize(
    ("percept", "expected"),
    [
        ({"scanz": []}, "percept.scanz is not a known key: expected one of time_s, random_words, "),
        ({"time_s": "x"}, 'percept.time_s = "x": must be a number'),
        ({"time_s": math.inf}, "percept.time_s = inf: must be a finite number"),
        ({"touch": None, "position": {"value": 3, "age_s": 0}}, "must be a list of 2 numbers"),
        ({"contacts": [CONTACT | {"kind": 7e4}]}, "must be a whole number from 0 to 65535"),
        ({"contacts": [{}]}, "percept.contacts[0].kind is missing: expected a whole number"),
        ({"scans": 5}, "percept.scans = 5: must be a list of dicts"),
        ({"heading_rad": 1.0}, "percept.heading_rad = 1.0: must be a dict with value and age_s"),
        (
            {"inbox": [RECEIVED | {"message": {"about": {}}}]},
            "must be a dict with item, a dict with sender, a dict with goal, a dict with order, "
            "a dict with contract, a dict with lease, a dict with ownership, a dict with lane or "
            "a dict with trade",
        ),
        ({"scans": [{"ranges_m": [1.0, math.nan]}]}, "percept.scans[0].ranges_m[1] = nan: must be"),
        ({"touch": {"value": 3, "age_s": 0.0}}, "percept.touch.value = 3: must be True or False"),
        (
            {"random_words": [1, 2, 3]},
            "percept.random_words = [1, 2, 3]: must be a list of 4 whole",
        ),
        ({"time_s": object}, "percept.time_s = type: must be a number"),
        ("far", 'percept = "far": must be a dict'),
    ],
)
def test_an_error_of_a_percept_names_its_path_and_what_is_allowed(
    percept: Any, expected: str
) -> None:
    with pytest.raises(ae.InputError) as caught:
        ae.Brain(None, ROVER).step(percept)
    assert expected in str(caught.value)
    rust = ("invalid", "struct", "field", "f64", "u16")
    assert not any(word in str(caught.value) for word in rust)


@pytest.mark.parametrize(
    ("percept", "expected"),
    [
        (
            {"scans": [{"age_s": 0.0, "ranges_m": [1.0] * 15}]},
            r"percept\.scans\[0\]\.ranges_m = a list of 15: must be a list of 16, one for each ray",
        ),
        (
            {"scans": [OPEN["scans"][0]] * 2},
            r"percept\.scans = a list of 2: must be a list of at most 1, one for each range sensor",
        ),
        ({"contacts": [CONTACT]}, r"percept\.contacts\[0\]\.kind = 0: must be a number below 0"),
    ],
)
def test_a_percept_of_another_body_is_an_error(percept: Any, expected: str) -> None:
    with pytest.raises(ae.InputError, match=expected):
        ae.Brain(None, ROVER).step(percept)
    simulation = ae.Simulation("search", seed=7)
    percept["scans"] = [{"age_s": 0.0, "ranges_m": [1.0]}]
    with pytest.raises(ae.InputError, match=r"rover/0.*must be a list of 55"):
        simulation.step(percepts={"rover/0": {"scans": percept["scans"]}})


def test_a_percept_that_contains_itself_is_an_error() -> None:
    ring: list[Any] = []
    ring.append(ring)
    knot: dict[str, Any] = {}
    knot["scans"] = [knot]
    percepts: list[Any] = [{"scans": ring}, knot]
    for percept in percepts:
        with pytest.raises(ae.InputError, match=r"at most 32 levels deep"):
            ae.Brain(None, ROVER).step(percept)


@pytest.mark.parametrize("kind", [None, 0, ["rover"]])
def test_a_kind_must_be_a_string(kind: Any) -> None:
    with pytest.raises(ae.InputError, match=r"kind = .*: must be the name of a robot kind"):
        ae.Brain.of("search", kind)


@pytest.mark.parametrize(
    ("key", "value", "named"),
    [
        ("field", [[0, 0], [1e300, 1e300]], "body.field = 1e300"),
        ("field", [[0, 0], [1e8, 20]], "body.field = 1e8"),
        (
            "rings",
            [{"bearings_rad": [0.0, 1e100], "range_m": 3, "period_s": 0.1, "latency_s": 0}],
            "body.rings[0].bearings_rad[1] = 1e100",
        ),
    ],
)
def test_a_body_that_maps_cannot_represent_is_an_input_error(
    key: str, value: object, named: str
) -> None:
    body: Any = ROVER | {key: value}
    with pytest.raises(ae.InputError, match=re.escape(named)):
        ae.Brain({"arbitration": {"kind": "goals"}, "behaviours": [{"kind": "avoid"}]}, body)
