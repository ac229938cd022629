"""The campaign of `make safety` is complete, and a row fails if it has to."""

import pytest
from campaign_process_table import PROCESSES, REQUESTS
from campaign_results import Key, Machine, Row, Trial
from campaign_table import ROWS, Kind, State
from campaign_units import QUICK, all_units
from flooding_robot import FLOODS

from agent_economy.live.clock import now_s
from agent_economy.live.emulator.faults import FAULTS
from agent_economy.live.rules.faults import FAULTS as RULES

KEY = Key("stall", "sonar", 1, State.STRAIGHT)


def test_every_port_is_broken_in_every_way_of_the_emulator_in_every_state() -> None:
    possible = {(port, name) for name, fault in FAULTS.items() for port in fault.defaults}
    assert {(row.port, row.fault) for row in ROWS} - possible == {
        (port, "unplug") for port in ("motors", "compass", "gps", "sonar")
    }
    units = list(all_units(lambda *_: True, is_quick=False))
    tried = {(row.key.port, row.key.fault, row.key.state) for each in units for row in each.rows}
    assert possible <= {(row.port, row.fault) for row in ROWS}
    assert tried >= {(row.port, row.name, state) for row in ROWS for state in State}


def test_rows_name_faults_that_exist_and_the_quick_ones_are_rows() -> None:
    names = {each.name for each in RULES}
    found = {name for row in ROWS for each in row.findings.values() for name in each.names}
    assert found | {name for row in (*PROCESSES, *REQUESTS) for name in row.names} <= names
    rows = {f"{row.port} {row.name}" for row in ROWS}
    assert rows | {row.name for row in (*PROCESSES, *REQUESTS)} | {
        f"flood: {name}" for name in FLOODS
    } >= set(QUICK)


def test_the_rules_state_what_a_fault_does_in_manual_mode() -> None:
    kinds = {row.port: row.kind(State.MANUAL) for row in ROWS if row.fault == "close"}
    assert set(kinds.values()) == {Kind.STOP}
    stale = next(row for row in ROWS if (row.port, row.fault) == ("sonar", "stall"))
    assert stale.kind(State.MANUAL) is Kind.SLOW
    assert stale.kind(State.HELD) is Kind.REPORT


@pytest.mark.parametrize(
    ("delay_s", "problems", "verdict"),
    [
        (0.09, (), "ok"),
        (0.9, (), "too late"),
        (0.05, ("motion lines after the stop",), "wrong"),
        (None, ("no stop",), "wrong"),
    ],
)
def test_a_row_fails_by_a_delay_beyond_its_limit_or_by_a_problem(
    delay_s: float | None, problems: tuple[str, ...], verdict: str
) -> None:
    machine, row = Machine(), Row(KEY, "stop: stale_input", 0.1)
    # In the past, for which the timer has no lateness.
    begin_s = now_s() - 10.0
    row.add(Trial(begin_s, delay_s, problems, begin_s + 1.0), machine)
    assert row.verdict == verdict


def test_a_trial_that_the_machine_was_late_for_is_left_out_and_a_row_without_any_fails() -> None:
    machine, row = Machine(), Row(KEY, "stop: stale_input", 0.1)
    begin_s = now_s() - 10.0
    row.add(Trial(begin_s, 0.9, (), begin_s + 1.0, behind_s=0.2), machine)
    assert (row.count, row.left_out, row.verdict) == (0, 1, "no result")
