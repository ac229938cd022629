"""Emulated robots with inexact drives and sensors, in virtual time."""

import pytest
from imperfect_robot import DriveErrors, SensorErrors
from metric import world
from virtual_drive import Case, VirtualDrive

import agent_economy as ae

SEEDS = range(4)


@pytest.mark.parametrize(("lag_s", "noise_m"), [(0.02, 0.1), (0.25, 0.5), (0.5, 1.5)])
def test_a_robot_with_a_lag_reaches_its_waypoints_and_its_turns_end(
    lag_s: float, noise_m: float
) -> None:
    """Of 252 such drives, 248 arrive; in the others the robot is caught at a corner of the wall."""
    drive, sensors = DriveErrors(lag_s=lag_s), SensorErrors(noise_m)
    records = [VirtualDrive(Case("bender", drive, sensors, seed, 240)).run() for seed in SEEDS]
    assert sum(len(each.complete) == each.waypoints == 2 for each in records) >= len(SEEDS) - 1
    assert all(each.turn_fault_s is None for each in records)


@pytest.mark.parametrize("gain", [0.6, 0.92, 1.2])
def test_a_robot_is_where_it_believes_to_be_and_waypoints_are_complete_there(gain: float) -> None:
    """The share has a standard error of some 0.03: beliefs of 10 s are not independent."""
    drive, sensors = DriveErrors(gain=gain, lag_s=0.25), SensorErrors(0.2)
    records = [VirtualDrive(Case("bender-team", drive, sensors, seed, 240)).run() for seed in SEEDS]
    beliefs = [belief for each in records for belief in each.beliefs]
    within = sum(error_m <= 2 * deviation_m for _, error_m, deviation_m in beliefs)
    assert 0.77 < within / len(beliefs) < 0.96
    assert all(len(each.complete) == 7 for each in records)
    assert max(distance_m for each in records for *_, distance_m in each.complete) < 1.9


FIELD = world("""
clock.time_limit_s = 600
world.size_m = [40, 40]
[robots.rover]
count = 1
radius_m = 0.3
radio = {{ range_m = 100 }}
start = {{ kind = "fixed", at_m = [[4, 4]], heading_deg = [0] }}
drive = {{ max_speed_m_s = 0.6, max_turn_rate_deg_s = 60, {drive} }}
brain = {{ rate_hz = 5, behaviours = [{behaviours}] }}
[robots.rover.sensors]
gps = {{ kind = "position", rate_hz = 1, noise_m = 0.2, {gps} }}
compass = {{ kind = "heading", noise_deg = 1 }}
""")

CONTROLLER = """
[controllers.base]
count = 1
start = { kind = "fixed", at_m = [[20, 20]] }
radio = { range_m = 100 }

[goals.spot]
count = 1
within_m = 0.8
placement = { kind = "fixed", at_m = [[10, 10]] }
"""

CORRECT = '{ kind = "cruise" }, { kind = "correct", waypoints_m = [[9, 9], [20, 9]], within_m = 1 }'


@pytest.mark.parametrize("drive", ["lag_s = 0", "lag_s = 0.25"])
def test_correct_gives_up_waypoints_that_a_drift_makes_impossible(drive: str) -> None:
    text = FIELD.format(drive=drive, gps="drift_m = 0.7", behaviours=CORRECT)
    simulation = ae.Simulation(ae.Scenario.loads(text), 1)
    found = set()
    for step in range(3000):
        simulation.step()
        if step % 10 == 0:
            goals = simulation.assigned_goals("rover/0")
            found |= {(goal["id"]["number"], goal["verdict"], goal["reason"]) for goal in goals}
    assert {number for number, verdict, _ in found if verdict == "complete"} == set()
    assert {(0, "impossible", "position"), (1, "impossible", "position")} <= found


def test_a_controller_reports_that_the_position_is_not_known_well_enough() -> None:
    text = FIELD.format(drive="", gps="drift_m = 0.7", behaviours='{ kind = "serve" }')
    simulation = ae.Simulation(ae.Scenario.loads(text.replace("60,  }", "60 }") + CONTROLLER), 1)
    reasons = set()
    for _ in range(2000):
        simulation.step()
        reasons |= set(simulation.goals["unserved"].to_pylist())
    assert reasons == {"", "position"}
