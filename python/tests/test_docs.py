"""Documents say what the program does."""

import subprocess
import sys
from pathlib import Path

from agent_economy import Scenario, study

ROOT = Path(__file__).resolve().parents[2]


def test_every_table_of_the_replication_page_is_what_the_program_gives() -> None:
    command = [sys.executable, str(ROOT / "scripts/replication.py"), "--check"]
    given = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert given.returncode == 0, given.stderr


def test_the_validation_page_and_its_pictures_are_drawn_from_what_was_measured() -> None:
    command = [sys.executable, str(ROOT / "scripts/validation.py"), "--check"]
    given = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert given.returncode == 0, given.stderr


def test_the_readme_quotes_the_answer_that_make_study_gives() -> None:
    answer = study.run(Scenario.load(ROOT / "scenarios/classic.toml"))
    quoted = " ".join((ROOT / "README.md").read_text().replace("\n> ", " ").split())
    assert answer.sentence in quoted
