"""The charts of a report are scaled to the contenders; a switch shows all configurations."""

import re
from typing import Any

import altair as alt
import in_memory_study
import pytest
import vl_convert
from in_memory_study import WANDERERS

from agent_economy.study import report
from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.report import charts
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.scale import SWITCH, ValueAxis, scaled

Study = tuple[Answer, Evidence]


@pytest.fixture(scope="module")
def teams() -> Study:
    """Return the 2003 experiment; one robot alone is far behind."""
    return in_memory_study.study(
        [{WANDERERS: robots} for robots in range(1, 9)], in_memory_study.classic
    )


def domains(chart: dict[str, Any], channel: str) -> tuple[list[float], list[float]]:
    """Return the ends of an axis, scaled to all configurations and to the contenders."""
    scale = chart["layer"][0]["encoding"][channel]["scale"]
    ends = [scale[name]["expr"] for name in ("domainMin", "domainMax")]
    parts = [re.fullmatch(rf"{SWITCH} \? (\S+) : (\S+)", each) for each in ends]
    return [float(p[1]) for p in parts if p], [float(p[2]) for p in parts if p]


def drawn(chart: dict[str, Any], *, everything: bool) -> str:
    """Return a chart as SVG, with its switch."""
    params = [{"name": SWITCH, "value": everything}]
    return vl_convert.vegalite_to_svg({**chart, "width": 600, "params": params})


def test_a_configuration_far_behind_does_not_squeeze_the_contenders(teams: Study) -> None:
    answer, _ = teams
    chart = charts.specifications(MeritView(*teams))["merit"]
    everything, near = domains(chart, "y")
    far = answer.results[0].merit
    assert far.value < near[0]
    assert everything[0] <= far.low
    for index in answer.contenders:
        merit = answer.results[index].merit
        assert near[0] <= merit.low
        assert merit.high <= near[1]


def test_the_switch_shows_the_configuration_far_behind_again(teams: Study) -> None:
    chart = charts.specifications(MeritView(*teams))["merit"]
    alt.LayerChart.from_dict(chart)
    assert "↓" in drawn(chart, everything=False)
    assert "↓" not in drawn(chart, everything=True)


def test_contenders_are_those_that_are_not_proved_to_be_worse(teams: Study) -> None:
    answer, _ = teams
    near = {answer.results[index].standing.verdict for index in answer.contenders}
    others = {
        each.standing.verdict
        for index, each in enumerate(answer.results)
        if index not in answer.contenders
    }
    assert "best" in near
    assert others == {"worse"}


def test_without_a_configuration_far_behind_there_is_no_switch() -> None:
    rows = [
        {"configuration": index, "value": value, "low": value - 0.1, "high": value + 0.1}
        for index, value in enumerate((1.0, 1.1, 0.9))
    ]
    chart = {"data": {"values": rows}, "layer": []}
    assert scaled(chart, ValueAxis("x"), {0, 1}) == chart


def test_the_report_has_the_script_of_the_switch(teams: Study) -> None:
    page = report.html(*teams, "draw()")
    assert '"All teams", "Contenders"' in page
