"""Thumbnails of scenarios, for the gallery."""

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from agent_economy import _core
from agent_economy.runs.classic_simulation import ClassicSimulation
from agent_economy.runs.classic_world import CELL_PX, WORLD
from agent_economy.runs.simulation import Simulation
from agent_economy.scenario import Scenario
from agent_economy.server.runs import classic_view

STEPS = 100
"""The thumbnail shows the run after this number of steps."""

MAX_ROBOTS = 400
"""Maximum number of robots that are drawn."""

FREE, WALL, GROUND, ROBOT, ITEM = "#f4f6fa", "#7b8494", "#e6d3b3", "#2563eb", "#dc2626"

Place = Sequence[float]


def thumbnail(scenario: Scenario) -> str:
    """Return the world of a scenario with its robots and items as SVG, y upwards.

    Raises:
        InputError: If the world has no room for them.
    """
    return metric(scenario) if scenario.engine == "metric" else grid(scenario)


def metric(scenario: Scenario) -> str:
    """Return the world of a scenario of the metric engine."""
    simulation = Simulation(scenario, threads=1)
    simulation.step(STEPS)
    setting = _core.recorded_setting(simulation._run)  # noqa: SLF001  (ours)
    document = scenario.to_dict()
    width_m, height_m = document["world"]["size_m"]
    size_m = max(width_m, height_m) / 60
    items = simulation.items
    places = zip(items["x_m"].to_pylist(), items["y_m"].to_pylist(), strict=True)
    shapes = [
        *(
            polygon(area, GROUND)
            for kind in document.get("terrain", {}).values()
            for area in kind["areas_m"]
        ),
        *(obstacle(each) for each in setting["shapes"]),
        *(circle(place, size_m / 1.5, ITEM) for place in places),
        *(chevron(pose, size_m) for pose in simulation.poses[:MAX_ROBOTS].tolist()),
    ]
    return svg(width_m, height_m, shapes)


def grid(scenario: Scenario) -> str:
    """Return the grid of 2003, with the robots at their starting positions."""
    side = classic_view.SIDE_PX
    poses = [
        (each["x_px"], side - each["y_px"], math.radians(90 - each["heading_deg"]))
        for each in ClassicSimulation(scenario).team.to_pylist()
    ]
    shapes = [
        squares(WORLD["walls"], WALL),
        squares(WORLD["items"], ITEM),
        *(chevron(pose, classic_view.RADIUS_PX) for pose in poses),
    ]
    return svg(side, side, shapes)


def squares(cells: Iterable[tuple[int, int]], colour: str) -> str:
    """Return cells of the grid in one path: separate squares would show seams."""
    size = CELL_PX
    corners = (classic_view.outline(cell)[0] for cell in cells)
    parts = (f"M{x:g},{y:g}h{size:g}v{size:g}h{-size:g}z" for x, y in corners)
    return f'<path d="{"".join(parts)}" fill="{colour}"/>'


def svg(width: float, height: float, shapes: Iterable[str]) -> str:
    """Return shapes on a light background, y upwards."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height:g}">'
        f'<rect width="{width:g}" height="{height:g}" fill="{FREE}"/>'
        f'<g transform="matrix(1 0 0 -1 0 {height:g})">{"".join(shapes)}</g></svg>'
    )


def obstacle(given: Mapping[str, Any]) -> str:
    """Return a polygon or a circle; maps are not drawn."""
    if "polygon_m" in given:
        return polygon(given["polygon_m"], WALL)
    return circle(given["at_m"], given["radius_m"], WALL)


def polygon(corners: Iterable[Place], colour: str) -> str:
    """Return a polygon."""
    points = " ".join(f"{x:g},{y:g}" for x, y in corners)
    return f'<polygon points="{points}" fill="{colour}"/>'


def circle(at: Place, radius: float, colour: str) -> str:
    """Return a circle."""
    x, y = at
    return f'<circle cx="{x:.5g}" cy="{y:.5g}" r="{radius:.4g}" fill="{colour}"/>'


def chevron(pose: Place, size: float) -> str:
    """Return a robot."""
    x, y, heading_rad = pose
    ahead, aside = math.cos(heading_rad) * size, math.sin(heading_rad) * size
    corners = [(1.0, 0.0), (-0.8, 0.7), (-0.4, 0.0), (-0.8, -0.7)]
    turned = [(x + a * ahead - b * aside, y + a * aside + b * ahead) for a, b in corners]
    return polygon([(round(a, 3), round(b, 3)) for a, b in turned], ROBOT)
