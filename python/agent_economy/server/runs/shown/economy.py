"""The goals and controllers of a run, with a colour for each controller."""

from collections.abc import Iterable, Iterator
from typing import Literal

from agent_economy.runs.reasons import reason_label
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.shown import economy_panel
from agent_economy.server.runs.shown.drawing import (
    Symbols,
    chooses,
    fill,
    glyph,
    key,
    key_of_line,
    layer,
    line,
    stroke,
)
from agent_economy.server.runs.shown.goals import NO_OWNER, Picture, goals_of
from agent_economy.server.runs.shown.row_filter import row_filter
from agent_economy.server.runs.shown.subject import Contents, Request, Subject
from agent_economy.types.page import Area, Colour, Glyph, Key, Layer, Line, Marker

LAYER, PANEL, SERVICE = "economy", "goals", "service"
CONTROLLER = "controller"
"""The choice of the controller whose goals stand out."""

MAX_REASONS = 12
"""With more, the labels would hide each other: the panel lists all."""


def is_in(simulation: Simulation) -> bool:
    """Return whether a run has goals or controllers."""
    document = simulation.scenario.to_dict()
    return bool(document.get("goals") or document.get("controllers"))


def contents(simulation: Simulation, request: Request) -> Contents:
    """Return the goals and controllers, and the goals of the selected robot."""
    controllers = simulation.controllers
    names = [each["name"] for each in controllers]
    chosen = request.choices.get(CONTROLLER)
    goals = goals_of(simulation, controllers)
    picture = Picture(goals, controllers, chosen if chosen in names else None)
    return Contents(
        layers={LAYER: lambda: drawn(picture)},
        panels={
            PANEL: lambda: economy_panel.panel(
                picture, (CONTROLLER, PANEL), row_filter(PANEL, request.choices)
            ),
            SERVICE: lambda: economy_panel.service(simulation, request.robot, picture.colour),
        },
    )


def drawn(picture: Picture) -> Layer:
    """Return the layer: ranges of radios, lines from robots to goals, goals, controllers."""
    symbols = Symbols()
    return layer() | {
        "areas": list(ranges(picture)),
        "lines": list(awards(picture)),
        "markers": [*goal_markers(picture, symbols), *controller_markers(picture, symbols)],
        "symbols": symbols.all,
    }


def ranges(picture: Picture) -> Iterator[Area]:
    """Yield the ranges of the radios of controllers that work."""
    for each in picture.controllers:
        if each["working"]:
            yield {
                "polygon": [],
                "circle": {
                    "at": (each["x_m"], each["y_m"]),
                    "robot": each["aboard"],
                    "radius": each["range_m"],
                },
                "fill": None,
                "outline": stroke(picture.colour(each["name"]), 1.5, is_dashed=True),
                "opacity": 0.6 * picture.opacity(each["name"]),
            }


def awards(picture: Picture) -> Iterator[Line]:
    """Yield a line from each robot to each goal that it has been awarded."""
    for goal in picture.goals:
        if goal.status in ("awarded", "in_service"):
            drawn = stroke(picture.colour(goal.owner), 1.5)
            opacity = picture.opacity(goal.owner)
            yield line([goal.at], drawn, robot=goal.robot, opacity=opacity)


def goal_markers(picture: Picture, symbols: Symbols) -> Iterator[Marker]:
    """Yield the markers of goals; the reasons why none can serve them, if they are few."""
    is_labelled = sum(bool(goal.unserved) for goal in picture.goals) <= MAX_REASONS
    for goal in picture.goals:
        glyphs = symbol(goal.status, picture.colour(goal.owner), is_hopeless=bool(goal.unserved))
        label = reason_label(goal.unserved) if goal.unserved and is_labelled else None
        yield symbols.marker(goal.at, glyphs, opacity=picture.opacity(goal.owner), label=label)


def symbol(status: str, colour: Colour, *, is_hopeless: bool = False) -> list[Glyph]:
    """Return the symbol of a goal.

    A ring while it is open, a disc in it when it is awarded, a tick when it is served, a cross when
    it has expired, a dot until it is issued.
    """
    outline = stroke(colour)
    cross = [glyph("cross", 5.0, None, outline)] if is_hopeless else []
    match status:
        case "served":
            return [glyph("tick", 4.7, None, stroke("item-found"))]
        case "expired":
            return [glyph("cross", 5.0, None, stroke("item-missed"))]
        case "pending":
            return [glyph("circle", 2.0, fill(colour))]
        case "awarded" | "in_service":
            disc = glyph("circle", 2.5, fill(colour))
            return [glyph("circle", 5.0, fill("ground"), outline), disc, *cross]
        case _:
            return [glyph("circle", 5.0, fill("ground"), outline), *cross]


def controller_markers(picture: Picture, symbols: Symbols) -> Iterator[Marker]:
    """Yield a square for each controller, crossed if it has failed; a click on it chooses it."""
    for each in picture.controllers:
        name, is_working = each["name"], each["working"]
        glyphs = square(picture.colour(name), 9.0 if name == picture.chosen else 7.0)
        if not is_working:
            glyphs.append(glyph("cross", 5.0, None, stroke("ground")))
        label = name if is_working else f"{name}, failed"
        at, opacity = (each["x_m"], each["y_m"]), picture.opacity(name)
        mark = symbols.marker(at, glyphs, opacity=opacity, label=label)
        # Those aboard a robot are selected by it.
        choice = None if each["aboard"] else chooses(CONTROLLER, name, PANEL)
        yield mark | {"robot": each["aboard"], "chooses": choice}


def square(colour: Colour, radius_px: float) -> list[Glyph]:
    """Return the symbol of a controller."""
    return [glyph("square", radius_px, fill(colour), stroke("ground"))]


def keys() -> Iterable[Key]:
    """Yield the legend."""
    first: Literal["owner-1"] = "owner-1"
    yield key("open goal", *symbol("open", first))
    yield key("awarded", *symbol("awarded", first))
    yield key("no robot can serve it", *symbol("open", first, is_hopeless=True))
    yield key("served", *symbol("served", first))
    yield key("expired", *symbol("expired", first))
    yield key("not yet issued", *symbol("pending", NO_OWNER))
    yield key("no owner", *symbol("open", NO_OWNER))
    yield key_of_line("robot to goal", stroke(first, 1.5))
    yield key("controller", *square(first, 7.0))
    yield key("its radio range", glyph("circle", 10.0, None, stroke(first, 1.5, is_dashed=True)))


SUBJECT = Subject(
    layers=(
        {
            "id": LAYER,
            "label": "Goals and controllers",
            "is_on": True,
            "place": "above",
            "heading": "Goals and controllers, a colour for each controller",
            "keys": list(keys()),
        },
    ),
    panels=(
        {"id": PANEL, "label": "Goals", "is_of_robot": False},
        {"id": SERVICE, "label": "Goals served", "is_of_robot": True},
    ),
    is_in=is_in,
    contents=contents,
)
