"""What the program of 2002 would have sent for the lines of a recorded drive, beside what was sent.

Its reads are served from the recorded lines in their order, as by a TCP buffer: a line that it has
not read yet waits. It decides as soon as the line that it reads has arrived.
"""

import math
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from typing import Any

from agent_economy._core import LocalFrame
from agent_economy.live.drivers import DRIVERS
from agent_economy.live.frame import frame_of
from agent_economy.live.plan import Origin, RobotPlan
from agent_economy.live.program_2002.control import Control
from agent_economy.live.program_2002.inputs import UncaughtError
from agent_economy.live.program_2002.navigation import Waypoint, as_typed
from agent_economy.live.readings import Quantity

FULL_TURN_DEG = 360.0


@dataclass(frozen=True)
class Course:
    """A bearing to a waypoint, and the difference of the heading from it, in degrees."""

    bearing_deg: float
    difference_deg: float


@dataclass(frozen=True)
class Row:
    """A moment at which one of the two programs sends something else than before.

    Attributes:
        time_s: Time since the first line of the recording.
        sent_2002: The lines in force by the program of 2002, each with its port.
        behaviour_2002: The behaviour of it that decided last.
        course_2002: What it computed last; None before its first pass.
        heading_age_s: Age of the compass line that it read last.
        sent: The lines in force by this program.
        course: Bearing and difference of the newest lines, for the same waypoint, wrapped; None
            without them.
    """

    time_s: float
    sent_2002: tuple[tuple[str, str], ...]
    behaviour_2002: str
    course_2002: Course | None
    heading_age_s: float
    sent: tuple[tuple[str, str], ...]
    course: Course | None


@dataclass(frozen=True)
class Comparison:
    """Both programs beside each other, for the lines of one robot.

    Attributes:
        robot: Its name.
        rows: The moments at which one of the two sends something else.
        waits_for: The port of which the program of 2002 waited for a line at the end.
        waits_s: The time for which it had waited for it then.
        ended: Why its control thread ended, if it did; the robot then repeats its last line.
        unread: Number of lines by port that it had not read at the end.
    """

    robot: str
    rows: tuple[Row, ...]
    waits_for: str
    waits_s: float
    ended: str | None
    unread: Mapping[str, int]


def compare(
    plan: RobotPlan,
    origin: Origin,
    waypoint_m: Sequence[float] | None,
    messages: Sequence[Mapping[str, Any]],
    *,
    steers: bool = False,
) -> Comparison:
    """Return what the program of 2002 sends for recorded lines, beside what was sent.

    Args:
        plan: The robot.
        origin: The geographic origin of the world.
        waypoint_m: The waypoint that both steer to, x and y in metres; None for the one that was
            built into the program of 2002.
        messages: The lines of the robot, read and written, in order.
        steers: Whether the program of 2002 turns to its waypoint. As printed, it never does.
    """
    frame = frame_of(origin)
    waypoint = Waypoint() if waypoint_m is None else as_typed(*frame.to_geographic(*waypoint_m))
    old = _Program(Control(waypoint, steers=steers))
    new = _Sent(plan, frame, waypoint_m or frame.to_local(*waypoint.position_deg))
    first_s, last_s = (messages[place]["t"] if messages else 0.0 for place in (0, -1))
    return Comparison(
        robot=plan.name,
        rows=tuple(_rows(old, new, messages, first_s)),
        waits_for=old.port,
        waits_s=last_s - max(old.read_s, first_s),
        ended=old.ended,
        unread={port: len(lines) for port, lines in old.waiting.items() if lines},
    )


def _rows(
    old: "_Program", new: "_Sent", messages: Sequence[Mapping[str, Any]], first_s: float
) -> Iterator[Row]:
    """Yield a row after each group of lines of one time that changes what is in force."""
    before = None
    for time_s, group in groupby(messages, key=lambda message: float(message["t"])):
        for message in group:
            if message["type"] == "line":
                old.take(message["port"], message["line"], time_s)
                new.take(message["port"], message["line"])
            else:
                new.write(message["port"], message["line"].strip(), time_s)
        both = (old.in_force, new.in_force)
        if both != before:
            before = both
            yield _row(old, new, time_s, first_s)


