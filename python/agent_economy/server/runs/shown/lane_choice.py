"""The controller whose belief of the mined lane is shown."""

from agent_economy.runs.lane import BelievedLane
from agent_economy.runs.simulation import Simulation
from agent_economy.server.runs.shown.subject import Request

CONTROLLER = "lane"
"""The choice of that controller."""


def chosen_lane(simulation: Simulation, request: Request) -> BelievedLane | None:
    """Return what the chosen controller believes, or else the first; None if there is no lane."""
    lanes = simulation.lanes
    chosen = request.choices.get(CONTROLLER)
    first = lanes[0] if lanes else None
    return next((lane for lane in lanes if lane.controller == chosen), first)
