"""The report: one HTML file that works offline."""

import subprocess
import sys
from collections.abc import Iterator
from typing import Self

import jinja2

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.errors import StudyError
from agent_economy.study.report.assumptions import assumptions
from agent_economy.study.report.charts import specifications
from agent_economy.study.report.sections import sections
from agent_economy.study.report.view import View
from agent_economy.study.report.writing import brief, count
from agent_economy.study.selection import certainty

MOST_NAMED = 8
"""Configurations that a warning names."""


class ChartScript:
    """The JavaScript that draws charts, made in a process of its own while the runs go on.

    vl-convert takes a second or two to bundle it and holds the interpreter's lock meanwhile; here
    it costs no time and cannot delay Ctrl-C. Use as a context manager: leaving it ends the
    process.
    """

    def __init__(self) -> None:
        """Start to make it."""
        code = (
            "import sys, vl_convert; "
            "sys.stdout.buffer.write(vl_convert.javascript_bundle().encode('utf-8'))"
        )
        self._process = subprocess.Popen(
            [sys.executable, "-c", code],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            encoding="utf-8",
        )

    def __enter__(self) -> Self:
        """Return itself."""
        return self

    def __exit__(self, *_: object) -> None:
        """End the process if it still runs."""
        self._process.kill()
        self._process.communicate()

    def text(self) -> str:
        """Return the script, when it is made.

        Raises:
            StudyError: If vl-convert failed; with what it said.
        """
        script, errors = self._process.communicate()
        if self._process.returncode != 0:
            message = f"vl-convert made no script for the charts: {errors.strip()}"
            raise StudyError(message)
        return script


def html(answer: Answer, evidence: Evidence, script: ChartScript) -> str:
    """Return the report's page: the same text for the same answer and evidence.

    Where the script cannot be made (it needs gigabytes of address space), the page has its tables
    and says that the charts are missing: an answer is worth more than they.
    """
    try:
        javascript = script.text()
    except StudyError:
        javascript = ""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("agent_economy.study.report", "."),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    view = View(answer, evidence)
    advice, colon, reasons = answer.sentence.partition(":")
    return environment.get_template("report.html.jinja").render(
        answer=answer,
        advice=advice + colon,
        reasons=reasons,
        facts=tuple(facts(answer)),
        quarantined=quarantined(view),
        sections=tuple(sections(view)),
        assumptions=tuple(assumptions(view)),
        charts=specifications(answer, evidence) if javascript else {},
        javascript=javascript,
    )


def facts(answer: Answer) -> Iterator[tuple[str, str]]:
    """Return the numbers that say how sure an answer is, each with what it is."""
    yield certainty(answer.confidence), "confidence"
    yield brief(answer.delta), "delta, the difference of merit worth finding"
    yield f"{answer.runs:,}", "runs in all"
    yield (
        f"{len(answer.results):,}",
        "configurations" if len(answer.results) > 1 else "configuration",
    )


def quarantined(view: View) -> str:
    """Return a warning of runs that gave no finite merit; nothing where there are none."""
    counts = [result.quarantined for result in view.answer.results]
    hit = [index for index in view.ranked if counts[index]]
    if not hit:
        return ""
    named = "; ".join(f"{counts[index]:,} of {view.names[index]}" for index in hit[:MOST_NAMED])
    more = f"; and of {len(hit) - MOST_NAMED:,} others" if len(hit) > MOST_NAMED else ""
    return (
        f"{count(sum(counts), 'run')} gave no finite merit. They are quarantined: each counts as "
        f"the worst there is. {named}{more}."
    )
