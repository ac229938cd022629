"""The real robots of a run, which have external bodies: where they may be, what sensors report.

What their sensors detected is that of the last percept; virtual sensors of a robot whose brain does
not step report nothing.
"""

import math
from collections.abc import Iterator
from functools import partial
from typing import Any, Literal

from agent_economy import _core
from agent_economy.runs.external import ExternalBody, Point
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.shown.drawing import (
    Symbols,
    fill,
    glyph,
    key,
    key_of_area,
    layer,
    stroke,
)
from agent_economy.server.runs.shown.grown_polygon import grown
from agent_economy.server.runs.shown.subject import Contents, Request, Subject
from agent_economy.server.runs.shown.tables import muted, row, section, strong, table
from agent_economy.types.page import Area, Circle, Glyph, Key, Layer, LayerOffer, Marker, Panel

Source = Literal["real", "virtual"]
View = dict[str, Any]
"""An external body, as `_core.external_views` describes it."""

UNCERTAINTY, PANEL = "uncertainty", "real-robot"
READINGS: dict[Source, str] = {"real": "real-readings", "virtual": "virtual-readings"}
"""The layers of readings."""

HEADING = "Real robots"
KNOWN = fill("text", 0.1), stroke("text", 1.0)
SILENT = fill("robot-warning", 0.25), stroke("text", 2.5, is_dashed=True)
EDGE = stroke("ground", 1.0)
SYMBOLS: dict[Source, dict[str, list[Glyph]]] = {
    "real": {
        "echoes_m": [glyph("circle", 3.5, fill("text"), EDGE)],
        "contacts_m": [glyph("hexagon", 5.0, fill("text"), EDGE)],
        "neighbours_m": [glyph("hexagon", 11.0, None, stroke("text", 1.5))],
    },
    "virtual": {
        "echoes_m": [glyph("cross", 4.0, None, stroke("owner-4", 1.5), has_rim=True)],
        "contacts_m": [glyph("square", 4.5, fill("owner-4"), EDGE)],
        "neighbours_m": [glyph("square", 9.0, None, stroke("owner-4", 1.5))],
    },
}
"""Virtual readings have other shapes and another colour."""

DETECTED = {"echoes_m": "echo", "contacts_m": "item", "neighbours_m": "robot"}
EXPLANATION = (
    "The uncertainty is the standard deviation of its position along each axis; of a silent robot "
    "also how far it can have come. Virtual sensors measure the simulated world from where the "
    "robot is believed to be."
)


def is_in(simulation: Simulation) -> bool:
    """Return whether robots of a run have external bodies."""
    return bool(simulation.external.any())


def contents(simulation: Simulation, request: Request) -> Contents:
    """Return the real robots, and the facts of the selected one."""
    views = _core.external_views(simulation._run)  # noqa: SLF001  (for display)
    layers = {READINGS[source]: partial(readings, views, source) for source in READINGS}
    return Contents(
        layers=layers | {UNCERTAINTY: partial(uncertainty, simulation, views)},
        panels={PANEL: lambda: panel(simulation, views, request.robot)},
    )


def uncertainty(simulation: Simulation, views: list[View]) -> Layer:
    """Return where the bodies of real robots may be; of silent ones, since when."""
    symbols = Symbols()
    size_m = simulation.scenario.to_dict()["world"]["size_m"]
    silent = [view for view in views if view["silent_s"] is not None]
    return layer() | {
        "areas": [area(view, size_m) for view in views],
        "markers": [silence(view, symbols) for view in silent],
        "symbols": symbols.all,
    }


def area(view: View, size_m: Point) -> Area:
    """Return where the body of a real robot may be."""
    is_silent, radius_m = view["silent_s"] is not None, view["radius_m"]
    inside, outline = SILENT if is_silent else KNOWN
    # The dashes of a much larger circle would take long to draw.
    reach_m = radius_m + min(view["uncertainty_m"], math.hypot(*size_m))
    circle: Circle = {"at": view["at_m"], "robot": view["robot"], "radius": reach_m}
    return {
        "polygon": grown(view["outline_m"], radius_m),
        "circle": None if view["outline_m"] else circle,
        "fill": inside,
        "outline": outline,
        "opacity": 1.0,
    }


def silence(view: View, symbols: Symbols) -> Marker:
    """Return since when a robot is silent, beside its ring: "bender/0 silent for 4.2 s"."""
    label = f"{view['robot']} silent for {view['silent_s']:.1f} s"
    around = glyph("circle", 20.0) | {"radius": 2 * view["radius_m"]}
    return symbols.marker(view["at_m"], [around], label=label)


def readings(views: list[View], source: Source) -> Layer:
    """Return what the sensors of real robots detected."""
    symbols = Symbols()
    markers = [
        symbols.marker(place, SYMBOLS[source][what])
        for view in views
        for what in DETECTED
        for place in view[source][what]
    ]
    return layer() | {"markers": markers, "symbols": symbols.all}


def panel(simulation: Simulation, views: list[View], robot: str | None) -> Panel | None:
    """Return where the selected robot has its readings from, and how well its place is known."""
    view = next((view for view in views if view["robot"] == robot), None)
    if view is None:
        return None
    facts = section()
    if view["silent_s"] is not None:
        statement = f"Silent for {view['silent_s']:.1f} s: it may be anywhere in the dashed area."
        facts["paragraphs"] = [strong(statement)]
    rows = [*sensors(simulation, view["robot"]), ("Uncertainty", f"{view['uncertainty_m']:.2f} m")]
    facts["table"] = table((), [row(each) for each in rows])
    explained = section() | {"paragraphs": [muted(EXPLANATION)]}
    return {"note": None, "sections": [facts, explained]}


def sensors(simulation: Simulation, robot: str) -> Iterator[tuple[str, str]]:
    """Yield which sensors of a robot are real, virtual or both, in words."""
    document: dict[str, Any] = _core.read_filled(simulation.scenario.source)
    names = sorted(document["robots"][robot.partition("/")[0]].get("sensors", {}))
    body = simulation.declared_external.get(robot, ExternalBody())
    labels = {"real": "Real sensors", "virtual": "Virtual sensors", "both": "Real and virtual"}
    for source, label in labels.items():
        of_source = [name for name in names if body.sensors.get(name, "real") == source]
        if of_source:
            yield label, ", ".join(of_source)


def keys(source: Source) -> list[Key]:
    """Return the legend of a layer of readings: "virtual: echo"."""
    return [key(f"{source}: {label}", *SYMBOLS[source][what]) for what, label in DETECTED.items()]


def offer(source: Source) -> LayerOffer:
    """Return the offer of a layer of readings."""
    return {
        "id": READINGS[source],
        "label": f"{source.capitalize()} readings",
        "is_on": True,
        "place": "above",
        "heading": HEADING,
        "keys": keys(source),
    }


SUBJECT = Subject(
    layers=(
        {
            "id": UNCERTAINTY,
            "label": "Uncertainty",
            "is_on": True,
            "place": "above",
            "heading": HEADING,
            "keys": [
                key_of_area("uncertainty", *KNOWN),
                key_of_area("silent: may be anywhere in it", *SILENT),
            ],
        },
        offer("real"),
        offer("virtual"),
    ),
    panels=({"id": PANEL, "label": "Real robot", "is_of_robot": True},),
    is_in=is_in,
    contents=contents,
)
