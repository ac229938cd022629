"""Charts that are scaled to the contenders; a parameter switches to all configurations."""

import math
from collections.abc import Collection
from dataclasses import dataclass

from agent_economy.study.report.chart_parts import Rows, Spec, field, fixed

SWITCH = "all_teams"
"""The parameter of a chart: whether it is scaled to all configurations.

`report.js` and the page of `agent-economy ui` set it.
"""

ENOUGH = 0.6
"""Contenders that take at least this share of the whole scale are not squeezed."""

MARGIN = 0.08
"""The share of the scale that is added on both sides."""

Domain = tuple[float, float]


@dataclass(frozen=True)
class Arrow:
    """An arrow for values beyond an end of an axis."""

    text: str
    end: int | str
    offset_px: int


ARROWS = {
    "x": (Arrow("←", 0, 10), Arrow("→", "width", -10)),
    "y": (Arrow("↓", "height", -10), Arrow("↑", 0, 10)),
}
"""The arrows of the lower and the upper end, by the channel of the axis."""


@dataclass(frozen=True)
class ValueAxis:
    """The axis of a chart's values.

    Attributes:
        channel: "x" or "y".
        value: The field of the values.
        ends: The fields of the ends of their intervals.
        include: Values that are always visible.
        within: The possible values.
    """

    channel: str
    value: str = "value"
    ends: tuple[str, str] = ("low", "high")
    include: tuple[float, ...] = ()
    within: Domain = (-math.inf, math.inf)

    @property
    def other(self) -> str:
        """The other channel."""
        return "y" if self.channel == "x" else "x"

    def domain(self, rows: Rows) -> Domain | None:
        """Return the part of the axis that rows take; None if they have no values."""
        found = [row[name] for row in rows for name in (self.value, *self.ends)]
        known = [value for value in found if value is not None]
        if not known:
            return None
        known += self.include
        low, high = min(known), max(known)
        margin = MARGIN * (high - low)
        least, most = self.within
        return max(least, low - margin), min(most, high + margin)


def scaled(spec: Spec, axis: ValueAxis, contenders: Collection[int]) -> Spec:
    """Return a chart whose axis is as long as the contenders need, until it is switched.

    It is unchanged if the others do not squeeze the contenders.
    """
    rows = spec["data"]["values"]
    whole = axis.domain(rows)
    near = axis.domain([row for row in rows if row["configuration"] in contenders])
    if near is None or whole is None or near[1] - near[0] >= ENOUGH * (whole[1] - whole[0]):
        return spec
    least, most = (switched(*ends) for ends in zip(whole, near, strict=True))
    scale = {"domainMin": least, "domainMax": most, "zero": False, "nice": False}
    is_visible = f"datum.{axis.value} >= {near[0]!r} && datum.{axis.value} <= {near[1]!r}"
    visible = [{"filter": f"{SWITCH} || ({is_visible})"}]
    layers = [on_scale(layer, axis.channel, scale, visible) for layer in spec["layer"]]
    params = [{"name": SWITCH, "value": False}]
    return {**spec, "params": params, "layer": [*layers, *beyond(spec, axis, near)]}


def switched(all_of_them: float, near: float) -> Spec:
    """Return an expression for one of two numbers."""
    return {"expr": f"{SWITCH} ? {all_of_them!r} : {near!r}"}


def on_scale(layer: Spec, channel: str, scale: Spec, visible: list[Spec]) -> Spec:
    """Return a layer with a scale: lines end at its ends, and points are visible or not."""
    encoding, mark = layer["encoding"], layer["mark"]
    if channel not in encoding:
        return layer
    at = {**encoding[channel], "scale": {**encoding[channel].get("scale", {}), **scale}}
    made = {**layer, "encoding": {**encoding, channel: at}}
    if mark["type"] == "point":  # Clipped, a point at an end would be cut in half.
        return {**made, "transform": visible}
    return {**made, "mark": {**mark, "clip": True}}


def beyond(spec: Spec, axis: ValueAxis, near: Domain) -> list[Spec]:
    """Return the layers of arrows at the ends of the axis, for values that are not on it."""
    rows = [row for row in spec["data"]["values"] if row[axis.value] is not None]
    below = [row for row in rows if row[axis.value] < near[0]]
    above = [row for row in rows if row[axis.value] > near[1]]
    made = zip((below, above), ARROWS[axis.channel], strict=True)
    return [arrows(spec, axis, rows, sign) for rows, sign in made if rows]


def arrows(spec: Spec, axis: ValueAxis, rows: Rows, sign: Arrow) -> Spec:
    """Return the layer of arrows at one end, for rows whose values are beyond it."""
    places = (layer["encoding"] for layer in spec["layer"] if "data" not in layer)
    place = next(encoding[axis.other] for encoding in places if axis.other in encoding)
    tip = [field("label", "nominal", title=" "), field(axis.value)]
    text = {"expr": f"{SWITCH} ? '' : '{sign.text}'"}
    # Beside the line of an interval that reaches the end.
    offsets = {f"{axis.channel}Offset": sign.offset_px, f"{axis.other}Offset": 8}
    mark = {"type": "text", "text": text, "fontSize": 15, **offsets}
    encoding = {axis.other: place, axis.channel: {"value": sign.end}, "tooltip": tip}
    return fixed(rows, mark, encoding)
