"""One brain for all robots of a kind: a function on arrays.

Arrays have the names and units of the percept and command of a single brain (see
`agent_economy.runs.brain`), with one entry per robot whose brain steps. Missing values are NaN or
False, with the age NaN. The range of a ray without a return is `math.inf`.

Lists of different lengths, such as contacts, are concatenated: `row` holds the index of the robot
of each entry in the arrays of robots.
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
Integers: TypeAlias = NDArray[np.int64]
Booleans: TypeAlias = NDArray[np.bool_]


class Readings(TypedDict, Generic[T]):
    """A value of each robot, and its age, shape (n,)."""

    value: T
    age_s: Floats


class Motions(TypedDict):
    """Motion of each robot, shape (n,): forward speed, and anticlockwise turn rate."""

    speed_m_s: Floats
    turn_rate_rad_s: Floats


class Scans(TypedDict):
    """Scans of a range ring of each robot: ages (n,), and ranges (n, rays)."""

    age_s: Floats
    ranges_m: Floats


class Observations(TypedDict):
    """Measurements of item detectors; `sensor` is an index in `Body.sensors`."""

    row: Integers
    sensor: Integers
    age_s: Floats


class Contacts(TypedDict):
    """Detected items, including false alarms; `kind` is an index in `Body.item_kinds`."""

    row: Integers
    kind: Integers
    sensor: Integers
    range_m: Floats
    bearing_rad: Floats
    age_s: Floats


class Neighbours(TypedDict):
    """Detected robots; `kind` and `index` are those of `RobotId`.

    Attributes:
        course_rad: Direction of motion, relative to the observer's front; NaN if the sensor does
            not measure it.
    """

    row: Integers
    range_m: Floats
    bearing_rad: Floats
    course_rad: Floats
    age_s: Floats
    kind: Integers
    index: Integers


class Inbox(TypedDict):
    """Received messages.

    Attributes:
        row: Index of the receiver in the arrays of robots.
        from_kind: Kind of the sender, counted from 0.
        from_index: Index of the sender within its kind.
        age_s: Time since it was sent.
        confidence: Confidence of the sender, 0 to 1.
        item_kind: Kind of the item that it reports; -1 for a message about the sender, -2 for one
            about its destination, -3 for an order of a person (sender of kind 255), which robots
            cannot send.
        at: Position of the item, sender or destination, shape (messages, 2).
        heading_rad: Heading of the sender; NaN if it is not about the sender.
        observations: Number of observations of the item by the observer, or of all observations
            by the sender.
        observer_kind: Kind of the robot that observed the item.
        observer_index: Index of that robot within its kind.
        track_id: The number that the observer gave the item.
        issuer_kind: Kind of the robot that numbered the goal of which this is the destination; 255
            if no robot did. The same goal has the same issuer and number in all messages.
        issuer_index: Index of that robot within its kind.
        goal_number: The number that the issuer gave the goal.
        status: Status of the sender's commitment to a destination: 0 active, 1 done, 2 released; of
            an order: 0 assign, 1 withdraw.
    """

    row: Integers
    from_kind: Integers
    from_index: Integers
    age_s: Floats
    confidence: Floats
    item_kind: Integers
    at: Floats
    heading_rad: Floats
    observations: Integers
    observer_kind: Integers
    observer_index: Integers
    track_id: Integers
    issuer_kind: Integers
    issuer_index: Integers
    goal_number: Integers
    status: Integers


class Percepts(TypedDict):
    """The percepts of the n robots of a kind whose brains step.

    Attributes:
        body: The body, the same for all robots and in each step.
        count: Number of robots of the kind in the run, including those that do not step.
        time_s: Time since the start of the mission.
        robots: Indices of the robots that step, ascending and below `count`, shape (n,).
        random_words: Four random integers below 2^32 per robot, shape (n, 4).
        position: Measured position in the world; values have the shape (n, 2).
        heading_rad: Measured heading; 0 along x.
        motion: Measured motion, from wheels or rotors.
        battery: State of charge, 0 to 1.
        touch: Whether the robot touches something.
        scans: Scans, one entry per range ring of the body.
        observations: Measurements of item detectors since the last step, including those without
            a contact.
        contacts: Items detected since the last step, including false alarms.
        neighbours: Robots detected since the last step.
        inbox: Messages received since the last step.
    """

    body: Body
    count: int
    time_s: float
    robots: Integers
    random_words: NDArray[np.uint32]
    position: Readings[Floats]
    heading_rad: Readings[Floats]
    motion: Readings[Motions]
    battery: Readings[Floats]
    touch: Readings[Booleans]
    scans: list[Scans]
    observations: Observations
    contacts: Contacts
    neighbours: Neighbours
    inbox: Inbox


class MotionCommands(TypedDict):
    """Commanded motion: arrays of shape (n,), or one number for all robots."""

    speed_m_s: ArrayLike
    turn_rate_rad_s: ArrayLike


class Requests(TypedDict):
    """Sensors to switch on or off; `sensor` is an index in `Body.sensors`."""

    row: ArrayLike
    sensor: ArrayLike
    on: ArrayLike


class Outbox(TypedDict):
    """Messages to send, as in `Inbox`; entries from `heading_rad` on only where they apply."""

    row: ArrayLike
    confidence: ArrayLike
    item_kind: ArrayLike
    at: ArrayLike
    heading_rad: NotRequired[ArrayLike]
    observations: NotRequired[ArrayLike]
    issuer_kind: NotRequired[ArrayLike]
    issuer_index: NotRequired[ArrayLike]
    goal_number: NotRequired[ArrayLike]
    status: NotRequired[ArrayLike]


class Commands(TypedDict):
    """The commands of the robots that step."""

    motion: MotionCommands
    requests: NotRequired[Requests]
    outbox: NotRequired[Outbox]


@dataclass(frozen=True)
class Batch:
    """One brain for all robots of a kind.

    Attributes:
        function: It is called in each step with the percepts of the robots that step, and with a
            dict for its memory, which is empty at the start of a run. It returns their commands.

    Example:
        >>> from agent_economy import Batch, run
        >>> def circles(percepts, memory):
        ...     return {"motion": {"speed_m_s": 0.5, "turn_rate_rad_s": 0.2}}
        >>> run("search", brains={"rover": Batch(circles)}).status
        'incomplete'
    """

    function: Callable[[Percepts, dict[str, Any]], Commands]

    def __post_init__(self) -> None:
        """Check that it can be called.

        Raises:
            InputError: If it cannot.
        """
        validation.check(callable(self.function), "Batch", self.function, "a function on arrays")
