"""What a page draws over a frame, of the layers that it has turned on.

An overlay is sent right before its frame. In little endian it is three `u32`: 2, the number of the
frame, the number of links; then the links and the footprints, as `_core.drawn_links` and
`_core.drawn_footprints` encode them.
"""

import struct

from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs import engines
from agent_economy.types.page import Economy, Lanes, Layers

KIND = 2
"""The first number of an overlay, which distinguishes it from a frame."""

HEADER = struct.Struct("<3I")
"""Kind, number of the frame, number of links."""

LINK_BYTES = 12


class Overlay:
    """The layers that a page has turned on, and the robot that it has selected."""

    def __init__(self) -> None:
        """Begin without layers."""
        self._layers = Layers(links=False, footprints=False, economy=False, lanes=False)
        self._robot: str | None = None

    def set_layers(self, layers: Layers) -> None:
        """Turn layers on or off."""
        self._layers = layers

    def choose(self, robot: str | None) -> None:
        """Select a robot, or none; a robot that does not exist has no overlay of its own."""
        self._robot = robot

    def is_shown(self, simulation: Stepped) -> bool:
        """Return whether frames of a run have an overlay."""
        return any(self._layers_of(simulation))

    def over(self, simulation: Stepped, frame: int) -> bytes:
        """Return the overlay of the frame of the current moment."""
        links, footprints = (
            draw(simulation, self._robot) if draw else b"" for draw in self._layers_of(simulation)
        )
        return HEADER.pack(KIND, frame, len(links) // LINK_BYTES) + links + footprints

    def economy(self, simulation: Stepped) -> Economy | None:
        """Return goals and controllers; None if they are not requested, or there are none."""
        draw = engines.of(simulation).economy
        return draw(simulation, self._robot) if draw and self._layers.economy else None

    def lanes(self, simulation: Stepped) -> Lanes | None:
        """Return the mined lane; None if it is not requested, or there is none."""
        draw = engines.of(simulation).lanes
        return draw(simulation) if draw and self._layers.lanes else None

    def _layers_of(self, simulation: Stepped) -> list[engines.DrawOverlay | None]:
        engine, layers = engines.of(simulation), self._layers
        return [
            engine.links if layers.links else None,
            engine.footprints if layers.footprints else None,
        ]
