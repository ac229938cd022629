"""Many runs of a scenario."""

import pyarrow as pa
import pytest
from alarm import ringing
from metric import ENDLESS, FULL, HUGE, search

import agent_economy as ae
from agent_economy import InputError, Scenario

HEAD = {"run": pa.int64(), "time_s": pa.float64(), "complete": pa.bool_()}


def types(table: pa.Table) -> dict[str, pa.DataType]:
    """Return the columns of a table."""
    return {field.name: field.type for field in table.schema}


def bytes_of(table: pa.Table) -> bytes:
    """Return a table as bytes."""
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, table.schema) as stream:
        stream.write_table(table)
    return bytes(sink.getvalue())


def test_a_table_has_one_row_per_run_and_fitting_types() -> None:
    whole, real = pa.int64(), pa.float64()
    table = ae.replicate("open-field", 3, seed=4, first_run=7)
    expected = HEAD | {
        "robots": whole,
        "price": real,
        "found": whole,
        "missed": whole,
        "false_alarms": whole,
        "collisions": whole,
        "energy_j": real,
        "distance_m": real,
        "robots_stopped": whole,
        **{
            f"{what}_{kind}": whole
            for kind in ("flag", "mine", "scrap")
            for what in ("found", "missed")
        },
        **{
            f"found_{kind}_{number}_s": real
            for kind, count in (("flag", 2), ("mine", 6), ("scrap", 10))
            for number in range(1, count + 1)
        },
        "merit": real,
    }
    assert types(table) == expected
    assert list(types(table))[:3] == list(HEAD)
    assert table["run"].to_pylist() == [7, 8, 9]


def test_the_classic_engine_has_its_own_columns() -> None:
    table = ae.replicate("classic", 20, seed=4)
    assert list(types(table)) == [*HEAD, "robots", "found", "collisions", "paints", "merit"]
    stepped = [ae.ClassicSimulation("classic", 4, run).finish().row for run in range(20)]
    assert table["paints"].to_pylist() == [row["paints"] for row in stepped]


@pytest.mark.parametrize("runs", [1, 3, 40])
def test_threads_change_no_byte(runs: int) -> None:
    tables = [ae.replicate("search", runs, 3, threads) for threads in (1, 2, 8, None)]
    assert len({bytes_of(table) for table in tables}) == 1


def test_threads_that_share_a_step_change_no_byte() -> None:
    huge = search(HUGE)
    assert len({bytes_of(ae.replicate(huge, 1, 3, threads)) for threads in (1, 2, 8)}) == 1


def test_a_run_does_not_depend_on_other_runs() -> None:
    whole = ae.replicate("search", 40, seed=8)
    assert ae.replicate("search", 7, seed=8, first_run=20).equals(whole.slice(20, 7))


def test_a_table_without_runs_has_the_same_columns() -> None:
    none = ae.replicate("search", 0)
    assert none.num_rows == 0
    assert types(none) == types(ae.replicate("search", 1))


def test_quarantined_runs_are_null() -> None:
    table = ae.replicate(Scenario.loads(FULL), 5)
    assert table["run"].to_pylist() == [0, 1, 2, 3, 4]
    assert {column.null_count for column in table.columns[1:]} == {5}


def test_merit_is_that_of_the_scenario() -> None:
    slow = search({"merit": {"time": -1.0, "collisions": -2.0}})
    table = ae.replicate(slow, 10)
    rows = table.to_pylist()
    expected = [-row["time_s"] - 2 * row["collisions"] for row in rows]
    assert [row["merit"] for row in rows] == expected


def test_all_invalid_arguments_are_reported() -> None:
    with pytest.raises(InputError) as caught:
        ae.replicate("search", -1, seed=2**64, threads=0, first_run=2**63)
    lines = str(caught.value).splitlines()
    assert [line.partition(" = ")[0] for line in lines] == ["seed", "runs", "first_run", "threads"]


def test_a_signal_stops_long_runs() -> None:
    endless = search(ENDLESS)
    with ringing(0.5):
        ae.replicate(endless, 100)
