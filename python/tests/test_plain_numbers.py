"""What a user's function returns is taken as numbers only if it cannot mean anything else."""

from array import array
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from datetime import timedelta
from decimal import Decimal
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import small_study
from numpy.typing import NDArray
from synthetic_runs import COLUMNS, outcomes, same

import agent_economy as ae
from agent_economy import Batch, InputError, Simulation, study
from agent_economy.runs.controller import assignment
from agent_economy.study.run_block import Columns, RunBlock
from agent_economy.study.store import Store
from agent_economy.study.workers import Workers

Floats = NDArray[np.float64]

SHARES: Floats = np.array([[0.2], [0.9], [0.5]])
"""The merit of every run of three configurations."""

SEARCH = ae.Scenario.load("search")

BODY: Any = {"radius_m": 0.25, "max_speed_m_s": 1, "max_turn_rate_rad_s": 1.5, "period_s": 0.1}


class Kilometres(np.ndarray[Any, Any]):
    """An array with a unit, as astropy and unyt have."""

    unit = "km"


class Quantity:
    """A quantity with a unit that passes all else on to its numbers, as pint does."""

    units = "kilometre"

    def __init__(self, magnitude: Any) -> None:
        """Take the numbers."""
        self.magnitude = magnitude

    def __getattr__(self, name: str) -> Any:
        """Return what the numbers have."""
        if name in {"magnitude", "unit", "iloc", "dims"}:
            raise AttributeError(name)
        return getattr(self.magnitude, name)

    def __float__(self) -> float:
        """Return the number without its unit."""
        return float(self.magnitude)


class Table:
    """Numbers with labels, as pandas has."""

    iloc = None

    def __init__(self, values: Floats) -> None:
        """Take the values."""
        self._values = values

    def __array__(self, dtype: Any = None, copy: Any = None) -> Floats:
        """Return the values, whatever their labels."""
        return np.array(self._values, dtype=dtype)


class Exported:
    """An array of another library."""

    def __init__(self, values: Floats) -> None:
        """Take the values."""
        self._values = values

    def __dlpack__(self, **options: Any) -> Any:
        """Return the values."""
        return self._values.__dlpack__(**options)

    def __dlpack_device__(self) -> Any:
        """Return where they are."""
        return self._values.__dlpack_device__()


def merits(configurations: NDArray[np.int64], runs: int) -> Floats:
    """Return the merits of runs."""
    return np.repeat(SHARES[configurations], runs, axis=1)


def masked(values: Floats) -> Any:
    """Return values whose first row is masked, with the best merit below the mask."""
    found = np.ma.array(values, mask=np.zeros(values.shape, bool))
    found[0] = np.ma.masked
    found.data[0] = 1
    return found


def selected(change: Callable[[Floats], Any], k: int = 3) -> study.Selection:
    """Return the best of some configurations whose merits are changed."""
    return study.select_best(
        lambda configurations, _, runs: change(merits(configurations, runs)),
        k,
        bounds=(0, 1),
        delta=0.3,
    )


CLEAR: list[Callable[[Floats], Any]] = [
    lambda values: values.tolist(),
    lambda values: tuple(map(tuple, values)),
    np.ma.array,
    lambda values: np.ma.array(values, mask=np.zeros(values.shape, bool)),
    lambda values: values.astype(object),
    np.asfortranarray,
    lambda values: values.astype(">f8"),
    lambda values: memoryview(values.data),
    lambda values: [array("d", row) for row in values],
    lambda values: [[Decimal(str(each)) for each in row] for row in values.tolist()],
    lambda values: [[Fraction(str(each)) for each in row] for row in values.tolist()],
    lambda values: [[np.array(each) for each in row] for row in values],
    lambda values: values.astype(np.longdouble),
    Exported,
]


@pytest.mark.parametrize("change", CLEAR)
def test_numbers_of_any_type_select_the_same(change: Callable[[Floats], Any]) -> None:
    assert selected(change) == selected(lambda values: values)


def above(kind: Any, values: Floats) -> Any:
    """Return whether values are high, as numbers of a type."""
    return (values > 0.8).astype(kind)


def test_whole_numbers_and_flags_are_merits() -> None:
    kinds: list[Any] = [bool, np.int8, np.uint64, np.float16]
    for kind in kinds:
        found = selected(partial(above, kind))
        assert found.mean.tolist() == [0, 1, 0]


