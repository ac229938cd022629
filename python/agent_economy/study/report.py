"""The report: one HTML file that works offline."""

import subprocess
import sys
from types import TracebackType
from typing import Self

import jinja2

from agent_economy.merit import Merit
from agent_economy.study.answer import Answer
from agent_economy.study.charts import specifications

from agent_economy.study.versions import versions


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

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """End the process if it still runs."""
        self._process.kill()
        self._process.communicate()

    def text(self) -> str:
        """Return the script, when it is made.

        Raises:
            RuntimeError: If vl-convert failed; with what it said.
        """
        script, errors = self._process.communicate()
        if self._process.returncode != 0:
            message = f"vl-convert made no script for the charts: {errors.strip()}"
            raise RuntimeError(message)
        return script


def html(answer: Answer, evidence: object, script: ChartScript) -> str:
    """Return the report's page."""
    script.text()
    return 'stub'
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("agent_economy.study", "."),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
    )
    return environment.get_template("report.html.jinja").render(
        answer=answer,
        charts=specifications(answer, evidence),
        javascript=script.text(),
        merit_in_words=merit_in_words(answer.scenario.merit),
        versions=versions(),
    )


def merit_in_words(merit: Merit) -> str:
    """Return how a figure of merit is made up."""
    weights = ", ".join(str(term) for term in merit.terms)
    return f"{merit.name}: the mean over runs of {weights}."
