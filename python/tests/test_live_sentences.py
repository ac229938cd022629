"""Events of a drive in words."""

import pytest

from agent_economy.live.warden.sentences import named


@pytest.mark.parametrize(
    ("name", "reason", "expected"),
    [
        ("emergency stop", "emergency stop: not released", "emergency stop (not released)"),
        ("emergency stop", "emergency stop", "emergency stop"),
        ("not armed", "not armed since the start", "not armed (since the start)"),
        ("jump", "jumped by 3 m", "jump (jumped by 3 m)"),
        ("held", "all robots are held: not resumed", "held (all robots are held: not resumed)"),
    ],
)
def test_a_fault_whose_reason_begins_with_its_name_is_named_once(
    name: str, reason: str, expected: str
) -> None:
    assert named(name, reason) == expected
