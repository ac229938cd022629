"""The answer of a study as the page takes it: sections, tables and charts of the report."""

import hashlib
import re
import threading
from collections import OrderedDict
from collections.abc import Sequence
from pathlib import Path

from agent_economy import study
from agent_economy.study import AnyAnswer, report
from agent_economy.study.answer.any_answer import AnyResult
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.report import Section, Table
from agent_economy.study.store.folder import ANSWER, read_bytes
from agent_economy.types import page

CACHE_SIZE = 8
"""AnswerCache that are kept ready."""


class AnswerCache:
    """AnswerCache of finished studies; each is made once for what its folder holds."""

    def __init__(self) -> None:
        """Begin empty."""
        self._kept: OrderedDict[tuple[Path, str], page.StudyAnswer] = OrderedDict()
        # One at a time: pages share the work, and only one study's runs are in memory.
        self._lock = threading.Lock()

    def of(self, folder: Path) -> page.StudyAnswer | None:
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


def detail(answer: AnyAnswer, evidence: Evidence) -> page.StudyAnswer:
    """Return an answer with the sections and charts of the report."""
    results: Sequence[AnyResult] = answer.results
    shown = report.parts(answer, evidence)
    return {
        "verdict": answer.verdict,
        "sentence": answer.sentence,
        "guarantee": answer.guarantee,
        "facts": shown.facts,
        "quarantined": shown.quarantined,
        "sections": [section(each) for each in shown.sections],
        "charts": shown.charts,
        "results": [result(*each) for each in enumerate(results)],
    }


def section(given: Section) -> page.StudySection:
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


def table(given: Table) -> page.StudyTable:
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


def result(index: int, given: AnyResult) -> page.StudyResult:
    """Return the result of a configuration."""
    return {
        "configuration": index,
        "label": given.label,
        "runs": given.runs,
        "verdict": given.verdict,
        "eliminated": given.is_eliminated,
        "met": (given.met.value, given.met.low, given.met.high) if given.met else None,
    }
