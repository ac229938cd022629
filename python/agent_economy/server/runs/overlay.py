"""What a page draws over a frame, of the layers that it has turned on.

An overlay is sent right before its frame. In little endian it is three `u32`: 2, the number of the
frame, the number of links; then the links and the footprints, as `_core.drawn_links` and
`_core.drawn_footprints` encode them.
"""

import struct

from agent_economy.runs.stepped import Stepped
from agent_economy.server.runs import engines
from agent_economy.server.runs.shown.subject import FOOTPRINTS, LINKS, Request

KIND = 2
"""The first number of an overlay, which distinguishes it from a frame."""

HEADER = struct.Struct("<3I")
"""Kind, number of the frame, number of links."""

LINK_BYTES = 12


class Overlay:
    """The layers that a page has turned on, and the robot that it has selected.

    Attributes:
        request: What the page has requested. A robot that does not exist has no overlay of its own.
    """

    def __init__(self) -> None:
        """Begin without layers."""
        self.request = Request()

    def is_shown(self, simulation: Stepped) -> bool:
        """Return whether frames of a run have an overlay."""
        return any(self._layers_of(simulation))

    def over(self, simulation: Stepped, frame: int) -> bytes:
        """Return the overlay of the frame of the current moment."""
        links, footprints = (
            draw(simulation, self.request.robot) if draw else b""
            for draw in self._layers_of(simulation)
        )
        return HEADER.pack(KIND, frame, len(links) // LINK_BYTES) + links + footprints

    def _layers_of(self, simulation: Stepped) -> list[engines.DrawOverlay | None]:
        engine, layers = engines.of(simulation), self.request.layers
        return [
            engine.links if LINKS in layers else None,
            engine.footprints if FOOTPRINTS in layers else None,
        ]
