"""The passage of a mined lane by vehicles: its path, and the vehicles on it."""

import math
from collections.abc import Sequence

from agent_economy.runs.passage import ClearedShare, Passage, Vehicle
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.shown.drawing import (
    Symbols,
    fill,
    glyph,
    key,
    key_of_line,
    layer,
    line,
    stroke,
)
from agent_economy.server.runs.shown.lane_choice import chosen_lane
from agent_economy.server.runs.shown.subject import Contents, Request, Subject
from agent_economy.server.runs.shown.tables import percent, plain, plural, section, strong
from agent_economy.types.page import Glyph, Layer, Section

PATH, VEHICLES = "passage", "vehicles"

HEADING = "Passage"
BAND = stroke("accent", 1.5, is_dashed=True)


def is_in(simulation: Simulation) -> bool:
    """Return whether vehicles of a run are to pass its lane."""
    return "passage" in simulation.scenario.to_dict()


def contents(simulation: Simulation, request: Request) -> Contents | None:
    """Return the path that the chosen controller states, and the vehicles."""
    lane = chosen_lane(simulation, request)
    if lane is None:
        return None
    path, corners = lane.passage, lane.corners_m

    def path_layer() -> Layer:
        if path is None:
            return layer()
        middle = line(path.path_m, BAND)
        middle["band"] = path.width_m
        return {**layer(), "clip": corners, "lines": [middle]}

    def vehicle_layer() -> Layer:
        return vehicles_layer(simulation.vehicles, path.width_m if path else 0.0)

    return Contents({PATH: path_layer, VEHICLES: vehicle_layer}, {})


def vehicles_layer(vehicles: Sequence[Vehicle], width_m: float) -> Layer:
    """Return vehicles as discs as wide as the path; those that were destroyed are crossed out."""
    symbols = Symbols()
    marks = [
        symbols.marker(vehicle.at_m, symbol(vehicle.status, width_m / 2))
        for vehicle in vehicles
        if vehicle.has_entered
    ]
    return layer() | {"symbols": symbols.all, "markers": marks}


def symbol(status: str, radius_m: float) -> list[Glyph]:
    """Return the symbol of a vehicle."""
    is_lost, outline = status == "lost", stroke("text")
    inside = fill("robot-broken" if is_lost else "accent", 0.75)
    disc = glyph("circle", 5.0, inside, outline) | {"radius": radius_m}
    # The ends of a cross are on the disc.
    size = math.sqrt(0.5) / 0.8
    cross = glyph("cross", 5.0 * size, None, outline) | {"radius": radius_m * size}
    return [disc, cross] if is_lost else [disc]


def section_of(of: Passage) -> Section:
    """Return the section of a panel about a path."""
    texts = [strong(passage_label(of)), plain(path_label(of))]
    return section("Passage") | {"paragraphs": texts}


def cleared_label(of: ClearedShare) -> str:
    """Return the share of mines that are cleared: "98.7% (95% interval 91.2% to 100%)"."""
    share, low, high = (f"{round(100 * value, 1):g}%" for value in (of.share, of.low, of.high))
    return f"{share} (95% interval {low} to {high})"


def passage_label(of: Passage) -> str:
    """Return the risk of the first and of the last vehicle."""
    last = f", last of {len(of.risks)} {percent(of.risks[-1])}" if len(of.risks) > 1 else ""
    return f"Risk of the first vehicle {percent(of.risks[0] if of.risks else 0.0)}{last}."


def path_label(of: Passage) -> str:
    """Return the path: "Path of 200 m, 3 m wide: 0.0042 mines expected in it."."""
    return (
        f"Path of {of.length_m:.3g} m, {of.width_m:.3g} m wide: {of.mines:.3g} mines expected in "
        "it."
    )


def vehicles_label(vehicles: Sequence[Vehicle]) -> str:
    """Return what has become of vehicles: "2 vehicles passed, 1 lost (with the first)."."""
    driving, passed, lost = (
        sum(vehicle.status == status for vehicle in vehicles)
        for status in ("driving", "passed", "lost")
    )
    first = " (with the first)" if vehicles[0].status == "lost" else ""
    rest = f", {driving} driving" if driving else ""
    return f"{plural(passed, 'vehicle')} passed, {lost} lost{first}{rest}."


SUBJECT = Subject(
    layers=(
        {
            "id": PATH,
            "label": "Passage",
            "is_on": True,
            "place": "below",
            "heading": HEADING,
            "keys": [key_of_line("path of the vehicles", BAND)],
        },
        {
            "id": VEHICLES,
            "label": "Vehicles",
            "is_on": True,
            "place": "above",
            "heading": HEADING,
            "keys": [
                key("vehicle", *symbol("driving", 0.0)),
                key("destroyed", *symbol("lost", 0.0)),
            ],
        },
    ),
    panels=(),
    is_in=is_in,
    contents=contents,
)
