"""Arguments of the wrong type raise the same errors as invalid values."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import agent_economy as ae
from agent_economy import study

NO: Any = 5
NAMES = r"must be a list of robot names"
PATH = r"must be the path of a file or folder"


def loads(**arguments: Any) -> ae.Scenario:
    text = ae.Scenario.load("classic").source.text
    given: dict[str, Any] = {"text": text}
    return ae.Scenario.loads(**given | arguments)


def recording(**arguments: Any) -> ae.Recording:
    given: dict[str, Any] = {"simulation": ae.Simulation("search"), "path": "never.mcap"}
    return ae.Recording(**given | arguments)


def answer(**arguments: Any) -> study.AnyAnswer:
    given: dict[str, Any] = {"scenario": loads(), "delta": 2.0}
    return study.run(**given | arguments)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: ae.Scenario.load(NO), rf"^file = 5: {PATH}$"),
        (lambda: loads(text=NO), r"^text = 5: must be a string of TOML$"),
        (lambda: loads(file=NO), r"^file = 5: must be a file name"),
        (lambda: loads(overrides=NO), r"^overrides = 5: must be a tuple of Override$"),
        (lambda: loads().changed((NO,)), r"^overrides = 5: must be a tuple of Override$"),
        (lambda: loads().configuration(NO), r"^values = 5: must be a dict of values"),
        (lambda: loads().configuration({NO: 1}), r"^values: path = 5: must be keys from the root"),
        (lambda: loads(text="\ud800"), r"^text = '\\ud800': must be a string of TOML$"),
        (lambda: loads().replace("a" + ".a" * 20_000, 1), r"path = 'a\.a.*; at most 32$"),
        (lambda: loads().replace("\ud800", 1), r"path = '\\ud800': must be keys from the root"),
        (lambda: ae.Simulation("search").change([1], 1), r"path = \[1\]: must be keys"),  # type: ignore[arg-type]
        (lambda: ae.replay(NO), rf"^path = 5: {PATH}$"),
        (lambda: ae.run("search", record=NO), rf"^record = 5: {PATH}$"),
        (lambda: ae.run("search", seed="a"), r"^seed = 'a': must be a whole number from 0"),  # type: ignore[arg-type]
        (lambda: ae.replicate("search", runs="many"), r"^runs = 'many': must be a whole number"),  # type: ignore[arg-type]
        (lambda: recording(path=NO), rf"^path = 5: {PATH}$"),
        (lambda: recording(percepts=None), rf"^percepts = None: {NAMES}$"),
        (lambda: recording(percepts="rover/0"), rf"^percepts = 'rover/0': {NAMES}$"),
        (lambda: recording(percepts=[[]]), rf"^percepts = \[\[\]\]: {NAMES}$"),
        (lambda: answer(scenario=NO), r"^scenario = 5: must be a Scenario, a file, or the name of"),
        (lambda: answer(vary=NO), r"^vary = 5: must be a dict of values by their paths$"),
        (lambda: answer(vary={"contact": NO}), r"^vary: contact = 5: must be a list of values"),
        (lambda: answer(vary={NO: "1"}), r"^vary: path = 5: must be keys from the root"),
        (lambda: answer(out=NO), rf"^out = 5: {PATH}$"),
        (lambda: answer(compute=NO), r"^compute = 5: must be a function or None$"),
        (lambda: answer(on_progress=NO), r"^on_progress = 5: must be a function or None$"),
        (lambda: study.make_plan(NO), r"^scenario = 5: must be a Scenario$"),
        (lambda: study.run_plan(NO, "never"), r"^plan = 5: must be a Plan"),
        (lambda: study.resume(NO), rf"^folder = 5: {PATH}$"),
        (lambda: study.open(NO), rf"^folder = 5: {PATH}$"),
        (lambda: study.is_locked(NO), rf"^folder = 5: {PATH}$"),
        (
            lambda: study.select_best(NO, 2, bounds=(0, 1), delta=0.1),
            r"^sampler = 5: must be a function of configurations",
        ),
    ],
)
def test_an_argument_of_the_wrong_type_is_named(
    call: Callable[[], object], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ae.InputError, match=message):
        call()
    assert list(tmp_path.iterdir()) == []


def test_an_argument_that_is_missing_or_unknown_is_a_type_error() -> None:
    call: Any = ae.run
    with pytest.raises(TypeError):
        call()
    with pytest.raises(TypeError):
        call("search", sede=7)


def test_long_values_are_shortened_in_errors() -> None:
    long = "x" * 2**20
    given: list[tuple[Callable[[], object], str]] = [
        (lambda: loads().replace(f"robots.{long}.count", 3), "replace: robots.xxx"),
        (lambda: loads().replace("contact", long), 'replace: contact = "xxx'),
        (lambda: loads(text=f"{long} = '{long}'"), "scenario.toml"),
        (lambda: ae.Brain(None, {long: 1}), "body.xxx"),  # type: ignore[misc]
        (lambda: ae.Simulation("search", seed=[0] * 2**20), "seed = [0, 0"),  # type: ignore[arg-type]
    ]
    for call, message in given:
        with pytest.raises(ae.InputError) as caught:
            call()
        assert message in str(caught.value)
        assert all(len(line) < 500 for line in str(caught.value).splitlines())
