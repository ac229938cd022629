"""The runner of checks: order, failures and what a change needs."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "scripts"))

from checks import EVERYTHING, Stage, quick, run


def stage(name: str, code: str, *needs: str) -> Stage:
    """Return a stage that runs Python code."""
    return Stage(name, (sys.executable, "-c", code), needs)


def test_a_stage_waits_for_its_requirements_and_is_skipped_if_one_fails() -> None:
    stages = [
        stage("last", "print('last')", "first"),
        stage("first", "print('first')"),
        stage("broken", "raise SystemExit(3)"),
        stage("never", "print('never')", "broken"),
    ]
    results = {each.stage.name: each for each in run(stages)}
    assert {name: each.status for name, each in results.items()} == {
        "first": 0,
        "last": 0,
        "broken": 3,
    }
    assert list(results).index("first") < list(results).index("last")
    assert results["first"].output == "first\n"
    assert results["first"].cpu_s > 0


def test_interactive_stages_run_one_at_a_time() -> None:
    code = "import time; print(time.monotonic()); time.sleep(0.2); print(time.monotonic())"
    command = (sys.executable, "-c", code)
    stages = [Stage(name, command, is_interactive=True) for name in ("one", "other")]
    (_, end), (start, _) = (each.output.split() for each in run(stages))
    assert float(end) <= float(start)


def test_every_needed_stage_exists() -> None:
    names = {each.name for each in EVERYTHING}
    assert all(names.issuperset(each.needs) for each in EVERYTHING)


def test_a_change_in_one_crate_needs_that_crate_only() -> None:
    names = [each.name for each in quick(["crates/brain/src/lib.rs"])]
    assert names == ["tree", "prose", "brain format", "brain lint", "brain test"]


def test_a_changed_test_is_run() -> None:
    last = quick(["python/tests/test_checks.py"])[-1]
    assert last.command[-1] == "python/tests/test_checks.py"