UNCLEAR: list[tuple[Callable[[Floats], Any], str]] = [
    (masked, r"numpy.MaskedArray of shape \(3, 10\) and type float64 with 10 masked: .*filled"),
    (lambda values: [*masked(values)], r"list with .* with 10 masked at \[0\]: .*filled"),
    (lambda values: values.view(Kilometres), "Kilometres of shape .* in km: .*unit"),
    (lambda values: [row.view(Kilometres) for row in values], r"in km at \[0\]: .*unit"),
    (Quantity, "Quantity of shape .* in kilometre: .*unit"),
    (lambda values: [[Quantity(each) for each in row] for row in values], "in kilometre at"),
    (lambda values: values.astype("m8[s]"), r"type timedelta64\[s\]: .*timedelta64"),
    (lambda values: values.astype("M8[s]"), r"type datetime64\[s\]: "),
    (lambda _: [[timedelta(1)] * 10] * 3, r"datetime.timedelta at \[0\]\[0\]: .*seconds"),
    (Table, "Table: .*labels"),
    (lambda values: [Table(row) for row in values], r"Table at \[0\]: .*labels"),
    (lambda values: dict(enumerate(values)), "dict: "),
    (lambda values: values.astype(str), "type <U32: .*text"),
    (lambda values: values.astype(str).tolist(), r"str \('0.2'\) at \[0\]\[0\]: .*text"),
    (lambda values: values.astype("S3"), r"type \|S3: .*text"),
    (lambda values: values + 1j, "type complex128: .*real"),
    (lambda values: (values + 1j).tolist(), r"complex at \[0\]\[0\]: .*real"),
    (lambda _: [[np.complex64(1j)] * 10] * 3, "type complex64"),
    (lambda _: None, "None: .*nan"),
    (lambda values: [[None] * 10, *values.tolist()[1:]], r"None at \[0\]\[0\]: .*numpy.nan"),
    (lambda values: (row for row in values), r"generator: .*list\(x\)"),
    (lambda values: set(values[:, 0].tolist()), "set: .*order"),
    (lambda values: np.full(values.shape, np.inf, np.float16), "infinite numbers: .*float64"),
    (lambda values: np.full(values.shape, np.inf, np.float32), "infinite numbers: .*float64"),
    (lambda values: np.full(values.shape, 2**53 + 1), "the whole number 9007199254740993: .*2.53"),
    (lambda values: np.full(values.shape, 2**53 + 1).tolist(), "9007199254740993 at"),
    (lambda _: [[10**400] * 10] * 3, r"int \(int too large"),
    (lambda values: np.zeros(values.shape, [("merit", float)]), r"\[\('merit', '<f8'\)\]: .*field"),
    (lambda _: 0.5, r"shape \(\): must be numbers of shape \(3, 10\)"),
    (lambda _: np.array([0.5]), r"shape \(1,\): must be .* not repeated"),
    (lambda values: values[:, :1], r"shape \(3, 1\): must be .* not repeated"),
    (lambda values: values[:, 0], r"shape \(3,\): must be"),
    (lambda values: values.ravel(), r"shape \(30,\): must be .*reshape\(3, 10\)"),
    (np.transpose, r"shape \(10, 3\): must be .*x\.T"),
    (lambda values: values[..., np.newaxis], r"shape \(3, 10, 1\): must be"),
]


@pytest.mark.parametrize(("change", "words"), UNCLEAR)
def test_a_result_that_is_not_certainly_numbers_is_refused(
    change: Callable[[Floats], Any], words: str
) -> None:
    with pytest.raises(InputError, match=f"^the sampler returned .*{words}"):
        selected(change)


def test_merits_in_another_order_are_refused_also_if_their_shape_is_square() -> None:
    shares = np.linspace(0, 0.9, 10)[:, np.newaxis]

    def sample(configurations: NDArray[np.int64], _: int, runs: int) -> Floats:
        return np.repeat(shares[configurations], runs, axis=1).T

    with pytest.raises(InputError, match=r"exchange rows and columns"):
        study.select_best(sample, 10, bounds=(0, 1), delta=0.9)


def test_merits_are_copied_before_the_sampler_runs_again() -> None:
    memory = np.empty((3, 1000))

    def sample(configurations: NDArray[np.int64], _: int, runs: int) -> Floats:
        found = memory[: len(configurations), :runs]
        found[:] = merits(configurations, runs)
        return found

    found = study.select_best(sample, 3, bounds=(0, 1), delta=0.01)
    assert found.mean.round(6).tolist() == SHARES[:, 0].tolist()


