"""The report: one HTML file that works offline."""

import platform
import subprocess
import sys
from importlib.metadata import version
from types import TracebackType
from typing import Self

import jinja2

from agent_economy.scenario import Merit
from agent_economy.study.answer import Answer
from agent_economy.study.charts import charts
from agent_economy.study.runs import Runs
from agent_economy.study.sentence import signed

PACKAGES = ("agent-economy", "numpy", "pyarrow", "scipy", "altair", "vl-convert-python")


class ChartScript:
    """The JavaScript that draws charts, made in a process of its own while the runs go on.

    vl-convert takes a second or two to bundle it and holds the interpreter's lock meanwhile; here
    it costs no time and cannot delay Ctrl-C. Use as a context manager: leaving it ends the
    process.
    """

    def __init__(self) -> None:
        """Start to make it."""
        code = "import sys, vl_convert; sys.stdout.write(vl_convert.javascript_bundle())"
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


def versions() -> dict[str, str]:
    """Return the versions on which results may depend."""
    python = {"python": platform.python_version()}
    return {name: version(name) for name in PACKAGES} | python


def html(runs: Runs, answer: Answer, script: ChartScript) -> str:
    """Return the report's page."""
    specifications = charts(runs, answer)
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("agent_economy.study", "."),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
    )
    environment.filters["signed"] = signed
    return environment.get_template("report.html.jinja").render(
        answer=answer,
        charts=specifications,
        javascript=script.text(),
        merit_in_words=merit_in_words(answer.scenario.merit),
        versions=versions(),
    )


def merit_in_words(merit: Merit) -> str:
    """Return how a figure of merit is made up."""
    return (
        f"{merit.name}: {signed(merit.time_s)} per second of mean time, "
        f"{signed(merit.robots)} per robot, "
        f"{signed(merit.failed / 10)} per failed search in ten."
    )
