"""What a page draws over a frame besides robots, if it has asked for that."""

import struct

from agent_economy.server.messages import Layers
from agent_economy.server.runs import engines
from agent_economy.stepped import Stepped

KIND = 2
"""The first number of an overlay: that of a frame is another."""

HEADER = struct.Struct("<3I")
"""Kind, number of the frame, links."""

LINK_BYTES = 12


class Overlay:
    """Which layers a page has on, and the robot that it looks at."""

    def __init__(self) -> None:
        """Begin with none."""
        self._layers = Layers(links=False, footprints=False)
        self._robot: str | None = None

    def ask(self, layers: Layers) -> None:
        """Take what frames are to come with from now on."""
        self._layers = layers

    def choose(self, robot: str | None) -> None:
        """Look at a robot, or at none; nothing is told of one that is not there."""
        self._robot = robot

    def is_asked(self, simulation: Stepped) -> bool:
        """Return whether a run's frames come with an overlay."""
        return any(self._drawn(simulation))

    def over(self, simulation: Stepped, frame: int) -> bytes:
        """Return what lies over the frame of this moment, as `messages` says."""
        drawn = self._drawn(simulation)
        links, footprints = (draw(simulation, self._robot) if draw else b"" for draw in drawn)
        return HEADER.pack(KIND, frame, len(links) // LINK_BYTES) + links + footprints

    def _drawn(self, simulation: Stepped) -> list[engines.Overlaid | None]:
        engine, asked = engines.of(simulation), self._layers
        return [
            engine.links if asked.links else None,
            engine.footprints if asked.footprints else None,
        ]
