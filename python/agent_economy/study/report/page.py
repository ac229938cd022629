"""The report: one HTML file that works offline."""

from collections.abc import Iterator
from functools import cache

import jinja2

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.labels import recommendation
from agent_economy.study.report.assumptions import assumptions
from agent_economy.study.report.charts import specifications
from agent_economy.study.report.formatting import brief, count
from agent_economy.study.report.sections import sections
from agent_economy.study.report.view import View
from agent_economy.study.selection import percentage

MAX_NAMED = 8
"""Maximum number of configurations that a warning names."""


def html(answer: Answer, evidence: Evidence, javascript: str) -> str:
    """Return the report's page: the same text for the same answer and evidence.

    Args:
        answer: The answer of the study.
        evidence: The runs that the answer follows from.
        javascript: The text of `ChartScript`. If it is empty, the page has its tables and a note
            that the charts are missing.
    """
    view = View(answer, evidence)
    advice = f"{recommendation(answer.results[answer.best].values)}."
    return template().render(
        answer=answer,
        advice=advice,
        reasons=answer.sentence.removeprefix(advice),
        facts=tuple(facts(answer)),
        quarantined=quarantined(view),
        sections=tuple(sections(view)),
        assumptions=tuple(assumptions(view)),
        charts=specifications(answer, evidence) if javascript else {},
        javascript=javascript,
    )


@cache
def template() -> jinja2.Template:
    """Return the compiled template of the report."""
    environment = jinja2.Environment(
        loader=jinja2.PackageLoader("agent_economy.study.report", "."),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template("report.html.jinja")


def facts(answer: Answer) -> Iterator[tuple[str, str]]:
    """Return the key numbers of an answer, each with its label."""
    yield percentage(answer.confidence), "confidence"
    yield brief(answer.delta), "indifference zone (delta)"
    yield f"{answer.runs:,}", "runs"
    yield (
        f"{len(answer.results):,}",
        "configurations" if len(answer.results) > 1 else "configuration",
    )


def quarantined(view: View) -> str:
    """Return a warning about runs without a finite merit; an empty string if there are none."""
    counts = [result.quarantined for result in view.answer.results]
    hit = [index for index in view.ranked if counts[index]]
    if not hit:
        return ""
    details = "; ".join(f"{counts[index]:,} of {view.names[index]}" for index in hit[:MAX_NAMED])
    more = f"; and of {len(hit) - MAX_NAMED:,} others" if len(hit) > MAX_NAMED else ""
    return (
        f"{count(sum(counts), 'run')} without a finite merit: quarantined, each counts as the "
        f"worst merit. {details}{more}."
    )
