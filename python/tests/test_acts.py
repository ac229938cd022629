"""Acts of robots on items: their errors, lines in recordings, and columns of outcomes."""

import json
import struct
from pathlib import Path
from typing import Any

import pytest
from command_line import succeed
from metric import world
from recorded import contents

import agent_economy as ae
from agent_economy import InputError, Scenario, Simulation, _core
from agent_economy.runs.brain import Body, Command, Percept

LANE = world("""
clock.time_limit_s = 20
world.size_m = [20, 10]
[items.mine]
count = 1
completed_by = "neutralised"
hazard.radius_m = 0.2
placement = { kind = "fixed", at_m = [[6, 5]] }
[robots.ugv]
count = 1
radius_m = 0.3
price = 2
payload_kg = 2
start = { kind = "fixed", at_m = [[4, 5]], heading_deg = [0] }
drive = { max_speed_m_s = 1, max_turn_rate_deg_s = 90 }
brain.behaviours = [{ kind = "cruise" }]
sensors.eye = { kind = "items", range_m = 2 }
tools = { mark.range_m = 10, neutralise = { range_m = 3, duration_s = 1, charges = 2 } }
""")

MINE = [6, 5]


def command(*acts: Any, speed_m_s: float = 0.0) -> Command:
    """Return a command with acts."""
    return {
        "motion": {"speed_m_s": speed_m_s, "turn_rate_rad_s": 0.0},
        "heading_rad": None,
        "requests": [],
        "outbox": [],
        "acts": list(acts),
    }


class Actor:
    """Commands the same acts at each step."""

    def __init__(self, *acts: Any) -> None:
        """Keep the acts."""
        self.acts = acts
        self.percepts: list[Percept] = []

    def __call__(self, _: Body) -> "Actor":
        """Be the brain of a robot."""
        return self

    def step(self, percept: Percept) -> Command:
        """Decide."""
        self.percepts.append(percept)
        return command(*self.acts)


MARK = {"kind": "mark", "at": MINE}

ERRORS: list[tuple[list[Any], str]] = [
    (
        [{"kind": "blow_up", "at": MINE}],
        r'acts\[0\]\.kind = "blow_up": must be one of "mark", "con',
    ),
    ([MARK, {"kind": "mark"}], r"acts\[1\]\.at is missing: expected a list of 2 numbers"),
    ([{"at": MINE}], r"acts\[0\]\.kind is missing"),
    ([{"kind": "mark", "at": [5]}], r"acts\[0\]\.at = \[5\]: must be a list of 2 numbers"),
    ([{"kind": "mark", "at": ["x", 5]}], r'acts\[0\]\.at\[0\] = "x": must be a number'),
    ([{"kind": "mark", "at": [5, float("nan")]}], r"acts\[0\]\.at\[1\] = nan: must be a finite"),
    ([{"kind": "mark", "at": [float("inf"), 5]}], r"acts\[0\]\.at\[0\] = inf: must be a finite"),
    ([MARK | {"charge": 1}], r"acts\[0\]\.charge is not a known key"),
    ([{"kind": "isolate", "at": MINE}], r"acts\[0\]\.kind = isolate: must be an act for which"),
    ([MARK] * 5, r"acts = 5 acts: must be at most 4 acts"),
]


@pytest.mark.parametrize(("acts", "words"), ERRORS)
def test_errors_of_acts_name_their_place_in_commands_and_brains(
    acts: list[Any], words: str
) -> None:
    scenario = Scenario.loads(LANE)
    with pytest.raises(InputError, match=r'^commands\."ugv/0"\.' + words):
        Simulation(scenario).step(commands={"ugv/0": command(*acts)})
    with pytest.raises(InputError, match=r'^brains\."ugv/0"\.step\(\)\.' + words):
        Simulation(scenario, brains={"ugv": Actor(*acts)}).step()


