"""A brain for all robots of a kind at once: a function on arrays.

Arrays have the names, units and order of a single brain's percept and command (see
`agent_economy.runs.brain`), with an entry for each robot whose brain steps now. Missing values are
NaN or False, and their age is NaN. The range of a ray that meets nothing is `math.inf`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, NotRequired, TypeAlias, TypedDict, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from agent_economy.runs.brain import Body
from agent_economy.scenario import validation

T = TypeVar("T")
Floats: TypeAlias = NDArray[np.float64]
Whole: TypeAlias = NDArray[np.int64]
Truths: TypeAlias = NDArray[np.bool_]


class Readings(TypedDict, Generic[T]):
    """A value of each robot, and how old each is, shape (n,)."""

    value: T
    age_s: Floats


class Motions(TypedDict):
    """How each robot moves, shape (n,): ahead, and anticlockwise."""

    speed_m_s: Floats
    turn_rate_rad_s: Floats


class Scans(TypedDict):
    """What a range ring of each robot measured: ages (n,), and ranges (n, rays)."""

    age_s: Floats
    ranges_m: Floats


class Observations(TypedDict):
    """Measurements of item detectors: of the robot in a `row`, the `sensor` of `Body.sensors`."""

    row: Whole
    sensor: Whole
    age_s: Floats


class Contacts(TypedDict):
    """Items that sensors recognised; `row` is the place of the robot in the arrays of robots."""

    row: Whole
    kind: Whole
    sensor: Whole
    range_m: Floats
    bearing_rad: Floats
    age_s: Floats


class Neighbours(TypedDict):
    """Robots that sensors recognised, `kind` and `index` as in `RobotId`.

    Attributes:
        course_rad: Where it goes, from the robot's front; NaN if the sensor tells no courses.
    """

    row: Whole
    range_m: Floats
    bearing_rad: Floats
    course_rad: Floats
    age_s: Floats
    kind: Whole
    index: Whole


class Inbox(TypedDict):
    """Messages that came in.

    Attributes:
        row: Place of the robot that hears, in the arrays of robots.
        from_kind: Kind of the sender, counted from 0.
        from_index: Place of the sender in its kind.
        age_s: Time since it was sent.
        confidence: How sure the sender is, 0 to 1.
        item_kind: Kind of the item that it is about; -1 if it is about the sender, -2 if it is
            about a place where the sender wants to be.
        at: Where that is, shape (messages, 2).
        heading_rad: The sender's course; NaN if it is not about the sender.
        observations: Number of observations of the item by the observer, or of all observations
            by the sender.
        observer_kind: Kind of the robot that observed the item.
        observer_index: Index of that robot within its kind.
        track_id: The number that the observer gave the item.
        status: Status of the sender's commitment to a destination: 0 active, 1 done, 2 released.
    """

    row: Whole
    from_kind: Whole
    from_index: Whole
    age_s: Floats
    confidence: Floats
    item_kind: Whole
    at: Floats
    heading_rad: Floats
    observations: Whole
    observer_kind: Whole
    observer_index: Whole
    track_id: Whole
    status: Whole


class Percepts(TypedDict):
    """What all robots of a kind perceive whose brains step now; there are n of them.

    Attributes:
        body: What is known of the body, the same for all and in each step.
        count: Robots of the kind that there are in the run, also those that do not step now.
        time_s: Time since the mission began.
        robots: Which robots step, shape (n,): their indices, below `count`, rising.
        random_words: Four random integers below 2^32 for each, shape (n, 4).
        position: Where each is in the world; values have the shape (n, 2).
        heading_rad: The course of each; 0 along x.
        motion: How each moves, from its wheels or rotors.
        battery: Share of each battery's capacity that is left, 0 to 1.
        touch: Whether each touches something.
        scans: Of each range ring of the body.
        observations: Measurements of item detectors since the last step, including those without
            a contact.
        contacts: Items that sensors recognised since the last step, or took for such.
        neighbours: Robots that sensors recognised since the last step.
        inbox: What other robots told since the last step.
    """

    body: Body
    count: int
    time_s: float
    robots: Whole
    random_words: NDArray[np.uint32]
    position: Readings[Floats]
    heading_rad: Readings[Floats]
    motion: Readings[Motions]
    battery: Readings[Floats]
    touch: Readings[Truths]
    scans: list[Scans]
    observations: Observations
    contacts: Contacts
    neighbours: Neighbours
    inbox: Inbox


class WantedMotion(TypedDict):
    """How each robot is to move: arrays with the shape (n,), or one number for all."""

    speed_m_s: ArrayLike
    turn_rate_rad_s: ArrayLike


class Requests(TypedDict):
    """Sensors to switch: of the robot in a `row`, the `sensor` of `Body.sensors`, `on` or off."""

    row: ArrayLike
    sensor: ArrayLike
    on: ArrayLike


class Outbox(TypedDict):
    """What robots are to tell others; as in `Inbox`, the last three where they mean something."""

    row: ArrayLike
    confidence: ArrayLike
    item_kind: ArrayLike
    at: ArrayLike
    heading_rad: NotRequired[ArrayLike]
    observations: NotRequired[ArrayLike]
    status: NotRequired[ArrayLike]


class Commands(TypedDict):
    """What all robots that step now are to do."""

    motion: WantedMotion
    requests: NotRequired[Requests]
    outbox: NotRequired[Outbox]


@dataclass(frozen=True)
class Batch:
    """A brain for all robots of a kind at once.

    Attributes:
        function: What is called in each step of the robots' brains, with their percepts, as arrays,
            and with a dict for whatever is to be remembered, which is empty when a run begins. It
            returns their commands.

    Example:
        >>> from agent_economy import Batch, run
        >>> def circles(percepts, memory):
        ...     return {"motion": {"speed_m_s": 0.5, "turn_rate_rad_s": 0.2}}
        >>> run("search", brains={"rover": Batch(circles)}).status
        'incomplete'
    """

    function: Callable[[Percepts, dict[str, Any]], Commands]

    def __post_init__(self) -> None:
        """See to it that it can be called.

        Raises:
            InputError: If not.
        """
        validation.check(callable(self.function), "Batch", self.function, "a function on arrays")
