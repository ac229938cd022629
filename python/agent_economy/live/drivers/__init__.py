"""The kinds of robots that can be driven: one file per kind, entered in `DRIVERS`."""

from collections.abc import Mapping

from agent_economy.live.drivers.bender import Bender
from agent_economy.live.drivers.driver import Driver, Port, PortLine, Setting, Settings
from agent_economy.live.drivers.lines import LineSplitter

__all__ = ["DRIVERS", "Driver", "LineSplitter", "Port", "PortLine", "Setting", "Settings"]

DRIVERS: Mapping[str, Driver] = {driver.name: driver for driver in (Bender(),)}
"""All drivers, by name."""
