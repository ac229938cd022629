"""The place of the world on the earth."""

from collections.abc import Mapping
from typing import Any

from agent_economy._core import LocalFrame

MONTEREY = {"latitude_deg": 36.595267, "longitude_deg": -121.875003, "declination_deg": 14.5}
"""The origin of a scenario without its own: that of the bundled scenario, with x to the east."""


def frame_of(world: Mapping[str, Any]) -> LocalFrame:
    """Return the frame of the `[world]` of a scenario."""
    return LocalFrame(**(world.get("origin") or MONTEREY))
