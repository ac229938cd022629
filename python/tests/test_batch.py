"""One brain for all robots of a kind decides as one brain per robot does."""

import copy
import math
import pickle
import traceback
from collections.abc import Callable, Iterator
from typing import Any, get_args, get_type_hints, is_typeddict

import numpy as np
import pytest
from alarm import ringing
from example_brains import SMALL, Ahead, Talker
from metric import ENDLESS, HUGE, search

import agent_economy as ae
from agent_economy import Batch, InputError, Scenario, Simulation
from agent_economy.runs.batch import Commands, Percepts
from agent_economy.runs.brain import Body, Command, Percept


class Shy(Ahead):
    """Turns away from the closest obstacle, and slows down near it."""

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""
        ranges = [math.inf if far is None else far for far in percept["scans"][0]["ranges_m"]]
        bearings = self.body["rings"][0]["bearings_rad"]
        nearest_m = min([2.0, *ranges])
        side = -1.0 if nearest_m < 2 and bearings[ranges.index(nearest_m)] > 0 else 1.0
        touch = percept["touch"]
        is_held = touch is not None and touch["value"]
        motion = {
            "speed_m_s": -0.1 if is_held else nearest_m - 0.5,
            "turn_rate_rad_s": side * (2.0 - nearest_m),
        }
        return {"motion": motion, "requests": [], "outbox": []}  # type: ignore[typeddict-item]


def shy(percepts: Percepts, memory: dict[str, Any]) -> Commands:
    """Return the commands of `Shy` for all robots."""
    del memory
    ranges_m = percepts["scans"][0]["ranges_m"]
    ranges_m = np.where(np.isnan(ranges_m), math.inf, ranges_m)
    bearings = np.asarray(percepts["body"]["rings"][0]["bearings_rad"])
    nearest_m = np.minimum(2.0, ranges_m.min(axis=1))
    is_left = (nearest_m < 2) & (bearings[ranges_m.argmin(axis=1)] > 0)
    speed_m_s = np.where(percepts["touch"]["value"], -0.1, nearest_m - 0.5)
    turn_rate_rad_s = np.where(is_left, -1.0, 1.0) * (2.0 - nearest_m)
    return {"motion": {"speed_m_s": speed_m_s, "turn_rate_rad_s": turn_rate_rad_s}}


def talk(percepts: Percepts, memory: dict[str, Any]) -> Commands:
    """Return the commands of `Talker` for all robots."""
    robots = percepts["robots"]
    steps = memory.setdefault("steps", np.zeros(percepts["count"], dtype=int))
    steps[robots] += 1
    rows, received = np.arange(len(robots)), np.zeros(len(robots))
    for each in percepts["inbox"]:
        received[each["row"]] += each["from"]["index"] + 1
    mates = np.bincount(percepts["neighbours"]["row"], minlength=len(robots))
    turn_rate_rad_s = 0.2 * received + percepts["random_words"][:, 0] / 2**33
    about: Any = {"item": {"kind": 0, "at": [1.0, 2.0]}}
    seen = percepts["contacts"]["row"]
    return {
        "motion": {"speed_m_s": 0.1 + 0.1 * mates, "turn_rate_rad_s": turn_rate_rad_s},
        "requests": {"row": rows, "sensor": 1, "on": steps[robots] % 5 != 0},
        "outbox": [{"row": row, "about": about, "confidence": 0.5} for row in seen],
    }


