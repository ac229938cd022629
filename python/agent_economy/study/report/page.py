"""The report: one HTML file that works offline."""

from functools import cache

import jinja2

from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.report.parts import parts


def html(answer: AnyAnswer, evidence: Evidence, javascript: str) -> str:
    """Return the report's page: the same text for the same answer and evidence.

    Args:
        answer: The answer of the study.
        evidence: The runs that the answer follows from.
        javascript: The text of `ChartScript`. If it is empty, the page has its tables and a note
            that the charts are missing.
    """
    shown = parts(answer, evidence)
    return template().render(
        answer=answer,
        verdict=answer.verdict,
        details=answer.details,
        facts=shown.facts,
        quarantined=shown.quarantined,
        sections=shown.sections,
        assumptions=shown.assumptions,
        charts=shown.charts if javascript else {},
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
