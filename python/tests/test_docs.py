"""Documents agree with the program."""

import math
import re
import shlex
import subprocess
import sys
import tomllib
from dataclasses import replace
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from agent_economy import Scenario, study

ROOT = Path(__file__).resolve().parents[2]


def test_every_table_of_the_replication_page_is_reproduced() -> None:
    command = [sys.executable, str(ROOT / "scripts/replication.py"), "--check"]
    given = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert given.returncode == 0, given.stderr


def test_the_validation_page_and_its_charts_follow_from_the_measurements() -> None:
    command = [sys.executable, str(ROOT / "scripts/validation.py"), "--check"]
    given = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert given.returncode == 0, given.stderr


def test_the_brain_comparison_page_and_its_charts_follow_from_the_measurements() -> None:
    command = [sys.executable, str(ROOT / "scripts/brain_comparison.py"), "--check"]
    given = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert given.returncode == 0, given.stderr


def test_a_sentence_about_brains_that_the_measurements_do_not_support_is_an_error(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.syspath_prepend(str(ROOT / "scripts"))
    claims, comparison = map(import_module, ("brain_claims", "brain_comparison"))
    measured = comparison.measurements()
    assert "`bayesian_search` is the fastest brain" in claims.in_short(measured)
    lawnmower = {
        claims.BAYES: measured.teams["lawnmower"],
        "lawnmower": measured.teams[claims.BAYES],
    }
    swapped = replace(measured, teams={**measured.teams, **lawnmower})
    with pytest.raises(claims.ClaimError, match="no longer show that bayesian_search with radio"):
        claims.in_short(swapped)


def test_the_readme_quotes_the_verdict_and_the_guarantee_of_make_study() -> None:
    answer = study.run(Scenario.load(ROOT / "scenarios/classic.toml"))
    page = (ROOT / "README.md").read_text().replace("\\\n", "\n").replace("**", "")
    quoted = " ".join(page.replace("\n> ", " ").split())
    for line in (*answer.verdict[:3], answer.guarantee):
        assert line in quoted


def test_the_readme_and_the_requirements_page_quote_the_verdict_of_the_warehouse() -> None:
    first, *others = study.run("warehouse").verdict
    quote = "\\\n> ".join([f"> **{first}**", *others])
    assert quote in (ROOT / "README.md").read_text()
    assert quote in (ROOT / "docs/requirements.md").read_text()


def test_the_requirements_page_shows_the_requirement_of_the_warehouse() -> None:
    page = (ROOT / "docs/requirements.md").read_text()
    shown = tomllib.loads(page.split("```toml\n")[1].split("```")[0])
    bundled = tomllib.loads((ROOT / "scenarios/warehouse.toml").read_text())
    assert shown == {key: bundled[key] for key in ("end", "require", "study")}


def test_the_floors_of_the_mines_page_follow_from_the_formula() -> None:
    page = (ROOT / "docs/mines.md").read_text()
    rows = re.findall(r"^\| (\d+) \| (0\.\d+)[^|]* \| ([\d.]+)% \|$", page, re.MULTILINE)
    assert len(rows) == 4
    for mines, blind, floor in rows:
        digits = len(floor.partition(".")[2])
        assert floor == f"{100 * (1 - math.exp(-float(mines) * float(blind))):.{digits}f}"


def run_blocks(page: str) -> None:
    """Run the code blocks of a page in order: Python, or commands."""
    blocks = re.findall(r"^```(python)?\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    names: dict[str, Any] = {}
    for language, text in blocks:
        if language:
            exec(text, names)  # noqa: S102  (ours)
            continue
        for line in text.splitlines():
            command = [sys.executable, "-m", *shlex.split(line.replace("-", "_", 1), comments=True)]
            given = subprocess.run(command, capture_output=True, text=True, check=False)
            assert given.returncode == 0, given.stderr


@pytest.mark.parametrize(("name", "prints"), [("simulation", 3), ("brains", 4)])
def test_the_examples_of_a_page_run_and_print_the_stated_output(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    name: str,
    prints: int,
) -> None:
    monkeypatch.chdir(tmp_path)
    page = (ROOT / f"docs/{name}.md").read_text()
    run_blocks(page)
    assert (tmp_path / "runs.parquet").exists() == ("runs.parquet" in page)
    printed = capsys.readouterr().out.splitlines()
    promised = re.findall(r"^print\(.*?\)\s+# (.*)", page, re.MULTILINE)
    for line, words in zip(printed, promised, strict=False):
        assert line == words or words.startswith("share of"), (line, words)
    assert len(printed) >= len(promised) == prints
