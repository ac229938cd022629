"""The report of a study: one HTML page that works offline.

The views select and order what is shown; `charts` are Vega-Lite specifications, `tables` the same
numbers as text; `sections` combine both, those with `requirement_` for the question of that name;
`parts` are all of them; `page` fills the template with them and the `script`.
"""

from agent_economy.study.report.page import html
from agent_economy.study.report.parts import ReportParts, parts
from agent_economy.study.report.script import ChartScript
from agent_economy.study.report.section import Section
from agent_economy.study.report.tables import Table

__all__ = [
    "ChartScript",
    "ReportParts",
    "Section",
    "Table",
    "html",
    "parts",
]
