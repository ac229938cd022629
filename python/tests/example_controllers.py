"""Controllers in Python for tests, and a scenario with few goals."""

from metric import world

import agent_economy as ae
from agent_economy.runs.brain import Command, Percept
from agent_economy.runs.controller import ControllerSettings

FEW_GOALS = world("""
clock = { step_s = 0.2, time_limit_s = 60 }
world.size_m = [30, 30]
[goals.spot]
count = 4
within_m = 2
placement = { kind = "fixed", at_m = [[4, 4], [26, 5], [5, 25], [25, 26]] }
[controllers.base]
count = 1
start = { kind = "fixed", at_m = [[15, 15]] }
radio = { range_m = 100, loss_probability = 0.05 }
[robots.rover]
radius_m = 0.3
count = 2
drive = { max_speed_m_s = 2, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 120 }
sensors.gps = { kind = "position", noise_m = 0.1 }
sensors.compass = { kind = "heading", noise_deg = 2 }
sensors.scanner = { kind = "range", rays = 16, range_m = 5 }
radio = { range_m = 100, loss_probability = 0.05 }
brain = { behaviours = [{ kind = "serve" }, { kind = "avoid" }] }
""")
"""Two rovers visit four places, which a controller awards to them."""


class Late(ae.Controller):
    """The bundled controller, which does nothing for ten seconds."""

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept."""
        command = super().step(percept)
        if (percept["time_s"] or 0) < 10:
            command["outbox"] = []
        return command


class NoController:
    """An object without a method `step`."""

    def __init__(self, settings: ControllerSettings) -> None:
        """Take the settings of a controller."""
        self.settings = settings


LATE = {"base": Late}
