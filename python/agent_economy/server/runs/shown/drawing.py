"""Parts of layers: strokes, fills, glyphs, markers and lines."""

from collections.abc import Sequence

from agent_economy.types.brain import Point
from agent_economy.types.page import (
    Area,
    Choose,
    Colour,
    Fill,
    Glyph,
    Key,
    Layer,
    Line,
    Marker,
    Shape,
    Stroke,
)


def stroke(colour: Colour, width_px: float = 2.0, *, is_dashed: bool = False) -> Stroke:
    """Return a stroke."""
    return {"colour": colour, "width_px": width_px, "is_dashed": is_dashed}


def fill(colour: Colour, opacity: float = 1.0) -> Fill:
    """Return a fill."""
    return {"colour": colour, "opacity": opacity}


def glyph(
    shape: Shape,
    radius_px: float,
    inside: Fill | None = None,
    outline: Stroke | None = None,
    *,
    has_rim: bool = False,
) -> Glyph:
    """Return a shape around a place."""
    return {
        "shape": shape,
        "radius_px": radius_px,
        "radius": None,
        "fill": inside,
        "outline": outline,
        "has_rim": has_rim,
    }


def key(label: str, *glyphs: Glyph) -> Key:
    """Return an entry of the legend with glyphs."""
    return {"label": label, "glyphs": list(glyphs), "line": None, "area": None, "outline": None}


def key_of_line(label: str, line: Stroke) -> Key:
    """Return an entry of the legend with a line."""
    return {"label": label, "glyphs": [], "line": line, "area": None, "outline": None}


def key_of_area(label: str, area: Fill | None, outline: Stroke | None) -> Key:
    """Return an entry of the legend with an area."""
    return {"label": label, "glyphs": [], "line": None, "area": area, "outline": outline}


class Symbols:
    """The symbols of the markers of a layer; equal ones are one."""

    def __init__(self) -> None:
        """Begin without symbols."""
        self.all: list[list[Glyph]] = []

    def marker(
        self,
        at: Point,
        glyphs: Sequence[Glyph],
        *,
        opacity: float = 1.0,
        label: str | None = None,
    ) -> Marker:
        """Return a marker with a symbol of glyphs, from back to front."""
        symbol = list(glyphs)
        if symbol not in self.all:
            self.all.append(symbol)
        return {
            "at": at,
            "robot": None,
            "symbol": self.all.index(symbol),
            "label": label,
            "opacity": opacity,
            "chooses": None,
        }


def line(
    points: Sequence[Point], drawn: Stroke, *, robot: str | None = None, opacity: float = 1.0
) -> Line:
    """Return a line, which may begin at a robot."""
    return {
        "points": list(points),
        "robot": robot,
        "stroke": drawn,
        "band": None,
        "opacity": opacity,
    }


def box(corners: Sequence[Point], outline: Stroke) -> Area:
    """Return the outline of a box, by its lower left and its upper right corner."""
    (left, low), (right, high) = corners
    return {
        "polygon": [(left, low), (right, low), (right, high), (left, high)],
        "circle": None,
        "fill": None,
        "outline": outline,
        "opacity": 1.0,
    }


def layer() -> Layer:
    """Return an empty layer."""
    return {"clip": None, "raster": None, "areas": [], "lines": [], "symbols": [], "markers": []}


def chooses(key_: str, value: str, panel: str) -> Choose:
    """Return what a click chooses, and the panel that shows it."""
    return {"key": key_, "value": value, "panel": panel}
