"""A drive of an emulated Bender among simulated robots: the whole way, over sockets."""

import math
import signal
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from bare_timer import repeated_if_late
from live_bench import INEXACT, Drive, changed_scenario, driving, emulated, fleet_text
from recorded import contents

import agent_economy as ae
from agent_economy.recording.reading import read

ROVERS_M = [[8.0, 15.0], [8.0, 16.5], [8.0, 13.5]]
FAST: dict[str, Any] = {"forward_m_s_per_unit": 0.03, "reverse_m_s_per_unit": 0.03}
COURSE = {
    "obstacles": "obstacles = []",
    "noise_m = 0.2": "noise_m = 0.1",
    "rate_hz = 1 ": "rate_hz = 5",
    '{ kind = "correct"': '{ kind = "correct", within_m = 1, wait_s = 2, stop_when_done = true },',
    '{ kind = "avoid"': '{ kind = "avoid", near_m = 1, clearance_hysteresis_m = 0.4, hold_s = 2 },',
}
ROVERS = f"""
[robots.rover]
count = 3
radius_m = 0.4
start = {{ kind = "fixed", at_m = {ROVERS_M} }}
drive = {{ max_speed_m_s = 0, max_turn_rate_deg_s = 0 }}

[robots.bender.sensors.lidar]
kind = "range"
rays = 36
range_m = 6
"""


@dataclass(frozen=True)
class Driven:
    """A drive that was stopped, and where the real robot was."""

    drive: Drive
    path_m: list[tuple[float, float]]


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Driven:
    """Drive a robot towards simulated ones that the emulator does not know."""
    return drive_among(tmp_path_factory.mktemp("mixed"))


@repeated_if_late
def drive_among(folder: Path) -> Driven:
    scenario = changed_scenario(folder / "among.toml", COURSE)
    with scenario.open("a", encoding="utf-8") as file:
        file.write(ROVERS)
    fleet, path_m = folder / "fleet.toml", []
    arguments = ("--scenario", str(scenario))
    with emulated(folder, arguments=arguments, gps_hz=5, sonar_hz=10, **FAST, **INEXACT) as bench:
        keys = {"bender/0": "waypoints_m = [[14, 15]]"}
        text = fleet_text(bench, scenario=str(scenario), keys=keys, **FAST)
        fleet.write_text(text, encoding="utf-8")
        with driving(fleet) as drive:
            drive.wait_until_moving()
            for _ in range(150):
                time.sleep(0.1)
                pose = bench.request(get="state")["state"]["robots"][0]["pose"]
                path_m.append((pose["x_m"], pose["y_m"]))
            drive.stop()
            drive.process.send_signal(signal.SIGINT)
            drive.wait()
    return Driven(drive, path_m)


def test_a_real_robot_drives_around_simulated_ones_that_it_has_no_sensor_for(
    driven: Driven,
) -> None:
    nearest_m = min(math.dist(place, rover) for place in driven.path_m for rover in ROVERS_M)
    # Both have a radius of 0.4 m; positions have errors of 0.1 m.
    assert nearest_m > 0.8 - 0.2
    assert max(math.dist(place, driven.path_m[0]) for place in driven.path_m) > 1.5


def test_a_mixed_drive_is_replayed_bit_for_bit(driven: Driven) -> None:
    replayed = ae.replay(driven.drive.record)
    assert (replayed.mismatch_tick, replayed.mismatch) == (None, None)
    (body,) = replayed.external.values()
    assert (body.sensors["lidar"], body.sensors["sonar_0"]) == ("virtual", "real")
    assert body.max_age_s == 3.0


def test_a_recording_has_virtual_sensors_beside_real_ones_and_where_a_standing_robot_is(
    driven: Driven,
) -> None:
    """Before it is armed and after the stop, the brain does not step, but the robot is observed."""
    _, recorded = read(driven.drive.record)
    inputs = recorded.inputs
    observed = [tick for tick in sorted(inputs) if "bender/0" in inputs[tick].get("observed", {})]
    decided = [tick for tick in sorted(inputs) if "bender/0" in inputs[tick]["percepts"]]
    assert observed[0] < decided[0] < decided[-1] < observed[-1]
    scans = inputs[decided[-1]]["percepts"]["bender/0"]["scans"]
    # Of the rings by name, that of the lidar is first: it is no reading of the robot.
    assert scans[0] == {"age_s": None, "ranges_m": []}
    assert all(scan["age_s"] is not None for scan in scans[1:])


def test_the_recorded_percepts_are_what_the_brain_knew_of_both_worlds(driven: Driven) -> None:
    percepts = contents(driven.drive.record).topics["/percept/bender/0"]
    lidars = [message.content["scans"][0] for message in percepts]
    assert all(scan["age_s"] == 0.0 and len(scan["ranges_m"]) == 36 for scan in lidars)
    nearest_m = min(each for scan in lidars for each in scan["ranges_m"] if each is not None)
    assert nearest_m < 1.5