def test_arguments_of_numpy_count_as_the_numbers_that_they_are() -> None:
    def found(**arguments: Any) -> study.Selection:
        given: dict[str, Any] = {
            "k": 3,
            "bounds": (0, 1),
            "delta": 0.25,
            "seed": 7,
            "confidence": 0.75,
        }
        given |= arguments
        k = given.pop("k")
        return study.select_best(lambda each, _, runs: merits(each, runs), k, **given)

    same: list[dict[str, Any]] = [
        {"seed": np.uint8(7)},
        {"k": np.int8(3)},
        {"delta": np.float32(0.25), "confidence": np.float16(0.75)},
        {"bounds": np.ma.array([0, 1])},
        {"bounds": [[np.float32(0), Decimal(1)]] * 3},
        {"max_runs": np.uint16(60_000)},
    ]
    for arguments in same:
        assert found(**arguments) == found()
    wrong: list[dict[str, Any]] = [
        {"delta": np.complex64(0.25 + 3j)},
        {"seed": np.timedelta64(7, "s")},
        {"k": np.timedelta64(3, "ns")},
        {"bounds": np.ma.array([0, 1], mask=[True, False])},
        {"bounds": np.array([0, 1]).view(Kilometres)},
        {"bounds": ("0", "1")},
        {"bounds": [0, 10**400]},
    ]
    for arguments in wrong:
        with pytest.raises(InputError, match=f"^{next(iter(arguments))} = "):
            found(**arguments)


def computed(change: Callable[[Columns], Any]) -> Any:
    """Return the answer of a small study whose outcomes are changed."""
    plan = small_study.plan()
    scenario = plan.scenario.replace("study.vary.robots.wanderer.count", "1,2")
    engine = study.make_plan(scenario, runs=6).engine
    return study.run(scenario, runs=6, compute=lambda block: change(engine(block)))


def test_a_study_takes_outcomes_of_any_type_of_numbers() -> None:
    def other(columns: Columns) -> Any:
        failed = columns["failed"].astype(bool)
        return columns | {"failed": failed, "time_s": columns["time_s"].tolist()}

    assert computed(other).results == computed(lambda columns: columns).results


OUTCOMES: list[tuple[Callable[[Columns], Any], str]] = [
    (lambda columns: columns | {"time_s": masked(columns["time_s"])}, "column time_s .* masked"),
    (
        lambda columns: columns | {"time_s": columns["time_s"].view(Kilometres)},
        "column time_s .*in km",
    ),
    (lambda columns: columns | {"time_s": columns["time_s"][:, 0]}, r"numbers of shape \(\d,\)"),
    (lambda columns: columns | {"time_s": 3.0}, r"numbers of shape \(\)"),
    (lambda columns: columns | {"time_s": columns["time_s"].astype(str)}, "type <U32"),
    (lambda columns: columns | {"time_s": columns["time_s"].T}, "exchange rows and columns"),
    (lambda columns: columns | {"robots": columns["robots"] / 3}, r"robots \(whole\) cannot"),
    (lambda columns: columns | {"speed": columns["time_s"]}, "have speed: must be"),
    (lambda columns: {"time_s": columns["time_s"]}, "lack failed.*: must be"),
    (lambda columns: Table(columns["time_s"]), "Table for configurations .*: must be a dict"),
    (lambda _: None, "None for configurations .*: must be a dict"),
    (lambda _: {}, "no columns for configurations .*: must be a dict"),
]


@pytest.mark.parametrize(("change", "words"), OUTCOMES)
def test_outcomes_that_are_not_certainly_numbers_are_refused(
    change: Callable[[Columns], Any], words: str
) -> None:
    with pytest.raises(InputError, match=words):
        computed(change)


def test_outcomes_are_copied_before_the_next_are_computed(tmp_path: Path) -> None:
    memory = outcomes(RunBlock((0, 1), 0, 9))

    def reused(block: RunBlock) -> Columns:
        for name, values in outcomes(block).items():
            memory[name][:] = values
        return memory

    blocks = [RunBlock((0, 1), first, 9) for first in (0, 9)]
    with Store.open(tmp_path, "question", COLUMNS) as store:
        found = [store.block(block, reused) for block in blocks]
    assert all(map(same, found, map(outcomes, blocks)))


