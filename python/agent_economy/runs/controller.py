"""A controller for percepts of your own: another radio, other simulators, real robots.

A controller takes percepts and returns commands, as a brain does, and has no other input or output.
Everything that it knows of goals, robots and other controllers comes from the messages of its
percepts, and everything that it does is in the outbox of its commands.
"""

from pathlib import Path
from typing import Literal, TypedDict, cast

from numpy.typing import ArrayLike

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.plain import NotPlainError, floats
from agent_economy.scenario import Scenario, as_scenario, validation
from agent_economy.types.brain import AgentId, Command, Percept, Reason, Task

__all__ = ["Controller", "ControllerSettings", "OwnedGoal", "assignment"]


class ControllerSettings(TypedDict, total=False):
    """The settings of a controller, as in `[controllers.NAME]` of a scenario.

    Attributes:
        allocation: The rule by which it allocates its goals to robots; "auction" by default.
        service_lease_s: Time for which a robot may serve a goal without renewal; 20 by default.
        count: Number of controllers of its kind; 1 by default.
        backup: Whether a majority of them has to vote for the owner of each goal, or each owns its
            goals alone; "majority" by default.
        owner_lease_s: Time for which it votes for an owner without renewal; 30 by default.
        trade: The terms on which it trades goals with others of its kind; None by default: it does
            not.
        auction_s: Time from the first call for bids to the award; 1 by default.
        answer_s: Longest time from an award until the robot's next bid has arrived, for which the
            next award waits; 0.5 by default. In a scenario, it follows from radios and brains.
        max_goals: Maximum number of goals that it owns, more are refused; 1000 by default.
        max_drift: Maximum drift of any clock, in seconds per second; 0.0001 by default.
    """

    allocation: Literal["none", "nearest", "auction", "auction_last", "optimal"]
    service_lease_s: float
    count: int
    backup: Literal["majority", "none"]
    owner_lease_s: float
    trade: "TradeSettings | None"
    auction_s: float
    answer_s: float
    max_goals: int
    max_drift: float


class TradeSettings(TypedDict, total=False):
    """The terms on which controllers trade goals, as in `[controllers.NAME.trade]`.

    Attributes:
        confidence: A goal goes to another controller only if the share of its promises that this
            one has kept, times the probability in its robot's bid, is at least this; 0.5 by
            default.
        gain: A goal goes to another controller only if its cost is at most this part of the
            owner's, or the owner has no bid; 0.7 by default.
    """

    confidence: float
    gain: float


class OwnedGoal(TypedDict):
    """A goal that a controller owns.

    Attributes:
        task: The goal.
        assignee: The robot that it is awarded to; None if there is none.
        lease_s: Remaining time of that robot's lease; None without a robot.
        votes: The controllers that vote for it as the owner.
        owner_lease_s: Remaining time for which a majority does; None if it owns the goal alone.
        unserved: Why no robot can serve it at present; None if one can.
    """

    task: Task
    assignee: AgentId | None
    lease_s: float | None
    votes: list[AgentId]
    owner_lease_s: float | None
    unserved: Reason | None


class Controller:
    """A controller, for percepts of your own.

    Args:
        settings: Its settings; None for the defaults. An entry that is None counts as omitted.

    Raises:
        InputError: If there are errors in them; it lists all.

    Example:
        >>> from agent_economy import Controller
        >>> operator = {"role": "person", "kind": 0, "index": 0}
        >>> me = {"role": "controller", "kind": 1, "index": 0}
        >>> goal = {"issuer": operator, "number": 0}
        >>> task = {"id": goal, "at_m": [3, 4], "radius_m": 1, "value": 1, "service_s": 0,
        ...         "due_s": 60, "work": "visit", "capability": 0}
        >>> issue = {"to": me, "about": {"contract": {"issue": task}}, "confidence": 1}
        >>> received = {"from": operator, "age_s": 0, "message": issue}
        >>> controller = Controller({"allocation": "nearest"})
        >>> sent = controller.step({"time_s": 0, "id": me, "inbox": [received]})["outbox"]
        >>> any("call" in message["about"].get("contract", {}) for message in sent)
        True
        >>> [owned["task"]["at_m"] for owned in controller.goals]
        [[3.0, 4.0]]
    """

    def __init__(self, settings: ControllerSettings | None = None) -> None:
        """Create a controller at the start of a mission: no robot holds a lease of it."""
        given = validation.plain_value("settings", {} if settings is None else settings)
        self._controller = _core.Controller(given)

    @classmethod
    def of(cls, scenario: Scenario | str | Path, kind: str) -> "Controller":
        """Return a controller of a kind of a scenario.

        Args:
            scenario: A scenario of the metric engine, its file, or the name of a bundled one.
            kind: Name of the kind of controllers.

        Raises:
            InputError: If the scenario has errors, is of another engine, or has no such kind.
        """
        validation.of_type("kind", kind, str, "the name of a kind of controllers")
        return cls._from(_core.Controller.of(as_scenario(scenario).metric(), kind))

    def step(self, percept: Percept) -> Command:
        """Return the command for a percept.

        Of the percept, it uses `time_s` (of its own clock), `id`, `position`, `neighbours` and
        `inbox`; of the command, only the outbox counts. Goals reach it as messages of the operator
        (role `person`) about a contract: `issue`. A percept from before the last one changes
        nothing.

        Raises:
            InputError: If an entry of the percept is unknown or has an invalid value, or the kind
                of its id is not numbered after those of robots.
        """
        given = validation.plain_value("percept", percept)
        return cast("Command", self._controller.step(given))

    @property
    def goals(self) -> list[OwnedGoal]:
        """The goals that it owns and that are not done, in the order in which it received them."""
        return cast("list[OwnedGoal]", self._controller.goals())

    @property
    def lost(self) -> list[Task]:
        """The goals that no controller owns, as it has reported: no majority votes for it."""
        return cast("list[Task]", self._controller.lost())

    @property
    def refused(self) -> int:
        """Number of goals that it refused, because it owned its maximum number."""
        return self._controller.refused

    def restarted(self) -> "Controller":
        """Return the controller as it is after a restart during a mission.

        It has the same settings, remembers nothing, and grants nothing for the longest lease.
        """
        return self._from(self._controller.restarted())

    def copy(self) -> "Controller":
        """Return an independent copy in the same state."""
        return self._from(self._controller.copy())

    @classmethod
    def _from(cls, compiled: _core.Controller) -> "Controller":
        controller = cls.__new__(cls)
        vars(controller)["_controller"] = compiled
        return controller


def assignment(costs: ArrayLike) -> list[int | None]:
    """Return the assignment of rows to different columns by which the rule `optimal` awards goals.

    It has the maximum number of pairs and, among those, the smallest sum of costs. The same costs
    always give the same assignment.

    Args:
        costs: Costs of the pairs, shape (rows, columns). One that is not finite forbids its pair.

    Returns:
        The column of each row; None for a row without one.

    Raises:
        InputError: If the costs are not a matrix of numbers.

    Example:
        >>> assignment([[4, 1, 3], [2, 0, 5]])
        [1, 0]
    """
    name, allowed = "costs", "a matrix of numbers, one row per goal and one column per robot"
    try:
        matrix = floats(costs)
    except NotPlainError as error:
        message = f"{name}{error.place} = {error.what}: must be {allowed}; {error.fix}"
        raise InputError(message) from None
    validation.check(matrix.ndim == 2, name, costs, allowed)  # noqa: PLR2004  (a matrix)
    return _core.assignment(matrix)
