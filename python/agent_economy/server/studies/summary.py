"""The summary of a study, from few files of its folder and without computation."""

import json
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from agent_economy import study
from agent_economy._core import InputError
from agent_economy.scenario.validation import is_whole
from agent_economy.server.messages import escaped
from agent_economy.study import Plan
from agent_economy.study.answer.verdict import fails_often
from agent_economy.study.description import Description
from agent_economy.study.store.folder import ANSWER, LEDGER, QUESTION, STAGING, read_bytes
from agent_economy.types import page


@dataclass(frozen=True)
class Summary:
    """The summary of a study.

    Attributes:
        state: "answered", "stopped" or "damaged".
        name: The name of its scenario.
        engine: The simulator that runs it; None if the study is damaged.
        question: What it compares; None if the study is damaged.
        runs: The number of runs so far.
        sentence: The answer in one sentence.
        is_recommended: Whether the answer recommends a configuration without reservation: it is
            certified, or does not fail often. None without an answer.
        message: What is wrong.
        changed_s: The time of the last change, in seconds since 1970.
    """

    state: page.StudyState
    name: str
    engine: page.Engine | None
    question: Description | None
    runs: int
    sentence: str | None
    is_recommended: bool | None
    message: str | None
    changed_s: float

    def listed(self, name: str) -> page.StudySummary:
        """Return the row of the study in the list; `name` is its id."""
        question = self.question
        return {
            "id": name,
            "name": self.name,
            "engine": self.engine,
            "state": self.state,
            "words": str(question or ""),
            "configurations": question.configurations if question else 0,
            "runs": self.runs,
            "confidence": question.confidence if question else 0,
            "delta": question.delta if question else None,
            "sentence": self.sentence,
            "is_recommended": self.is_recommended,
            "message": self.message,
            "changed_s": self.changed_s,
        }


class Summaries:
    """Cached summaries of folders; each is read again when its files have changed."""

    def __init__(self) -> None:
        """Begin empty."""
        self._kept: dict[Path, tuple[object, Summary]] = {}

    def of(self, folder: Path) -> Summary:
        """Return the summary of a study's folder."""
        now = stamp(folder)
        kept = self._kept.get(folder)
        if kept is None or kept[0] != now:
            kept = self._kept[folder] = (now, summary(folder, max(at_s for at_s, _ in now)))
        return kept[1]


def stamp(folder: Path) -> list[tuple[float, int]]:
    """Return the modification times and sizes of the files of a study."""
    found = []
    for name in (QUESTION, ANSWER, LEDGER, f"{LEDGER}-wal", STAGING):
        try:
            about = (folder / name).stat()
        except OSError:
            found.append((0.0, 0))
        else:
            # Readers of a ledger may leave an empty file next to it.
            found.append((about.st_mtime if about.st_size else 0.0, about.st_size))
    return found


def summary(folder: Path, changed_s: float) -> Summary:
    """Return the summary of a study's folder."""
    try:
        answer = read_answer(folder)
        if answer is not None:
            return answered(folder, answer, changed_s)
        return of_plan(study.load_plan(folder), runs_so_far(folder), changed_s)
    except InputError as error:
        message = escaped(str(error))
        return Summary("damaged", folder.name, None, None, 0, None, None, message, changed_s)


def of_plan(plan: Plan, runs: int, changed_s: float) -> Summary:
    """Return the summary of a study that has no answer yet."""
    scenario = plan.scenario
    question = Description.of(plan)
    name, engine = scenario.name, cast("page.Engine", scenario.engine)
    return Summary("stopped", name, engine, question, runs, None, None, None, changed_s)


def answered(folder: Path, answer: Mapping[str, Any], changed_s: float) -> Summary:
    """Return the summary of a study that has an answer.

    Raises:
        InputError: If its study.toml is damaged.
    """
    scenario = answer["scenario"]
    try:
        stored = tomllib.loads(study.open(folder).question)
        question = Description.stored(
            scenario["design"],
            len(answer["results"]),
            stored["question"],
            stored["data"].get("runs"),
        )
        name, engine = str(scenario["name"]), scenario["engine"]
        runs, sentence = int(answer["runs"]), str(answer["sentence"])
        good = is_recommended(answer)
        found = Summary("answered", name, engine, question, runs, sentence, good, None, changed_s)
        json.dumps(found.listed(""), ensure_ascii=False, allow_nan=False).encode()
    except tomllib.TOMLDecodeError as error:
        message = f"{folder / QUESTION}: is not a study: {error}"
        raise InputError(message) from None
    except (LookupError, TypeError, AttributeError, ValueError, ArithmeticError, RecursionError):
        message = f"{folder}: {QUESTION} or {ANSWER} is damaged: restore it, or use another folder"
        raise InputError(message) from None
    return found


def is_recommended(answer: Mapping[str, Any]) -> bool:
    """Return whether an answer recommends a configuration without reservation."""
    if "requirement" in answer:
        return answer["selected"] is not None
    return not fails_often(float(answer["results"][answer["best"]]["failed"]["value"]))


def read_answer(folder: Path) -> dict[str, Any] | None:
    """Return the answer in a study's folder; None if there is none.

    Raises:
        InputError: If the file is damaged.
    """
    file = folder / ANSWER
    data = read_bytes(file)
    if data is None:
        return None
    try:
        answer: dict[str, Any] = json.loads(data)
        is_answer = answer.keys() >= {"scenario", "results", "runs", "sentence"}
    except (ValueError, AttributeError, RecursionError):
        is_answer = False
    if is_answer:
        return answer
    message = f"{file}: is damaged: remove it, and resume the study"
    raise InputError(message)


def runs_so_far(folder: Path) -> int:
    """Return the number of stored runs of a study.

    Raises:
        InputError: If its ledger is damaged.
    """
    store = study.open(folder)
    decisions = store.decisions()
    # The page shows facts of the last round.
    if decisions and not (
        isinstance(facts := decisions[-1].facts, dict) and is_whole(facts.get("runs"), 0)
    ):
        message = f"{folder / LEDGER}: is damaged: restore it, or use another folder"
        raise InputError(message)
    return store.count()
