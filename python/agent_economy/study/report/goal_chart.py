"""The chart of where the time of a goal goes, as a stacked bar per configuration."""

from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.chart_parts import (
    BLUE,
    GREY,
    INK,
    ORANGE,
    TEAL,
    Spec,
    by_name,
    chart,
    field,
    fixed,
    heights,
    row_of,
)
from agent_economy.study.report.formatting import finite

COLORS = {"waiting": GREY, "travel": BLUE, "blocked": ORANGE, "service": TEAL}
"""The colour of each part, in the order in which a goal passes them."""


def specifications(view: AnyView) -> dict[str, Spec]:
    """Return the specification of the chart by its name; empty if no goal was served."""
    return {"goal-time": goal_time(view)} if view.with_goal_time else {}


def goal_time(view: AnyView) -> Spec:
    """Return the chart of the parts of the time of a goal, with their sum."""
    times = view.with_goal_time
    rows = [
        {**row_of(view, index), "part": part, "time": finite(getattr(time, f"{part}_s")), "at": at}
        for index, time in times.items()
        for at, part in enumerate(COLORS)
    ]
    sums = [{**row_of(view, index), "sum": finite(time.total_s)} for index, time in times.items()]
    place = {"y": by_name(rows)}
    # With room for the text of the longest bar.
    end = finite(1.1 * max(time.total_s for time in times.values())) or 1.0
    scale = {"domain": list(COLORS), "range": list(COLORS.values())}
    bars = {
        **place,
        "x": field("time", title="time of a goal (s)", stack="zero", scale={"domain": [0, end]}),
        "color": field("part", "nominal", scale=scale, title=None),
        "order": field("at"),
        "tooltip": [
            field("label", "nominal", title=" "),
            field("part", "nominal"),
            field("time", title="time (s)", format=".3~r"),
        ],
    }
    text = {"type": "text", "align": "left", "dx": 4}
    ends = {**place, "x": field("sum"), "text": field("sum", format=",.3~r")}
    layers = [{"mark": "bar", "encoding": bars}, {"name": INK, **fixed(sums, text, ends)}]
    return chart(layers, rows, heights(sums))
