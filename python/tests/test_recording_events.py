"""Events in the log of recordings: each has the time of its own step."""

from pathlib import Path

import pytest
from metric import search
from recorded import SECOND_NS, contents

import agent_economy as ae
from agent_economy.runs.brain import Command
from agent_economy.runs.stepped import Stepped

CROWDED = search(
    {
        "robots.rover.count": 30,
        "robots.rover.collision": {"max_collisions": 3, "stop_duration_s": 0},
        "robots.rover.drive.max_reverse_speed_m_s": 1,
        "world.size_m": [26, 25],
        "items.mine.count": 200,
        "clock.time_limit_s": 10,
    }
)


FORWARD_STEPS = 5


def pacing(simulation: Stepped) -> dict[str, Command]:
    """Return commands to all robots to go forward and back, so that some collide often."""
    speed_m_s = 1.0 if simulation.tick % 8 < FORWARD_STEPS else -1.0
    command: Command = {
        "motion": {"speed_m_s": speed_m_s, "turn_rate_rad_s": 0.0},
        "heading_rad": None,
        "requests": [],
        "outbox": [],
    }
    return dict.fromkeys(simulation.robots, command)


def pace(run: ae.Simulation | ae.Recording, steps: int) -> None:
    """Let all robots go forward and back, with or without a recording."""
    simulation = run.simulation if isinstance(run, ae.Recording) else run
    for _ in range(steps):
        run.step(commands=pacing(simulation))


def log(path: Path) -> list[tuple[int, str, str]]:
    """Return the time, the name and the words of each line of the log."""
    lines = contents(path).topics["/log"]
    return [(each.time_ns, each.content.name, each.content.message) for each in lines]


@pytest.fixture
def complete(tmp_path: Path) -> list[tuple[int, str, str]]:
    """The log of a run of 99 steps of which each is recorded."""
    path = tmp_path / "complete.mcap"
    with ae.Recording(ae.Simulation(CROWDED, 1), path) as recording:
        pace(recording, 99)
    return log(path)


def test_the_run_has_repeated_collisions_breakdowns_and_finds(
    complete: list[tuple[int, str, str]],
) -> None:
    words = [message for *_, message in complete]
    assert words.count("collision, 3 in total") == words.count("broken") > 3
    assert sum(message.startswith("found at") for message in words) > 3


@pytest.mark.parametrize("every", [2, 10, 1000])
def test_each_event_is_logged_at_its_own_step_whatever_steps_are_recorded(
    mcap: Path, complete: list[tuple[int, str, str]], every: int
) -> None:
    with ae.Recording(ae.Simulation(CROWDED, 1), mcap, every=every) as recording:
        pace(recording, 99)
    lines = log(mcap)
    assert sorted(lines) == sorted(complete)
    times = [time_ns for time_ns, *_ in lines]
    assert times == sorted(times)


def test_events_between_two_notes_are_logged_at_their_own_times(
    mcap: Path, complete: list[tuple[int, str, str]]
) -> None:
    simulation = ae.Simulation(CROWDED, 1)
    with ae.Recording(simulation, mcap) as recording:
        for steps in (7, 30, 62):
            pace(simulation, steps)
            recording.note()
    assert sorted(log(mcap)) == sorted(complete)


def test_a_change_between_two_recorded_steps_loses_no_event(tmp_path: Path) -> None:
    logs = []
    for every in (1, 10, 1000):
        path = tmp_path / f"{every}.mcap"
        simulation = ae.Simulation(CROWDED, 1)
        with ae.Recording(simulation, path, every=every) as recording:
            pace(recording, 15)
            pace(simulation, 33)
            # The kinds of robots have other numbers then.
            simulation.change("robots.ant", {"model": "ugv", "count": 1})
            simulation.change("robots.rover.count", 5)
            pace(recording, 40)
        logs.append(sorted(log(path)))
    assert logs[0] == logs[1] == logs[2]
    between = [name for time_ns, name, words in logs[0] if is_collision(words, time_ns)]
    assert between
    assert all(name.startswith("rover/") for name in between)


def is_collision(words: str, time_ns: int) -> bool:
    """Return whether a line is a collision of the steps that were not taken by the recording."""
    return words.startswith("collision") and 1.5 * SECOND_NS < time_ns <= 4.8 * SECOND_NS


def test_two_recordings_of_a_run_have_the_same_log(tmp_path: Path) -> None:
    simulation = ae.Simulation(CROWDED, 1)
    one, other = tmp_path / "one.mcap", tmp_path / "other.mcap"
    with ae.Recording(simulation, one) as first, ae.Recording(simulation, other) as second:
        for _ in range(60):
            pace(first, 1)
            second.note()
    assert log(one) == log(other) != []


def test_a_recording_continues_after_a_run_has_returned_to_its_step(
    mcap: Path, complete: list[tuple[int, str, str]]
) -> None:
    simulation = ae.Simulation(CROWDED, 1)
    with ae.Recording(simulation, mcap) as recording:
        pace(recording, 50)
        snapshot = simulation.snapshot()
        pace(simulation, 30)
        simulation.restore(snapshot)
        pace(recording, 49)
    assert log(mcap) == complete


def test_a_recording_that_starts_late_logs_each_earlier_find_once(mcap: Path) -> None:
    simulation = ae.Simulation(CROWDED, 1)
    pace(simulation, 50)
    with ae.Recording(simulation, mcap, every=10) as recording:
        pace(recording, 40)
    found = [(name, words) for _, name, words in log(mcap) if words.startswith("found at")]
    found_s = simulation.items["found_s"].to_pylist()
    expected = [
        (f"mine/{number}", f"found at {at_s:.3f} s")
        for number, at_s in enumerate(found_s)
        if at_s is not None
    ]
    assert sorted(found) == sorted(expected)
    assert all(time_ns >= 5 * SECOND_NS for time_ns, *_ in log(mcap))
