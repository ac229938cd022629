"""The names that a shell completes."""

import pytest
from command_line import run_python

import agent_economy as ae
from agent_economy import study

LISTED = """
import sys, agent_economy
assert dir(agent_economy) == sorted(agent_economy.__all__), dir(agent_economy)
assert not {"numpy", "agent_economy._core"} & sys.modules.keys(), "dir loads modules"
"""


def test_names_are_listed_before_they_are_loaded() -> None:
    given = run_python(LISTED)
    assert given.returncode == 0, given.stderr


@pytest.mark.parametrize("module", [ae, study])
def test_each_listed_name_is_public_and_exists(module: object) -> None:
    assert dir(module) == sorted(module.__all__)  # type: ignore[attr-defined]
    assert all(hasattr(module, name) for name in dir(module))
