"""Everything that a report shows of an answer, whatever its question was."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.report import charts, requirement_charts
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.assumptions import assumptions
from agent_economy.study.report.chart_parts import Spec
from agent_economy.study.report.formatting import count
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.requirement_sections import requirement_sections
from agent_economy.study.report.requirement_view import RequirementView
from agent_economy.study.report.section import Section
from agent_economy.study.report.sections import sections
from agent_economy.study.selection import percentage

MAX_NAMED = 8
"""Maximum number of configurations that a warning names."""

OF_ANSWERS: dict[type, tuple[Any, Any, Any]] = {
    Answer: (MeritView, sections, charts.specifications),
    RequirementAnswer: (
        RequirementView,
        requirement_sections,
        requirement_charts.specifications,
    ),
}
"""The view of each answer, with its sections and its charts."""


@dataclass(frozen=True)
class ReportParts:
    """The parts of a report.

    Attributes:
        facts: Key numbers, each with its label.
        quarantined: A warning about quarantined runs; empty if there are none.
        sections: The sections in their order.
        assumptions: The assumptions, each with its name.
        charts: The Vega-Lite specification of each chart, by name.
    """

    facts: tuple[tuple[str, str], ...]
    quarantined: str
    sections: tuple[Section, ...]
    assumptions: tuple[tuple[str, str], ...]
    charts: dict[str, Spec]


def parts(answer: AnyAnswer, evidence: Evidence) -> ReportParts:
    """Return the parts of the report of an answer."""
    make_view, make_sections, make_charts = OF_ANSWERS[type(answer)]
    view = make_view(answer, evidence)
    return ReportParts(
        facts=tuple(facts(view)),
        quarantined=quarantined(view),
        sections=tuple(make_sections(view)),
        assumptions=tuple(assumptions(view)),
        charts=make_charts(view),
    )


def facts(view: AnyView) -> Iterator[tuple[str, str]]:
    """Return the key numbers of an answer, each with its label."""
    answer = view.answer
    yield percentage(answer.confidence), "confidence"
    yield from view.facts
    yield f"{answer.runs:,}", "runs"
    yield (
        f"{len(answer.results):,}",
        "configurations" if len(answer.results) > 1 else "configuration",
    )


def quarantined(view: AnyView) -> str:
    """Return a warning about quarantined runs; an empty string if there are none."""
    counts = [result.quarantined for result in view.answer.results]
    hit = [index for index in view.known if counts[index]]
    if not hit:
        return ""
    details = "; ".join(f"{counts[index]:,} of {view.names[index]}" for index in hit[:MAX_NAMED])
    more = f"; and of {len(hit) - MAX_NAMED:,} others" if len(hit) > MAX_NAMED else ""
    return f"{count(sum(counts), 'run')} {view.quarantine}. {details}{more}."
