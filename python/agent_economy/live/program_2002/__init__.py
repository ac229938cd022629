"""The control program that drove Bender in 2002, with its faults, for lines that were recorded."""

from agent_economy.live.program_2002.comparison import Comparison, Course, Row, compare
from agent_economy.live.program_2002.control import Control
from agent_economy.live.program_2002.inputs import Readings, UncaughtError
from agent_economy.live.program_2002.navigation import Waypoint, bearing_deg

__all__ = [
    "Comparison",
    "Control",
    "Course",
    "Readings",
    "Row",
    "UncaughtError",
    "Waypoint",
    "bearing_deg",
    "compare",
]
