"""The report of a study: one HTML page that works offline.

`view` selects and orders what is shown; `charts` are Vega-Lite specifications, `tables` the same
numbers as text; `sections` combine both, those with `requirement_` for the question of that name;
`parts` are all of them; `page` fills the template with them and the `script`.
"""

from agent_economy.study.report.charts import specifications
from agent_economy.study.report.page import html
from agent_economy.study.report.parts import ReportParts, parts
from agent_economy.study.report.script import ChartScript
from agent_economy.study.report.section import Section
from agent_economy.study.report.sections import sections
from agent_economy.study.report.tables import Table
from agent_economy.study.report.view import View

__all__ = [
    "ChartScript",
    "ReportParts",
    "Section",
    "Table",
    "View",
    "html",
    "parts",
    "sections",
    "specifications",
]
