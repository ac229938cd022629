"""The answer of a study as the page takes it: sections, tables and charts of the report."""

import hashlib
import math
import re
import threading
from collections import OrderedDict
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from agent_economy import study
from agent_economy.study import AnyAnswer, RequirementResult, Result, report
from agent_economy.study.answer.evidence import Evidence, Interval
from agent_economy.study.report import Section, Table
from agent_economy.study.store.folder import ANSWER, read_bytes

CACHE_SIZE = 8
"""AnswerCache that are kept ready."""

Detail = dict[str, Any]


class AnswerCache:
    """AnswerCache of finished studies; each is made once for what its folder holds."""

    def __init__(self) -> None:
        """Begin empty."""
        self._kept: OrderedDict[tuple[Path, str], Detail] = OrderedDict()
        # One at a time: pages share the work, and only one study's runs are in memory.
        self._lock = threading.Lock()

    def of(self, folder: Path) -> Detail | None:
        """Return a study's answer; None if it has none.

        Raises:
            InputError: If the study is damaged.
        """
        data = read_bytes(folder / ANSWER)
        if data is None:
            return None
        key = folder, hashlib.sha256(data).hexdigest()
        with self._lock:
            if key not in self._kept:
                self._kept[key] = detail(*study.load_answer(folder))
            self._kept.move_to_end(key)
            while len(self._kept) > CACHE_SIZE:
                self._kept.popitem(last=False)
            return self._kept[key]


def detail(answer: AnyAnswer, evidence: Evidence) -> Detail:
    """Return an answer with the sections and charts of the report."""
    results: Sequence[Result | RequirementResult] = answer.results
    shown = report.parts(answer, evidence)
    return {
        "verdict": list(answer.verdict),
        "sentence": answer.sentence,
        "guarantee": answer.guarantee,
        "facts": list(shown.facts),
        "quarantined": shown.quarantined,
        "sections": [section(each) for each in shown.sections],
        "charts": shown.charts,
        "results": [result(*each) for each in enumerate(results)],
    }


def section(given: Section) -> Detail:
    """Return a section of the report."""
    return {
        "id": re.sub(r"[^a-z0-9]+", "-", given.heading.lower()).strip("-"),
        "title": given.heading,
        "words": given.notes,
        "charts": [picture.name for picture in given.pictures],
        "captions": {picture.name: picture.shows for picture in given.pictures},
        "tables": [table(each) for each in given.tables],
        "folded": given.is_folded,
    }


def table(given: Table) -> Detail:
    """Return a table of the report; an interval follows its number."""
    return {
        "caption": given.caption,
        "head": given.heads,
        "rows": [
            [f"{cell.text} ({cell.range})" if cell.range else cell.text for cell in row.cells]
            for row in given.rows
        ],
        "configurations": [row.configuration for row in given.rows],
    }


def result(index: int, given: Result | RequirementResult) -> Detail:
    """Return the results of a configuration."""
    common = {
        "configuration": index,
        "label": given.label,
        "values": given.values,
        "runs": given.runs,
    }
    if isinstance(given, RequirementResult):
        verdict = "best" if given.status == "selected" else given.status
        return {**common, "met": given.met and numbers(given.met), "verdict": verdict}
    return {
        **common,
        "merit": numbers(given.merit),
        "time_s": numbers(given.time_s),
        "failed": numbers(given.failed),
        "verdict": given.standing.verdict,
        "eliminated": given.eliminated is not None,
    }


def numbers(interval: Interval) -> list[float | None]:
    """Return an interval with null for numbers that are not finite."""
    each = (interval.value, interval.low, interval.high)
    return [number if math.isfinite(number) else None for number in each]
