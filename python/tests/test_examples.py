"""Examples print the output that is stored beside them."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
SCRIPTS = sorted(EXAMPLES.glob("*.py"))


@pytest.mark.parametrize("script", SCRIPTS, ids=lambda script: script.name)
def test_an_example_prints_its_expected_output(script: Path, tmp_path: Path) -> None:
    command = [sys.executable, str(script)]
    given = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, check=False, timeout=100
    )
    assert given.returncode == 0, given.stderr
    expected = script.with_suffix(".out")
    if os.environ.get("RENEW_EXAMPLES"):
        expected.write_text(given.stdout, encoding="utf-8")
    assert given.stdout == expected.read_text(encoding="utf-8"), (
        "if that is intended: make examples"
    )


def test_the_index_names_every_example_with_its_output() -> None:
    index = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    assert all(f"[{script.name}]({script.name})" in index for script in SCRIPTS)
    assert {out.stem for out in EXAMPLES.glob("*.out")} == {script.stem for script in SCRIPTS}
