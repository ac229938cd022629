"""The table of the safety rules: each fault stops in time, in both modes, and clears as stated."""

from itertools import pairwise
from pathlib import Path

from live_cases import ALL_CASES, BOTH, CASES, STOPPED_ELSEWHERE, Case, forks, stops
from live_story import LEAP_S, PERIODS_S

from agent_economy.live.readings import STOP
from agent_economy.live.rules import (
    FAULTS,
    Action,
    Clears,
    InManual,
    Mode,
    Requests,
    faults,
)

ROOT = Path(__file__).resolve().parents[2]


def test_every_fault_has_a_case() -> None:
    assert {case.fault for case in CASES} | STOPPED_ELSEWHERE == set(FAULTS)
    assert len({fault.name for fault in FAULTS}) == len(FAULTS)


@BOTH
@ALL_CASES
def test_a_fault_stops_or_warns_in_time_at_every_phase(case: Case, mode: Mode) -> None:
    for story in forks(mode):
        case.react(story)
        decision = story.now
        if case.fault is not faults.LONG_STOP:
            assert story.active() == (case.fault,), decision
            assert story.active()[0].reason, case.fault.name
        if stops(case.fault, mode):
            expected = Action.LATCHED_STOP if case.fault.latches else Action.STOP
            assert decision.action is expected, decision
            assert decision.motion == STOP
            assert decision.is_armed == (not case.fault.latches)
        else:
            assert decision.action is Action.MOVE, decision
            assert decision.warnings == (case.fault,)
            is_slow = case.fault.in_manual in (InManual.SLOW, InManual.SLOW_NOT_ARMED)
            speed_m_s = decision.motion.speed_m_s
            assert speed_m_s == (0.2 if is_slow else story.setpoint.speed_m_s)  # type: ignore[union-attr]


@BOTH
@ALL_CASES
def test_a_stop_clears_as_the_table_states(case: Case, mode: Mode) -> None:
    for story in forks(mode, 5):
        case.react(story)
        story.heal()
        if not stops(case.fault, mode):
            # Healing the values of an input is a jump.
            story.run(2.0 + 2 * PERIODS_S["gps"], LEAP_S)
            assert story.now.action is Action.MOVE
            assert story.now.motion.speed_m_s == 0.5
        elif case.fault.latches:
            story.run(6.0, LEAP_S)
            assert story.now.action is Action.LATCHED_STOP
            if case.fault.clears is Clears.RELEASE:
                assert faults.EMERGENCY_STOP in story.arm().blockers
                story.run(1.0, LEAP_S)
                assert story.step(Requests(release=True)).action is Action.LATCHED_STOP
                story.run(3.0, LEAP_S)
                assert story.now.action is Action.LATCHED_STOP
            assert story.now.blockers == ()
            assert story.arm().action is Action.MOVE
        else:
            story.run(2.0 + PERIODS_S["gps"], LEAP_S)
            assert story.now.action is Action.MOVE


def test_the_table_of_the_document_is_the_table_of_the_rules() -> None:
    text = (ROOT / "docs/safety.md").read_text(encoding="utf-8")
    rows = [line for line in text.splitlines() if line.startswith("| `") and line.count("|") == 8]
    found = [tuple(cell.strip() for cell in row.strip("|").split("|")) for row in rows]
    expected = [
        (
            f"`{fault.name}`",
            fault.cause,
            fault.delay,
            "latched stop" if fault.latches else "stop",
            "yes" if fault.latches else "no",
            fault.clears.value,
            fault.in_manual.value,
        )
        for fault in FAULTS
    ]
    assert found == expected


def test_the_limits_that_the_table_states_are_those_of_the_rules() -> None:
    limits = {
        faults.MOVES_WHILE_STOPPED: (faults.NOISE_SIGMAS, faults.STILL_S),
        faults.LOST_LINK: (faults.MAX_UNACKNOWLEDGED_S,),
        faults.EVENT_LOOP_GAP: (faults.MAX_GAP_S,),
        faults.JUMP: (faults.JITTER_S, faults.NOISE_SIGMAS),
        faults.FROZEN: (faults.NOISE_SIGMAS,),
        faults.TURN_DOES_NOT_END: (faults.TURN_MARGIN_S, faults.TURN_GAP_S),
        faults.LOOP_SILENT: (faults.MAX_SILENCE_S,),
        faults.LONG_STOP: (faults.LONG_STOP_S,),
    }
    for fault, values in limits.items():
        for value in values:
            assert f" {value:g} " in fault.cause, (fault.name, value)
    assert f"{faults.SETTLING_S:g} s" in faults.MOVES_WHILE_STOPPED.delay
    assert f"{faults.FROZEN_S:g} s" in faults.FROZEN.delay


def test_gravity_decreases_from_stops_that_latch_to_those_that_do_not() -> None:
    causes = [fault for fault in FAULTS if fault not in STOPPED_ELSEWHERE | {faults.LONG_STOP}]
    assert all(first.latches >= second.latches for first, second in pairwise(causes))
