"""The table of where the time of a goal goes."""

from agent_economy.study.answer.goal_time import PARTS
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.formatting import decimal, places
from agent_economy.study.report.tables import Cell, Table, marking, styled

HEADS = (
    "waiting, s",
    "travel, s",
    "blocked, s",
    "service, s",
    "sum, s",
    "goals served",
    "served twice",
)


def goal_time(view: AnyView) -> Table:
    """Return the table of the parts of the time of a goal, and of goals served."""
    times = view.with_goal_time
    decimals = places(max(time.total_s for time in times.values()) / 50)

    rows = {
        index: (
            *(Cell(decimal(getattr(time, name), decimals)) for name in (*PARTS, "total_s")),
            Cell(decimal(time.served, 1)),
            Cell(decimal(time.served_twice, 1)),
        )
        for index, time in times.items()
    }
    caption = "Parts of the time of a goal, and goals served in a run, in the mean"
    return styled(view, caption, ("configuration", *HEADS), rows, marking(view))
