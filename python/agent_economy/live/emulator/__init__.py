"""An emulator of Bender, the robot of 2003: its four TCP ports, in a simulated world.

A program that drives the robot cannot distinguish it from the emulator by what it reads. Faults of
lines, sensors, motors and connections can be switched on while it runs.
"""

from agent_economy.live.emulator.emulator import Emulator
from agent_economy.live.emulator.faults import FAULTS
from agent_economy.live.emulator.settings import Settings
from agent_economy.live.emulator.setup import Setup

__all__ = ["FAULTS", "Emulator", "Settings", "Setup"]
