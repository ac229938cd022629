"""External bodies: robots that something outside of a run moves, such as real ones."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from agent_economy.scenario import validation

ReadingSource = Literal["real", "virtual", "both"]
"""Where the readings of a sensor come from: its percepts, a measurement in the run, or both."""

Point = tuple[float, float]

AXES = 2
"""Numbers of a point."""


@dataclass(frozen=True)
class ExternalBody:
    """How a robot has an external body.

    Attributes:
        sensors: Where the readings of its sensors come from, by name. `real`: they are in its
            percepts, as those of sensors that are not named. `virtual`: the run measures from where
            the robot is believed to be; positions and headings cannot be. `both`: the nearer range
            of each ray, all contacts and all neighbours.
        max_age_s: Age of its newest position, 0 to 1e6 s, from which on it counts as silent: it may
            then be anywhere that it can have reached at its maximum speed. None: it never does.
        fence_m: Corners of the area that it cannot leave, in order; empty if it can be anywhere.
    """

    sensors: Mapping[str, ReadingSource] = field(default_factory=dict)
    max_age_s: float | None = None
    fence_m: tuple[Point, ...] = ()

    def __post_init__(self) -> None:
        """Check the types of its attributes.

        Raises:
            InputError: If one has another type.
        """
        validation.of_type("sensors", self.sensors, Mapping, "a mapping from names of sensors")
        corners = "corners, each of two numbers, as in ((1, 1), (9, 1), (9, 9))"
        validation.of_type("fence_m", self.fence_m, Iterable, corners)
        pairs = all(isinstance(each, Sequence) and len(each) == AXES for each in self.fence_m)
        validation.check(pairs, "fence_m", self.fence_m, corners)

    def to_dict(self) -> dict[str, Any]:
        """Return what differs from the defaults, as plain values."""
        values = {
            "sensors": dict(self.sensors),
            "max_age_s": self.max_age_s,
            "fence_m": [list(corner) for corner in self.fence_m],
        }
        return {key: value for key, value in values.items() if value not in ({}, None, [])}


External = Iterable[str] | Mapping[str, ExternalBody]
"""External bodies, by the names of their robots; with names alone, as `ExternalBody()`."""


def external_bodies(given: External) -> dict[str, ExternalBody]:
    """Return external bodies by name, sorted.

    Raises:
        InputError: If they are not names of robots, or one occurs twice.
    """
    names = validation.texts("external", given, "a list of robot names")
    repeated = [name for place, name in enumerate(names) if name in names[:place]]
    validation.check(not repeated, "external", repeated, "different robots, each named once")
    if not isinstance(given, Mapping):
        return {name: ExternalBody() for name in sorted(names)}
    wrong = [name for name in names if not isinstance(given[name], ExternalBody)]
    allowed = "a list of robot names, or a mapping from names to agent_economy.ExternalBody"
    validation.check(not wrong, "external", wrong, allowed)
    return {name: given[name] for name in sorted(names)}


def plain(bodies: Mapping[str, ExternalBody]) -> dict[str, dict[str, Any]]:
    """Return external bodies as plain values."""
    return {name: body.to_dict() for name, body in bodies.items()}


def external_body(values: Mapping[str, Any]) -> ExternalBody:
    """Return the body that `ExternalBody.to_dict` described."""
    fence_m = tuple((float(x), float(y)) for x, y in values.get("fence_m", ()))
    return ExternalBody(values.get("sensors", {}), values.get("max_age_s"), fence_m)
