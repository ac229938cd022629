"""The external bodies of the robots of a fleet."""

from agent_economy.live.plan import FleetPlan, RobotPlan
from agent_economy.live.readings import Quantity
from agent_economy.runs.external import ExternalBody


def bodies_of(plan: FleetPlan) -> dict[str, ExternalBody]:
    """Return the external body of each robot, by name.

    A robot counts as silent when its position is stale: it may then be anywhere within its fence.
    """
    return {robot.name: _body(robot) for robot in plan.robots}


def _body(robot: RobotPlan) -> ExternalBody:
    positions = [each for each in robot.inputs if each.quantity is Quantity.POSITION]
    max_age_s = min((each.max_age_s for each in positions), default=None)
    return ExternalBody(robot.sensors, max_age_s, robot.fence_m or ())