def noting(
    note: Callable[[Percepts], object],
    decide: Callable[[Percepts, dict[str, Any]], Commands] = shy,
) -> Batch:
    """Return a brain that passes its percepts to `note` before it decides."""

    def noted(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        note(percepts)
        return decide(percepts, memory)

    return Batch(noted)


def finished(scenario: Scenario, brains: Any, run: int = 2) -> Simulation:
    """Return a finished run."""
    simulation = Simulation(scenario, 7, run, brains=brains)
    simulation.finish()
    return simulation


@pytest.mark.parametrize("run", range(3))
def test_a_batch_is_the_same_run_as_a_class_with_the_same_rule(run: int) -> None:
    scenario = search({"robots.rover.sensors.lidar.dropout_probability": 0.1})
    one, all_at_once = (finished(scenario, {"rover": each}, run) for each in (Shy, Batch(shy)))
    assert one.hash == all_at_once.hash
    assert one.outcome() == all_at_once.outcome()


def test_messages_requests_and_memory_of_a_batch_equal_those_of_a_class() -> None:
    scenario = Scenario.loads(SMALL)
    one, all_at_once = (Simulation(scenario, brains={"bumper": x}) for x in (Talker, Batch(talk)))
    messages = 0
    for _ in range(300):
        one.step()
        all_at_once.step()
        assert all_at_once.decided == one.decided
        messages += sum(len(command["outbox"]) for command in one.decided.values())
    assert one.hash == all_at_once.hash
    assert messages > 10


def test_threads_that_share_a_step_change_no_byte() -> None:
    runs = [
        Simulation(search(HUGE), threads=threads, brains={"rover": Batch(shy)})
        for threads in (1, 3)
    ]
    assert len({run.finish().energy_j for run in runs}) == 1
    assert len({run.hash for run in runs}) == 1


def as_rows(percepts: Any, row: int) -> Any:
    """Return the percept of one robot, as its own brain would get it."""

    def reading(readings: Any) -> Any:
        if math.isnan(readings["age_s"][row]):
            return None
        value = readings["value"]
        if isinstance(value, dict):
            value = {name: part[row].item() for name, part in value.items()}
        else:
            value = value[row].tolist()
        return {"value": value, "age_s": readings["age_s"][row].item()}

    names = ("position", "heading_rad", "motion", "battery", "touch")
    return {name: reading(percepts[name]) for name in names}


def test_arrays_contain_the_percept_of_each_robot() -> None:
    noted: list[Percepts] = []
    simulation = Simulation("open-field", brains={"rover": noting(noted.append)})
    seen = 0
    for _ in range(400):
        alone = [simulation.percept(f"rover/{index}") for index in range(3)]
        simulation.step()
        percepts = noted[-1]
        assert percepts["robots"].tolist() == [0, 1, 2]
        assert percepts["count"] == 3
        for row, percept in enumerate(alone):
            assert percept is not None
            assert percepts["time_s"] == percept["time_s"]
            assert percepts["random_words"][row].tolist() == percept["random_words"]
            for name, value in as_rows(percepts, row).items():
                assert percept[name] == value, name  # type: ignore[literal-required]
            for ring, scan in zip(percepts["scans"], percept["scans"], strict=True):
                ranges = [
                    None if math.isinf(far) else far for far in ring["ranges_m"][row].tolist()
                ]
                assert ranges == scan["ranges_m"]
                assert ring["age_s"][row] == scan["age_s"]
            contacts = percepts["contacts"]
            mine = contacts["row"] == row
            seen += mine.sum()
            assert contacts["bearing_rad"][mine].tolist() == [
                each["bearing_rad"] for each in percept["contacts"]
            ]
            mates = percepts["neighbours"]
            assert mates["id"]["index"][mates["row"] == row].tolist() == [
                each["id"]["index"] for each in percept["neighbours"]
            ]
    assert seen > 5


def fields(columns: Any, types: Any) -> Iterator[str]:
    """Yield the paths at which arrays lack the keys of their types, or have others."""
    if isinstance(columns, list):
        columns, types = columns[0], get_args(types)[0]
    if not is_typeddict(types):
        return
    hints = get_type_hints(types)
    yield from ({*hints} ^ {*columns})
    for key in {*hints} & {*columns} - {"body"}:
        yield from (f"{key}.{path}" for path in fields(columns[key], hints[key]))


def test_arrays_have_the_keys_of_their_types() -> None:
    noted: list[Any] = []
    Simulation("search", brains={"rover": noting(noted.append)}).step()
    assert list(fields(noted[0], Percepts)) == []
    together = {"id": "robots", "team_size": "count"}  # robots of a kind share one
    assert {together.get(name, name) for name in Percept.__annotations__} <= noted[0].keys()


def test_a_command_without_motion_stops_the_robots() -> None:
    simulation = Simulation("search", brains={"rover": Batch(lambda *_: {})})  # type: ignore[arg-type]
    simulation.step(3)
    assert {command["motion"]["speed_m_s"] for command in simulation.decided.values()} == {0.0}


def test_stopped_robots_are_not_in_the_arrays() -> None:
    noted: list[list[int]] = []

    def note(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        del memory
        noted.append(percepts["robots"].tolist())
        return {"motion": {"speed_m_s": percepts["robots"] * 0.5, "turn_rate_rad_s": 0.0}}

    scenario = search({"robots.rover.battery.capacity_j": 500.0})
    ae.run(scenario, brains={"rover": Batch(note)})
    assert noted[0] == [0, 1, 2, 3]
    assert 0 < len(noted[-1]) < 4


def test_each_run_starts_with_an_empty_memory() -> None:
    found: list[int] = []

    def note(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        if percepts["time_s"] == 0:
            found.append(len(memory))
        memory["was_here"] = True
        return {"motion": {"speed_m_s": 1.0, "turn_rate_rad_s": 0.0}}

    ae.replicate("search", 3, brains={"rover": Batch(note)})
    assert found == [0, 0, 0]


def test_a_batch_continues_after_a_change() -> None:
    counts: list[int] = []

    def note(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        counts.append(percepts["count"])
        memory["steps"] = memory.get("steps", 0) + 1
        assert memory["steps"] == len(counts)
        return shy(percepts, memory)

    simulation = Simulation("search", brains={"rover": Batch(note)})
    simulation.step(4)
    simulation.change("robots.rover.count", 6)
    simulation.step(4)
    assert counts == [4, 4, 6, 6]


STAND = {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}
ITEM = {"kind": 0, "at": [1.0, 2.0]}
MESSAGE = {"row": 0, "confidence": 1.0, "about": {"item": ITEM}}


def sent(**changes: Any) -> dict[str, Any]:
    """Return commands with two messages."""
    return {"motion": STAND, "outbox": [MESSAGE, MESSAGE | {"row": 1} | changes]}


def about_goal(**changes: Any) -> dict[str, Any]:
    """Return the content of a message about a goal."""
    goal_id = {"issuer": {"kind": 0, "index": 0}, "number": 0}
    return {"goal": {"at": [1, 2], "status": "done", "id": goal_id} | changes}


ERRORS: list[tuple[Any, str]] = [
    (None, r"brains.rover\(\) = None: must be a dict with motion, heading_rad, requests, outbox"),
    ({"speed": 1}, r"brains.rover\(\).speed = 1: must be one of motion"),
    (
        {"motion": STAND | {"speed_m_s": [1, 2]}},
        r"motion.speed_m_s = array\(\[1., 2.\]\): must be one value",
    ),
    ({"motion": STAND | {"speed_m_s": "fast"}}, r"speed_m_s = str \('fast'\): must be one value"),
    (
        {"motion": STAND | {"turn_rate_rad_s": [0, 0, math.nan, 0]}},
        r"motion.turn_rate_rad_s\[2\] = NaN: must be a finite number",
    ),
    (
        {"motion": STAND, "heading_rad": [0, math.inf, math.nan, 0]},
        r"heading_rad\[1\] = inf: must be a finite number, or NaN for none",
    ),
    (
        {"motion": STAND, "requests": {"row": [4]}},
        r"row\[0\] = 4: must be a whole number from 0 to 3",
    ),
    (
        {"motion": STAND, "requests": {"row": [0], "on": True}},
        "requests.sensor = None: must be given",
    ),
    (
        {"motion": STAND, "requests": {"row": [0, 2], "sensor": [0, 1.5], "on": True}},
        r"requests.sensor\[1\] = 1.5: must be a whole number",
    ),
    (
        {"motion": STAND, "requests": {"row": [2, 0], "sensor": [70000, 0], "on": True}},
        r"requests.sensor\[0\] = 70000: must be",
    ),
    (
        {"motion": STAND, "requests": {"sensor": [0], "on": True}},
        "requests.row = None: must be given",
    ),
    (
        {"motion": STAND | {"speed_m_s": np.full(4, 1j)}},
        "motion.speed_m_s = numpy.ndarray of shape .* and type complex128: must be one value",
    ),
    (
        {"motion": STAND | {"speed_m_s": [0, None, 0, 0]}},
        r"motion.speed_m_s\[1\] = None: must be one value",
    ),
    ({"motion": STAND, "outbox": 3}, r"rover\(\).outbox = 3: must be a list of dicts, one"),
    ({"motion": STAND, "outbox": [3]}, r"outbox\[0\] = 3: must be a dict with row, about"),
    ({"motion": STAND, "outbox": [{"confidence": 1}]}, r"\[0\].row = None: must be a whole"),
    (sent(row=4), r"rover\(\).outbox\[1\].row = 4: must be a whole number from 0 to 3, the row"),
    (sent(row=True), r"outbox\[1\].row = True: must be a whole number from 0 to 3"),
    (sent(about={}), r"outbox\[1\].about = {...}: must be a dict with item"),
    (sent(about={"sender": {"at": [1, 2]}}), r"outbox\[1\].about.sender.heading_rad is missing"),
    (sent(about=about_goal(id={})), r"outbox\[1\].about.goal.id.issuer is missing"),
    (sent(about=about_goal(status="lost")), r"about.goal.status = \"?lost\"?: must be"),
    (sent(about={"item": ITEM | {"kind": 1}}), r"outbox\[1\].about.item.kind = 1: must be a"),
    (sent(confidence=5), r"outbox\[1\].confidence = 5: must be a number from 0 to 1"),
    (
        sent(confidence=math.nan),
        r"outbox\[1\].confidence = nan: must be a finite number; only a ray",
    ),
]


@pytest.mark.parametrize(("commands", "words"), ERRORS)
def test_invalid_commands_are_named_and_the_run_does_not_advance(commands: Any, words: str) -> None:
    simulation = Simulation("search", brains={"rover": Batch(lambda *_: commands)})
    with pytest.raises(InputError, match=words):
        simulation.step()
    assert simulation.tick == 0


def test_a_batch_must_be_callable() -> None:
    with pytest.raises(InputError, match="Batch = 3: must be a function on arrays"):
        Batch(3)  # type: ignore[arg-type]


def test_exceptions_of_a_batch_keep_their_traceback() -> None:
    def wrong(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        del percepts
        return memory["nothing"]  # type: ignore[no-any-return]

    with pytest.raises(KeyError) as caught:
        ae.run("search", brains={"rover": Batch(wrong)})
    assert caught.value.__notes__ == ["in the brain of all robots of kind rover, at 0 s"]
    frames = traceback.extract_tb(caught.value.__traceback__)
    assert frames[-1].name == "wrong"


def test_a_signal_stops_runs_with_a_batch() -> None:
    with ringing(0.3):
        ae.run(search(ENDLESS), brains={"rover": Batch(shy)})


def test_received_messages_are_a_sequence_that_can_be_copied() -> None:
    found: list[Any] = []

    def tell(percepts: Percepts, memory: dict[str, Any]) -> Commands:
        del memory
        found.append(percepts["inbox"])
        return {"outbox": [MESSAGE, MESSAGE]}  # type: ignore[list-item]

    Simulation("search", brains={"rover": Batch(tell)}).step(3)
    inbox = found[-1]
    dicts = list(inbox)
    assert len(inbox) == len(dicts) > 1
    assert inbox[-1] == dicts[-1]
    assert inbox[:2] == dicts[:2]
    assert copy.deepcopy(inbox) == pickle.loads(pickle.dumps(inbox)) == dicts  # noqa: S301
    assert inbox.index(dicts[0]) == 0
    assert repr(inbox) == repr(dicts)
    with pytest.raises(IndexError):
        inbox[10**30]


def test_the_order_in_memory_of_an_array_does_not_matter() -> None:
    places = np.array([[1.0, 2.0], [3.0, 4.0]])
    unaligned = np.frombuffer(bytearray(2 * 8 + 1), "f8", count=2, offset=1)
    scenario = search({"robots.rover.tools": {"mark": {"range_m": 50}}, "robots.rover.count": 2})
    for at in (places, places.T.copy().T, np.asfortranarray(places), places[::-1][::-1]):
        acts = {"row": [0, 1], "kind": 0, "at": at}
        motion = {"speed_m_s": unaligned, "turn_rate_rad_s": np.zeros(4)[::2]}
        brain = Batch(lambda *_, acts=acts, motion=motion: {"motion": motion, "acts": acts})  # type: ignore[arg-type]
        simulation = Simulation(scenario, brains={"rover": brain})
        simulation.step()
        decided = [command["acts"][0]["at"] for command in simulation.decided.values()]
        assert decided == places.tolist()


def test_a_batch_gets_the_same_body_as_a_class() -> None:
    bodies: list[Body] = []
    brain = noting(lambda percepts: bodies.append(percepts["body"]))
    Simulation("search", brains={"rover": lambda body: bodies.append(body) or Ahead(body)})  # type: ignore[func-returns-value]
    Simulation("search", brains={"rover": brain}).step()
    assert bodies[0] == bodies[-1]
