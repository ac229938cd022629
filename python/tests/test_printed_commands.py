"""Commands that messages print: pasted into a shell, they name the same file."""

import shlex
from pathlib import Path

import pytest
from command_line import refuse
from small_study import plan

import agent_economy as ae
from agent_economy.scenario.source import RECORDING_MAGIC
from agent_economy.study import run_plan
from agent_economy.study.engine import Engine
from agent_economy.study.run_block import Columns, RunBlock

NAME = "my study; rm $x 'y'"


def interrupted(_: RunBlock) -> Columns:
    """Stop a study before its first run."""
    raise KeyboardInterrupt


@pytest.fixture
def unfinished(tmp_path: Path) -> Path:
    """Return the folder of a study that was stopped before its first run."""
    with pytest.raises(KeyboardInterrupt):
        run_plan(plan(), tmp_path / NAME, compute=interrupted)
    return tmp_path / NAME


def words(message: str) -> list[str]:
    """Return the words that a shell makes of the command at the end of a message."""
    return shlex.split(message[message.index("agent-economy ") :])


@pytest.mark.parametrize("command", [["report"], ["watch"], ["study", "--resume"]])
def test_the_command_that_resumes_a_study_can_be_pasted(
    unfinished: Path, command: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(Engine, "__call__", lambda _, block: interrupted(block))
    code = {"report": 2, "watch": 1, "study": 130}[command[0]]
    printed = words(refuse(*command, unfinished, code=code))
    assert printed == ["agent-economy", "study", "--resume", str(unfinished)]


@pytest.mark.parametrize("name", [NAME, "-x", "a\nb", "~x", "g*", "%d", "#"])
def test_the_command_that_replays_a_recording_can_be_pasted(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    file = Path(f"{name}.toml")
    file.write_bytes(RECORDING_MAGIC)
    with pytest.raises(ae.InputError) as caught:
        ae.Scenario.load(file)
    program, command, printed = words(str(caught.value))
    assert (program, command) == ("agent-economy", "replay")
    assert not printed.startswith("-")
    assert Path(printed).samefile(file)
