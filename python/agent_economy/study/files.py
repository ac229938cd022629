"""The output files of a study: answer.json and report.html."""

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Any

from agent_economy.study import report
from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.errors import StudyError
from agent_economy.study.store.folder import ANSWER, REPORT, read_bytes, write_whole
from agent_economy.study.versions import versions


def write(folder: Path, answer: AnyAnswer, evidence: Evidence, script: report.ChartScript) -> None:
    """Write a study's report and answer atomically, the answer last.

    Raises:
        InputError: If they cannot be written.
    """
    try:
        javascript = script.text()
    except StudyError:
        # Bundling needs gigabytes of address space: a report without charts is better than none.
        javascript = ""
    page = report.html(answer, evidence, javascript)
    write_whole(folder / REPORT, page.encode())
    write_whole(folder / ANSWER, as_json(answer).encode())


def are_current(folder: Path, answer: AnyAnswer) -> bool:
    """Return whether a folder contains this answer, and a report with it."""
    existing = read_bytes(folder / ANSWER)
    return existing == as_json(answer).encode() and (folder / REPORT).is_file()


def as_json(answer: AnyAnswer) -> str:
    """Return an answer as JSON, without times, paths, hosts and numbers of threads."""
    return json.dumps(as_dict(answer), indent=2, allow_nan=False) + "\n"


def with_names_of_infinity(items: list[tuple[str, Any]]) -> dict[str, Any]:
    """Return a dict in which infinity, which JSON lacks, is the string "inf": it means never."""
    return {name: "inf" if is_infinite(value) else value for name, value in items}


def is_infinite(value: Any) -> bool:
    """Return whether a value is the number infinity."""
    return isinstance(value, float) and value == math.inf


def as_dict(answer: AnyAnswer) -> dict[str, Any]:
    """Return an answer as JSON values; without what it has none of.

    `omissions`, other `questions`, `runs_to_decide`, `agents`, and each `goal_time` and `clearance`
    are in it only if there are any.
    """
    values = asdict(answer, dict_factory=with_names_of_infinity)
    scenario = values.pop("scenario")
    del scenario["source"]
    for name in ("omissions", "agents"):
        if not values.get(name, True):
            del values[name]
    if values.get("runs_to_decide", 0) is None:
        del values["runs_to_decide"]
    if len(answer.questions) <= 1:
        del values["questions"]
    for result in values["results"]:
        for name in ("goal_time", "clearance"):
            if result[name] is None:
                del result[name]
    results = [
        {"configuration": index, **result} for index, result in enumerate(values.pop("results"))
    ]
    return {
        **values,
        "runs": answer.runs,
        "results": results,
        "scenario": scenario,
        "versions": versions(),
    }
