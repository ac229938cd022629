"""`make ui`: one command from a clone to the page."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

MAKE = shutil.which("make") or ""
pytestmark = pytest.mark.skipif(not MAKE, reason="make is missing")


def make(*arguments: str, cwd: Path = ROOT, path: str | None = None) -> tuple[int, str]:
    """Run make, and return its exit code and what it prints."""
    environment = os.environ | ({"PATH": path} if path else {})
    given = subprocess.run(
        [MAKE, *arguments],
        cwd=cwd,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
    )
    return given.returncode, given.stdout + given.stderr


def test_the_page_and_the_extension_are_built_before_the_page_is_opened() -> None:
    _, printed = make("--dry-run", "--always-make", "ui")
    steps = ["packaging/backend.py", "pip install", "touch .venv/installed", "agent-economy ui"]
    places = [printed.index(step) for step in steps]
    assert places == sorted(places)


def test_the_list_of_targets_contains_ui() -> None:
    assert any(line.split()[:2] == ["ui", "Build"] for line in make("help")[1].splitlines())


def test_without_node_ui_names_it_and_installs_nothing(tmp_path: Path) -> None:
    shutil.copy(ROOT / "Makefile", tmp_path)
    shutil.copytree(ROOT / "packaging", tmp_path / "packaging")
    (tmp_path / "web").mkdir()
    (tmp_path / "web" / "package-lock.json").touch()
    (tmp_path / "empty").mkdir()
    code, printed = make(
        "ui", f"PYTHON={sys.executable}", cwd=tmp_path, path=str(tmp_path / "empty")
    )
    assert code == 2
    assert "the page needs npm of Node 20 or newer: install Node" in printed
    assert not (tmp_path / ".venv").exists()
