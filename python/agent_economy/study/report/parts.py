"""Everything that a report shows of an answer, whatever its question was."""

from collections.abc import Iterator
from dataclasses import dataclass

from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.report import charts, requirement_charts
from agent_economy.study.report.assumptions import assumptions, requirement_assumptions
from agent_economy.study.report.chart_parts import Spec
from agent_economy.study.report.formatting import brief, count
from agent_economy.study.report.requirement_sections import requirement_sections
from agent_economy.study.report.requirement_view import RequirementView
from agent_economy.study.report.section import Section
from agent_economy.study.report.sections import sections
from agent_economy.study.report.view import View
from agent_economy.study.selection import percentage

MAX_NAMED = 8
"""Maximum number of configurations that a warning names."""


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
    if isinstance(answer, RequirementAnswer):
        about = RequirementView(answer, evidence)
        return ReportParts(
            facts=tuple(facts(answer)),
            quarantined=quarantined(answer, about.names, about.known),
            sections=tuple(requirement_sections(about)),
            assumptions=tuple(requirement_assumptions(about)),
            charts=requirement_charts.specifications(about),
        )
    view = View(answer, evidence)
    return ReportParts(
        facts=tuple(facts(answer)),
        quarantined=quarantined(answer, view.names, view.ranked),
        sections=tuple(sections(view)),
        assumptions=tuple(assumptions(view)),
        charts=charts.specifications(answer, evidence),
    )


def facts(answer: AnyAnswer) -> Iterator[tuple[str, str]]:
    """Return the key numbers of an answer, each with its label."""
    yield percentage(answer.confidence), "confidence"
    if isinstance(answer, RequirementAnswer):
        yield percentage(answer.requirement.probability), "required share of missions"
        yield percentage(answer.requirement.tolerance), "tolerance"
    else:
        yield brief(answer.delta), "indifference zone (delta)"
    yield f"{answer.runs:,}", "runs"
    yield (
        f"{len(answer.results):,}",
        "configurations" if len(answer.results) > 1 else "configuration",
    )


def quarantined(answer: AnyAnswer, names: tuple[str, ...], shown: tuple[int, ...]) -> str:
    """Return a warning about quarantined runs; an empty string if there are none."""
    counts = [result.quarantined for result in answer.results]
    hit = [index for index in shown if counts[index]]
    if not hit:
        return ""
    details = "; ".join(f"{counts[index]:,} of {names[index]}" for index in hit[:MAX_NAMED])
    more = f"; and of {len(hit) - MAX_NAMED:,} others" if len(hit) > MAX_NAMED else ""
    if isinstance(answer, RequirementAnswer):
        runs = (
            f"{count(sum(counts), 'run')} without an outcome: quarantined, each counts as not met."
        )
        return f"{runs} {details}{more}."
    return (
        f"{count(sum(counts), 'run')} without a finite merit: quarantined, each counts as the "
        f"worst merit. {details}{more}."
    )
