"""A robot's mind, for whoever has percepts of their own: live robots, other simulators, learning.

A brain takes percepts and returns commands, and has no other input or output: no clock, no files,
and no random numbers but the random words of the percept. The same percepts give the same commands.
Both are plain dicts, with the names and units of the scenario: metres, seconds and radians; angles
are anticlockwise from the robot's front unless stated otherwise.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import (
    Any,
    Generic,
    Literal,
    NotRequired,
    TypedDict,
    TypeVar,
    cast,
)

from agent_economy import _core
from agent_economy.runs.belief_state import BeliefState
from agent_economy.runs.robots import Point, RobotId
from agent_economy.scenario import Scenario, as_scenario, validation

T = TypeVar("T")


class RangeRing(TypedDict):
    """The rays of a range sensor.

    Attributes:
        bearings_rad: Direction of each ray from the robot's front; above -pi, up to pi.
        range_m: Nothing farther from the robot's centre is measured.
        period_s: Time between two scans.
        latency_s: Time from a scan until the brain has it.
    """

    bearings_rad: Sequence[float]
    range_m: float
    period_s: float
    latency_s: float


class Detector(TypedDict):
    """A sensor that recognises items.

    Attributes:
        sensor: Its place in `Body.sensors`.
        range_m: It looks no farther from the robot's centre.
        width_rad: Angle that it covers.
        facing_rad: Its middle, from the robot's front.
        detection_probability: For each kind of item, pairs of a distance and the probability of
            detection in one scan; empty if the sensor never recognises that kind.
        false_alarms_per_m2: False contacts of each kind in one look, for each square metre in view.
        noise_m: Standard deviation of where a contact seems to be, along each axis.
        needs_line_of_sight: Whether obstacles hide items from it.
    """

    sensor: int
    range_m: float
    width_rad: float
    facing_rad: float
    detection_probability: Sequence[Sequence[Sequence[float]]]
    false_alarms_per_m2: Sequence[float]
    noise_m: float
    needs_line_of_sight: bool


class Other(TypedDict):
    """What a brain knows of the bodies of a kind of robots.

    Attributes:
        radius_m: Of the disc that it covers.
        is_in_the_way: Whether the two can run into each other: not if one of them flies.
        max_acceleration_m_s2: It gains and loses speed at most so fast; left out, at once.
        detectors: What it recognises items with.
    """

    radius_m: float
    is_in_the_way: bool
    max_acceleration_m_s2: NotRequired[float | None]
    detectors: NotRequired[Sequence[Detector]]


class Body(TypedDict):
    """What a brain knows of its body.

    Attributes:
        radius_m: Of the disc that it covers.
        max_speed_m_s: At most so fast ahead.
        max_turn_rate_rad_s: It turns at most so fast, either way.
        period_s: Time between two steps of the brain, 1e-6 at least.
        max_reverse_speed_m_s: At most so fast backwards; left out, it cannot.
        max_acceleration_m_s2: It gains and loses speed at most so fast; left out, at once.
        sensors: Names of its sensors, in the order in which requests count them.
        rings: Its range rings, in the order in which percepts have their scans.
        detectors: What recognises items, in the order of its sensors.
        position_noise_m: Standard deviation of its position sensor along each axis.
        heading_noise_rad: Standard deviation of its compass.
        neighbour_noise_m: Standard deviation of where other robots seem to be, along each axis.
        item_kinds: Names of the kinds of items that there are.
        others: Bodies of all kinds of robots that there are, in the order in which ids count them.
        field: Two opposite corners of where its mission is.
    """

    radius_m: float
    max_speed_m_s: float
    max_turn_rate_rad_s: float
    period_s: float
    max_reverse_speed_m_s: NotRequired[float]
    max_acceleration_m_s2: NotRequired[float]
    sensors: NotRequired[Sequence[str]]
    rings: NotRequired[Sequence[RangeRing]]
    detectors: NotRequired[Sequence[Detector]]
    position_noise_m: NotRequired[float]
    heading_noise_rad: NotRequired[float]
    neighbour_noise_m: NotRequired[float]
    item_kinds: NotRequired[Sequence[str]]
    others: NotRequired[Sequence[Other]]
    field: NotRequired[tuple[Point, Point] | None]


class Motion(TypedDict):
    """A speed ahead (negative is backwards) and a rate of turn (anticlockwise)."""

    speed_m_s: float
    turn_rate_rad_s: float


class Provenance(TypedDict):
    """The observations of one item by one robot: they count once, however often they are reported.

    Attributes:
        observer: The robot that made the observations.
        track_id: The number that the observer gave the item.
        observations: Number of observations: of two reports with the same track id, the one with
            more counts.
    """

    observer: RobotId
    track_id: int
    observations: int


class AboutItem(TypedDict):
    """An item: the index of its kind in `Body.item_kinds`, its position and its provenance.

    The default provenance is the sender.
    """

    kind: int
    at: Point
    provenance: NotRequired[Provenance]


class AboutSender(TypedDict):
    """The sender itself: its position, heading (0 along x) and observations so far."""

    at: Point
    heading_rad: float
    observations: NotRequired[int]


class AboutGoal(TypedDict):
    """A destination of the sender, and the status of its commitment."""

    at: Point
    status: Literal["active", "done", "released"]


class About(TypedDict, total=False):
    """What a message is about: one of the three."""

    item: AboutItem
    sender: AboutSender
    goal: AboutGoal


class Message(TypedDict):
    """What one robot tells others, and how sure it is, 0 to 1."""

    about: About
    confidence: float


class Reading(TypedDict, Generic[T]):
    """A value, and how old it is."""

    value: T
    age_s: float


class Scan(TypedDict, total=False):
    """What a range ring measured; empty if there is no scan.

    Attributes:
        age_s: Time since it was measured.
        ranges_m: From the robot's centre to what reflects, in the order of the ring's bearings;
            `math.inf` where nothing came back.
    """

    age_s: float | None
    ranges_m: Sequence[float | None]


class Observation(TypedDict):
    """A measurement of an item detector: its index in `Body.sensors`, and the age."""

    sensor: int
    age_s: float


class Contact(TypedDict):
    """An item that a sensor recognised, or something that it took for one.

    Kind and sensor are their places in `Body.item_kinds` and `Body.sensors`.
    """

    kind: int
    sensor: NotRequired[int]
    range_m: float
    bearing_rad: float
    age_s: float


class Neighbour(TypedDict):
    """A robot that a sensor recognised.

    Attributes:
        course_rad: Where it goes, from the robot's front; None if the sensor tells no courses.
    """

    range_m: float
    bearing_rad: float
    course_rad: NotRequired[float | None]
    age_s: float
    id: RobotId


# "from" is no name in Python.
Heard = TypedDict("Heard", {"from": RobotId, "age_s": float, "message": Message})
"""A message that came in: who sent it, how long ago, and what."""


class Percept(TypedDict, total=False):
    """All that a robot knows of this moment; any part of it may be missing.

    Attributes:
        time_s: Time since the mission began.
        random_words: Four random integers below 2^32, the only source of randomness of a brain.
        id: Which robot it is: it was told so before the mission.
        team_size: Number of robots of its kind, itself included; 0 if unknown.
        position: Where it is in the world.
        heading_rad: Its course: 0 along x.
        motion: How it moves, from its wheels or rotors.
        battery: Share of the battery's capacity that is left, 0 to 1.
        touch: Whether it touches something.
        scans: Of each range ring of its body, in the body's order.
        observations: Measurements of its item detectors since the last step, including those
            without a contact.
        contacts: Items that its sensors recognised since the last step, or took for such.
        neighbours: Robots that its sensors recognised since the last step.
        inbox: What other robots told since the last step.
    """

    time_s: float
    random_words: Sequence[int]
    id: RobotId
    team_size: int
    position: Reading[Point] | None
    heading_rad: Reading[float] | None
    motion: Reading[Motion] | None
    battery: Reading[float] | None
    touch: Reading[bool] | None
    scans: Sequence[Scan]
    observations: Sequence[Observation]
    contacts: Sequence[Contact]
    neighbours: Sequence[Neighbour]
    inbox: Sequence[Heard]


class SensorRequest(TypedDict):
    """A sensor, by its place in `Body.sensors`, to be switched on or off."""

    sensor: int
    on: bool


class Command(TypedDict):
    """All that a brain wants of its body in this step.

    Attributes:
        motion: How to move, within the body's limits.
        requests: Sensors to switch; each stays so until it is switched again.
        outbox: What to tell other robots.
    """

    motion: Motion
    requests: list[SensorRequest]
    outbox: list[Message]


class Watched(TypedDict):
    """What a robot perceived in one step, what its brain made of it, and why.

    Attributes:
        tick: Steps of the run before that one.
        percept: What it perceived.
        command: What it decided.
        leading: Place in the brain's list of the behaviour that has its way; None if nothing is to
            be done, or all count together.
        holds_s: For so long each behaviour keeps control though it has nothing to do.
        thoughts: What it believes and wants then; None if it has no mind.
    """

    tick: int
    percept: Percept
    command: Command
    leading: int | None
    holds_s: list[float]
    thoughts: BeliefState | None


class Brain:
    """The mind of one robot.

    Args:
        spec: What a scenario says under `[robots.KIND.brain]`; None for the default brain, which
            searches: ahead, at obstacles a random turn, and out of the way of what is too near.
        body: What it knows of its body. None in either is as if it were left out.

    Raises:
        InputError: If anything in either is wrong; all faults at once.

    Example:
        >>> from agent_economy import Brain
        >>> rover = {"radius_m": 0.25, "max_speed_m_s": 1, "max_turn_rate_rad_s": 1.5,
        ...          "period_s": 0.1}
        >>> Brain(None, rover).step({})["motion"]
        {'speed_m_s': 1.0, 'turn_rate_rad_s': 0.0}
    """

    def __init__(self, spec: Mapping[str, Any] | None, body: Body) -> None:
        """Make a mind that has just been switched on."""
        self._mind = _core.Brain({} if spec is None else spec, body)

    @classmethod
    def of(cls, scenario: Scenario | str | Path, kind: str) -> "Brain":
        """Return a brain as a scenario's robots of a kind have it, in their body.

        Args:
            scenario: A scenario of the metric engine, its file, or the name of one that ships.
            kind: Name of a kind of robots.

        Raises:
            InputError: If the scenario is wrong or of another engine, or has no such kind.
        """
        validation.of_kind("kind", kind, str, "the name of a kind of robots")
        brain = cls.__new__(cls)
        vars(brain)["_mind"] = _core.Brain.of(as_scenario(scenario).metric(), kind)
        return brain

    def step(self, percept: Percept) -> Command:
        """Return what the robot is to do; to be called once in each of the body's periods.

        Raises:
            InputError: If the percept has a wrong name, or something of a wrong kind.
        """
        return cast("Command", self._mind.step(percept))

    def thoughts(self) -> BeliefState | None:
        """Return what it believes and wants, as of its last step.

        Returns:
            None if it has no mind: neither beliefs, nor a behaviour that needs them.
        """
        return cast("BeliefState | None", self._mind.thoughts())

    def copy(self) -> "Brain":
        """Return a brain with the same memories, which then goes its own way."""
        brain = Brain.__new__(Brain)
        vars(brain)["_mind"] = self._mind.copy()
        return brain


def schemas() -> dict[str, dict[str, Any]]:
    """Return the JSON Schemas of brains, for other languages.

    They are those of all that enters and leaves one, BrainSpec, Body, Percept and Command, and of
    BeliefState.
    """
    return _core.Brain.schemas()