def _row(old: "_Program", new: "_Sent", time_s: float, first_s: float) -> Row:
    control = old.control
    course = None
    if control.bearing_deg is not None:
        course = Course(control.bearing_deg, control.difference_deg)
    return Row(
        time_s=time_s - first_s,
        sent_2002=old.in_force,
        behaviour_2002=control.behaviour.value,
        course_2002=course,
        heading_age_s=time_s - old.compass_s if old.compass_s > -math.inf else 0.0,
        sent=new.in_force,
        course=new.course(),
    )


@dataclass
class _Program:
    """The program of 2002 with the lines that it has not read yet."""

    control: Control
    port: str = ""
    ended: str | None = None
    read_s: float = -math.inf
    compass_s: float = -math.inf
    in_force: tuple[tuple[str, str], ...] = ()
    waiting: dict[str, deque[tuple[str, float]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._reads = self.control.run()
        self.port = next(self._reads)

    def take(self, port: str, line: str, time_s: float) -> None:
        """Take a line that arrives, and decide as far as the lines that wait allow."""
        self.waiting.setdefault(port, deque()).append((line, time_s))
        while self.ended is None and self.waiting.get(self.port):
            self._read(time_s)

    def _read(self, time_s: float) -> None:
        line, arrived_s = self.waiting[self.port].popleft()
        self.read_s = time_s
        if self.port == "compass":
            self.compass_s = arrived_s
        try:
            self.port = self._reads.send(line)
        except UncaughtError as error:
            self.ended = str(error)
        if self.control.written:
            # It also read lines between two that it wrote, and what it wrote before stays in force.
            self.in_force = in_force([*self.in_force, *self.control.written])
            self.control.written = []


@dataclass
class _Sent:
    """What this program wrote, and the course of the newest lines."""

    plan: RobotPlan
    frame: LocalFrame
    waypoint_m: Sequence[float]
    in_force: tuple[tuple[str, str], ...] = ()
    _written: list[tuple[str, str]] = field(default_factory=list)
    _at_s: float = -math.inf
    _position_m: tuple[float, float] | None = None
    _heading_rad: float | None = None

    def take(self, port: str, line: str) -> None:
        """Take a line that arrives."""
        driver, settings = DRIVERS[self.plan.driver], self.plan.settings
        reading = driver.parse(port, line.encode("latin-1"), settings, self.frame)
        if reading is None:
            return
        values = [each for each in reading.values if each is not None and math.isfinite(each)]
        if reading.quantity is Quantity.HEADING and values:
            self._heading_rad = values[0]
        if reading.quantity is Quantity.POSITION and len(values) == len(reading.values):
            self._position_m = (values[0], values[1])

    def write(self, port: str, line: str, time_s: float) -> None:
        """Take a line that was written; the lines of one turn of the warden have one time."""
        if time_s != self._at_s:
            self._written, self._at_s = [], time_s
        self._written.append((port, line))
        self.in_force = in_force(self._written)

    def course(self) -> Course | None:
        """Return bearing and difference of the newest lines."""
        if self._position_m is None or self._heading_rad is None:
            return None
        x_m, y_m = (at - own for at, own in zip(self.waypoint_m, self._position_m, strict=True))
        direction_rad = math.atan2(y_m, x_m)
        turn_deg = math.degrees(direction_rad - self._heading_rad)
        return Course(
            self.frame.magnetic_bearing_deg(direction_rad),
            abs(math.remainder(turn_deg, FULL_TURN_DEG)),
        )


def in_force(written: Sequence[tuple[str, str]]) -> tuple[tuple[str, str], ...]:
    """Return what remains in force of lines that are written at once.

    A line for both tracks, or a stop, cancels those before it.
    """
    kept: list[tuple[str, str]] = []
    for port, line in written:
        if line.startswith(("x,2,", "x,3,")):
            kept = []
        kept.append((port, line))
    return tuple(kept)