def test_a_python_brain_neutralises_a_mine_and_perceives_the_result() -> None:
    actor = Actor(MARK, {"kind": "neutralise", "at": [6.2, 5]})
    two = LANE.replace("count = 1", "count = 2", 1).replace("[[6, 5]]", "[[6, 5], [15, 9]]")
    simulation = Simulation(Scenario.loads(two), brains={"ugv": actor})
    simulation.step(25)
    seen = [(each["kind"], each["is_success"]) for seen in actor.percepts for each in seen["acted"]]
    assert seen.count(("neutralise", True)) == 1
    assert ("mark", True) in seen
    assert [actor.percepts[step]["charges"] for step in (0, -1)] == [2, 0]
    row = simulation.outcome().row
    assert [row[name] for name in ("marked", "neutralised", "left")] == [1, 1, 1]


STANDING_STEPS = 12


def test_the_page_shows_an_item_that_was_destroyed_and_a_robot_that_it_destroyed() -> None:
    simulation = Simulation(Scenario.loads(LANE))
    frames = [_core.frame(simulation._run)]
    simulation.finish()
    frames.append(_core.frame(simulation._run))
    # Four 32-bit floats of the robot, the last its state; then a byte for the item.
    shown = [struct.unpack("<4fB", frame)[3:] for frame in frames]
    hidden, found, destroyed, clear, broken = 0, 1, 3, 0.0, 4.0
    assert shown[0] in {(clear, hidden), (clear, found)}
    assert shown[1] == (broken, destroyed)


def test_acts_and_lost_robots_are_in_the_log_of_a_recording(mcap: Path) -> None:
    acts = [MARK, {"kind": "mark", "at": [1, 1]}, {"kind": "neutralise", "at": [3, 5]}]
    with ae.Recording(Simulation(Scenario.loads(LANE)), mcap) as recording:
        for step in range(42):
            commanded = command(*acts) if step < STANDING_STEPS else command(speed_m_s=1.0)
            recording.step(commands={"ugv/0": commanded})
    lines = [each.content for each in contents(mcap).topics["/log"]]
    words = [(each.name, each.message) for each in lines]
    assert words[:3] == [
        ("mine/0", "found at 0.000 s"),
        ("ugv/0", "mark mine/0 at (6.0, 5.0)"),
        ("ugv/0", "mark nothing at (1.0, 1.0)"),
    ]
    assert ("ugv/0", "neutralise nothing at (3.0, 5.0), failed") in words
    assert ("ugv/0", "destroyed by mine/0") in words
    destroyed = words.index(("ugv/0", "destroyed by mine/0"))
    assert lines[destroyed].level == lines[destroyed].ERROR


def test_outcomes_of_acts_are_columns_of_runs_and_studies(tmp_path: Path) -> None:
    path = tmp_path / "lane.toml"
    path.write_text(LANE, "utf-8")
    printed = json.loads(succeed("run", str(path), "--json").stdout)
    expected = {"marked": 0, "neutralised": 0, "left": 0, "robots_lost": 1, "met_unmarked": 1}
    assert {name: printed[name] for name in expected} == expected
    columns = json.loads(succeed("replicate", str(path), "--runs", "3", "--json").stdout)["columns"]
    means = {column["column"]: column["mean"] for column in columns}
    assert means["robots_lost"] == 1
    text = LANE + '[study]\nvary = { "robots.ugv.count" = "1..2" }\n'
    text += '[require]\nall = ["robots_lost <= 1"]\nprobability = 0.9\ntolerance = 0.05\n'
    text = text.replace('kind = "fixed", at_m = [[4, 5]], heading_deg = [0]', 'kind = "uniform"')
    out = tmp_path / "study"
    ae.study.run(Scenario.loads(text), out=out, max_runs=40)
    lost = ae.study.open(out).runs().to_arrow_table()["robots_lost"].to_pylist()
    assert set(lost) <= {0, 1, 2}
    assert sum(lost) > 0