def test_workers_refuse_outcomes_with_rows_and_columns_exchanged() -> None:
    def exchanged(block: RunBlock) -> Columns:
        return {"time_s": np.zeros(block.shape).T}

    with (
        Workers(lambda: ThreadPoolExecutor(1), 1, exchanged) as workers,
        pytest.raises(
            InputError,
            match="runs .*: compute returned for column time_s .*exchange rows and columns",
        ),
    ):
        workers.columns(RunBlock((0, 1, 2, 3), 0, 4))


NUMBERS: list[tuple[Any, str]] = [
    (np.ma.array(0.25, mask=True), "1 masked"),
    (np.ma.masked, "1 masked"),
    (np.array(0.25).view(Kilometres), "in km"),
    (Quantity(0.25), "in kilometre"),
    (np.timedelta64(1, "s"), "timedelta64"),
    (np.complex64(0.25 + 1j), "complex64"),
    (np.float16(np.inf), "infinite"),
    (b"0.25", "bytes"),
]


@pytest.mark.parametrize(("number", "words"), NUMBERS)
def test_numbers_in_commands_and_arguments_are_refused_unless_they_are_plain(
    number: Any, words: str
) -> None:
    command: Any = {"motion": {"speed_m_s": number, "turn_rate_rad_s": 0.0}}

    class Brain:
        def __init__(self, body: object) -> None:
            """Ignore the body."""

        def step(self, percept: object) -> Any:
            """Return the command."""
            del percept
            return command

    given: Any = number
    calls: dict[str, Callable[[], object]] = {
        r'brains."rover/0".step\(\)': lambda: Simulation(SEARCH, brains={"rover": Brain}).step(),
        r"brains.rover\(\)": lambda: Simulation(
            SEARCH, brains={"rover": Batch(lambda *_: command)}
        ).step(),
        "commands.rover/0": lambda: Simulation(SEARCH).step(commands={"rover/0": command}),
        "percept.time_s": lambda: ae.Brain(None, BODY).step({"time_s": given}),
        "body.max_speed_m_s": lambda: ae.Brain(None, BODY | {"max_speed_m_s": given}),
        "settings.auction_s": lambda: ae.Controller({"auction_s": given}),
        "costs": lambda: assignment([[given]]),
        "replace: clock.time_limit_s": lambda: SEARCH.replace("clock.time_limit_s", given),
        "vary: clock.time_limit_s": lambda: study.run(SEARCH, vary={"clock.time_limit_s": [given]}),
        "seed": lambda: Simulation(SEARCH, seed=given),
        "steps": lambda: Simulation(SEARCH).step(given),
        "runs": lambda: ae.replicate(SEARCH, given),
    }
    for name, call in calls.items():
        with pytest.raises(InputError, match=f"^{name}.* = .*{words}"):
            call()


def test_a_number_of_a_batch_is_for_all_robots_or_for_one() -> None:
    places = {"row": [0, 1, 2], "kind": 0}
    wrong: list[Any] = [
        {"motion": {"speed_m_s": [0.5], "turn_rate_rad_s": 0.0}},
        {"motion": {"speed_m_s": np.full((4, 1), 0.5)}},
        {"acts": places | {"at": 3.0}},
        {"acts": places | {"at": np.ones((3, 1))}},
        {"acts": places | {"at": np.ones((2, 3))}},
    ]
    for commands in wrong:
        simulation = Simulation(SEARCH, brains={"rover": Batch(lambda *_, it=commands: it)})
        with pytest.raises(InputError, match="must be one (value|place) for all, or an array of"):
            simulation.step()


def test_numbers_of_numpy_are_written_as_plain_ones() -> None:
    time_limit_s: Any = np.int64(30)
    seed: Any = np.uint8(3)
    scenario = ae.Scenario.load("search").replace("clock.time_limit_s", time_limit_s)
    assert scenario.source.overrides[0].value == 30
    assert type(scenario.source.overrides[0].value) is int
    plan = study.make_plan(scenario.replace("study.vary.robots.rover.count", "1,2"), delta=1.0)
    assert "value = 30\n" in plan.text()
    assert type(Simulation("search", seed=seed).seed) is int


def test_a_brain_that_modifies_its_body_changes_no_other() -> None:
    bodies: list[float] = []

    class Greedy:
        def __init__(self, body: Any) -> None:
            """Modify the body."""
            bodies.append(body["max_speed_m_s"])
            body["max_speed_m_s"] *= 2

        def step(self, percept: object) -> Any:
            """Return no command."""
            del percept
            return {}

    Simulation("search", brains={"rover": Greedy})
    assert len(bodies) == 4
    assert len(set(bodies)) == 1
