"""The panel of goals and controllers, and that of the goals which a robot serves."""

from collections.abc import Callable, Iterator

from agent_economy.runs.reasons import reason_label
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.shown.drawing import chooses
from agent_economy.server.runs.shown.goals import STATUSES, Goal, Picture, Row
from agent_economy.server.runs.shown.row_filter import RowFilter
from agent_economy.server.runs.shown.tables import (
    MAX_ROWS,
    cell,
    muted,
    plural,
    row,
    section,
    table,
)
from agent_economy.types.page import Cell, Colour, Panel, Section
from agent_economy.types.page import Row as TableRow

Colouring = Callable[[str | None], Colour]
"""Returns the colour of what belongs to a controller."""


def panel(picture: Picture, choice: tuple[str, str], chosen: RowFilter) -> Panel:
    """Return the panel of all goals, or of those of the chosen controller, as far as they pass."""
    return {"note": None, "sections": [controllers(picture, choice), goals(picture, chosen)]}


def controllers(picture: Picture, choice: tuple[str, str]) -> Section:
    """Return the controllers; a click on one chooses it."""
    found = section("Controllers")
    if not picture.controllers:
        found["paragraphs"] = [muted("No controllers: the goals have no owner.")]
        return found
    rows = [controller(picture, each, choice) for each in picture.controllers]
    heads = ("Controller", "#Owned", "#Awarded", "#Lost", "#Refused")
    found["table"] = table(heads, rows)
    return found


def controller(picture: Picture, of: Row, choice: tuple[str, str]) -> TableRow:
    """Return the row of a controller."""
    name = of["name"]
    own = [goal for goal in picture.goals if goal.owner == name]
    lost = [goal for goal in of["lost"] if goal is not None]
    awarded = sum(goal.status in ("awarded", "in_service") for goal in own)
    button = cell(
        name,
        colour=picture.colour(name),
        choice=chooses(choice[0], name, choice[1]),
        is_chosen=name == picture.chosen,
    )
    numbers = (len(own), awarded, len(lost), of["refused"])
    signals = [f"controller/{name}/{key}" for key in ("goals", "awarded", "lost")]
    return row((button, *map(str, numbers)), details_of_controller(of, lost), signals)


def details_of_controller(of: Row, lost: list[str]) -> str:
    """Return what else is known of a controller."""
    failed = "" if of["working"] else "Failed. "
    aboard = f", aboard {of['aboard']}" if of["aboard"] else ""
    given = f". Transferred: {plural(of['transfers'], 'goal')}" if of["transfers"] else ""
    names = f". Lost: {', '.join(lost)}" if lost else ""
    return f"{failed}Radio range {of['range_m']:g} m{aboard}{given}{names}"


def goals(picture: Picture, filtered: RowFilter) -> Section:
    """Return the goals, of the chosen controller if there is one."""
    chosen = picture.chosen
    own = [goal for goal in picture.goals if chosen in (None, goal.owner)]
    found = section(f"Goals of {chosen}" if chosen else "Goals")
    if not own:
        found["paragraphs"] = [muted("No goals.")]
        return found
    shown = [goal for goal in own if filtered.passes(goal.status, cells(goal))]
    kinds = (goal.status for goal in own)
    found["filter"] = filtered.offered("Search goals", STATUSES, kinds, len(shown))
    if shown:
        rows = [goal_row(goal, picture.colour) for goal in shown[:MAX_ROWS]]
        found["table"] = table(("Goal", "Owner", "Status"), rows, total=len(shown))
    return found


def cells(goal: Goal) -> Iterator[str]:
    """Yield the contents of the row of a goal."""
    yield from (goal.name, goal.owner or "none", STATUSES[goal.status])
    yield from details(goal)


def goal_row(goal: Goal, colour: Colouring) -> TableRow:
    """Return the row of a goal."""
    status = cell(STATUSES[goal.status], ", ".join(details(goal)))
    return row((goal.name, owner_cell(goal.owner, colour), status), at=goal.at)


def owner_cell(owner: str | None, colour: Colouring) -> Cell:
    """Return the cell of an owner."""
    return cell("", "none") if owner is None else cell(owner, colour=colour(owner))


def details(goal: Goal) -> Iterator[str]:
    """Yield what else is known of a goal."""
    if goal.robot is not None:
        yield f"{'by' if goal.status == 'served' else 'to'} {goal.robot}"
    if goal.lease_s is not None:
        yield f"lease {goal.lease_s:.0f} s"
    if goal.votes:
        yield f"votes of {', '.join(goal.votes)}"
    if goal.unserved:
        yield reason_label(goal.unserved)


def service(simulation: Simulation, robot: str | None, colour: Colouring) -> Panel | None:
    """Return the goals that a robot serves; None if it does not exist now."""
    if robot is None or robot not in simulation.robots:
        return None
    served = simulation.served_goals(robot)
    found = section()
    if served:
        rows = [served_row(each, colour) for each in served]
        found["table"] = table(("Goal", "Owner", "#Lease", "Verdict"), rows)
    else:
        found["paragraphs"] = [muted("No controller has awarded it a goal.")]
    return {"note": str(len(served)) if served else "none", "sections": [found]}


def served_row(of: Row, colour: Colouring) -> TableRow:
    """Return the row of a goal that a robot serves."""
    name = of["goal"] or f"at {of['x_m']:.1f}, {of['y_m']:.1f}"
    owner = owner_cell(of["owner"], colour)
    at = (of["x_m"], of["y_m"])
    return row((name, owner, f"{of['lease_s']:.1f} s", of["verdict"]), at=at)
