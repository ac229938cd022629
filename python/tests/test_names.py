"""Names of folders and files are names, whatever they look like: addresses, patterns, options."""

import os
import shutil
import tempfile
from contextlib import chdir
from pathlib import Path

import pytest
from command_line import refuse, succeed
from hypothesis import example, given, settings
from hypothesis import strategies as st
from small_study import run_plan
from starlette.testclient import TestClient
from synthetic_runs import COLUMNS, outcomes, same

import agent_economy as ae
from agent_economy import study
from agent_economy.study.run_block import RunBlock
from agent_economy.study.store import Store, read

SPECIAL = [*"*?[]{}~%#&=:;+!'\"`$\\|<>() \n\t-.aü", "file:", "http:", "s3:", "C:", "%2F"]

LONGEST = 255
"""The longest name of a file, in bytes."""


def is_name(text: str) -> bool:
    """Return whether a file can have this name."""
    return text not in {"", ".", ".."} and len(os.fsencode(text)) <= LONGEST


NAMES = st.lists(st.sampled_from(SPECIAL), min_size=1, max_size=8).map("".join).filter(is_name)


@settings(max_examples=10, deadline=None)
@given(name=NAMES)
@example("file:t")
@example("file:t?mode=memory")
@example("g*")
@example("*\\")
@example("~")
@example("-")
def test_a_study_is_in_the_folder_of_its_name_and_read_from_there(name: str) -> None:
    block = RunBlock((0, 2), 5, 4)
    with tempfile.TemporaryDirectory() as place, chdir(place):
        Path("[}").mkdir()
        with Store.open(Path(name), "question", COLUMNS) as store:
            store.block(block, outcomes)
        assert set(os.listdir()) == {name, "[}"}  # noqa: PTH208
        assert {"ledger.sqlite", "blocks"} <= set(os.listdir(name))  # noqa: PTH208
        for folder in (name, Path(place) / name):
            assert read(folder).runs().count("*").fetchall() == [(8,)]
            assert same(read(folder).stored().block(block, lambda _: {}), outcomes(block))


@pytest.mark.parametrize("name", ["file:t", "g[1]", "-x", "a\nb%41#"])
def test_the_command_takes_names_literally(name: str, tmp_path: Path) -> None:
    (tmp_path / "t").mkdir()
    (tmp_path / "g1").mkdir()
    options = ("--only-vary", "--vary", "robots.wanderer.count=1,2", "--runs", "2")
    given = succeed("study", "classic", *options, f"--out={name}", cwd=tmp_path)
    assert (tmp_path / name / "answer.json").is_file()
    assert (tmp_path / name / "ledger.sqlite").is_file()
    assert "".join(f"{name}/report.html".split()) in "".join(given.stdout.split())
    for command in ("report", "watch"):
        succeed(command, "--", name, cwd=tmp_path)
    succeed("study", f"--resume={name}", cwd=tmp_path)
    succeed("run", "classic", f"--record={name}.mcap", cwd=tmp_path)
    succeed("replay", "--", f"{name}.mcap", cwd=tmp_path)
    succeed("replicate", "classic", "--runs", "2", f"--out={name}.parquet", cwd=tmp_path)
    files = {name, f"{name}.mcap", f"{name}.parquet", "t", "g1"}
    assert {path.name for path in tmp_path.iterdir()} == files
    assert list((tmp_path / "t").iterdir()) == list((tmp_path / "g1").iterdir()) == []
    assert "contains no study" in refuse("report", "t", cwd=tmp_path)


def test_the_page_opens_studies_of_any_name(client: TestClient, tmp_path: Path) -> None:
    names = ["file:t", "g[1]", "a b", "-x", "%41", "#?", "~x", "it's", 'a\nb"&']
    with chdir(tmp_path):
        run_plan(Path(names[0]))
        assert study.load_answer(names[0])[0].runs == study.open(names[0]).count()
    for name in names[1:]:
        shutil.copytree(tmp_path / names[0], tmp_path / name)
    assert {row["id"] for row in client.get("/api/studies").json()["studies"]} == set(names)
    for name in names:
        for address in ("/api/study", "/api/study/report", "/api/study/answer"):
            assert client.get(address, params={"id": name}).status_code == 200
        rows = client.get("/api/study/runs", params={"id": name, "configuration": 0}).json()
        assert len(rows["runs"]) > 5


def test_a_scenario_file_of_any_name_is_read(tmp_path: Path) -> None:
    text = ae.Scenario.load("classic").source.text
    with chdir(tmp_path):
        for name in ("file:t.toml", "g*.toml", "~x.toml", "-.toml", "a\nb.toml", "#%41.toml"):
            Path(name).write_text(text)
            assert ae.Scenario.load(name).source.file == name
