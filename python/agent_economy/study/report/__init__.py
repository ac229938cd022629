"""The report of a study: one HTML page that works offline.

`view` orders what is shown; `charts` are Vega-Lite specifications, `tables` the same numbers;
`sections` put both in the page's order; `page` fills the template.
"""

from agent_economy.study.report.page import ChartScript, html

__all__ = ["ChartScript", "html"]
