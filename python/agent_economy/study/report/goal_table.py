"""The table of where the time of a goal goes."""

from agent_economy.study.answer.goal_time import GoalTime
from agent_economy.study.report.formatting import decimal, places
from agent_economy.study.report.requirement_view import RequirementView
from agent_economy.study.report.tables import Cell, Row, Table, words
from agent_economy.study.report.view import View

HEADS = (
    "waiting, s",
    "travel, s",
    "blocked, s",
    "service, s",
    "sum, s",
    "goals served",
    "served twice",
)


def goal_time(view: View | RequirementView) -> Table:
    """Return the table of the parts of the time of a goal, and of goals served."""
    times = view.with_goal_time
    decimals = places(max(time.total_s for time in times.values()) / 50)

    def row(index: int, time: GoalTime) -> Row:
        parts_s = (time.waiting_s, time.travel_s, time.blocked_s, time.service_s, time.total_s)
        style = "best" if index == view.selected else ""
        cells = (
            words(view.names[index]),
            *(Cell(decimal(part_s, decimals)) for part_s in parts_s),
            Cell(decimal(time.served, 1)),
            Cell(decimal(time.served_twice, 1)),
        )
        return Row(cells, style, index)

    caption = "Parts of the time of a goal, and goals served in a run, in the mean"
    rows = tuple(row(index, time) for index, time in times.items())
    return Table(caption, ("configuration", *HEADS), rows)
