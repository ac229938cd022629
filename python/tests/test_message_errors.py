"""Messages, items and robots that no scenario has are refused wherever they enter a run."""

import math
from collections.abc import Callable
from typing import Any, cast

import pytest

from agent_economy import Brain, InputError, Simulation
from agent_economy.runs.brain import Command, Percept

SENDER = {"about": {"sender": {"at": [1, 2], "heading_rad": 0.0}}, "confidence": 0.5}
STOP = {"motion": {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}}


def item(kind: int = 0, observer: int = 0, confidence: float = 1.0) -> dict[str, Any]:
    """Return a message about an item."""
    provenance = {"observer": {"kind": observer, "index": 0}, "track_id": 0, "observations": 1}
    about = {"item": {"kind": kind, "at": [1, 2], "provenance": provenance}}
    return {"about": about, "confidence": confidence}


def send(message: dict[str, Any]) -> Command:
    """Return a command that sends a message after a valid one."""
    return cast("Command", STOP | {"outbox": [SENDER, message]})


def by_command(message: dict[str, Any]) -> None:
    """Send a message by a command from outside."""
    simulation = Simulation("search")
    try:
        simulation.step(commands={"rover/1": send(message)})
    finally:
        assert simulation.tick in (0, 1)


def by_python_brain(message: dict[str, Any]) -> None:
    """Send a message by a brain in Python."""

    class Sender:
        """Sends the message in each step."""

        def __init__(self, body: Any) -> None:
            """Need nothing of the body."""

        def step(self, _percept: Percept) -> Command:
            """Send it."""
            return send(message)

    Simulation("search", brains={"rover": Sender}).step()


def received(message: dict[str, Any], sender: int = 0) -> Percept:
    """Return a percept with a message, after a valid one."""
    robot = {"kind": sender, "index": 1}
    inbox = [
        {"from": {"kind": 0, "index": 1}, "age_s": 0.1, "message": SENDER},
        {"from": robot, "age_s": 0.1, "message": message},
    ]
    return cast("Percept", {"inbox": inbox})


def percepts(percept: Percept) -> None:
    """Give an external body a percept."""
    Simulation("search").step(percepts={"rover/0": percept})


def brain_alone(percept: Percept) -> None:
    """Give a brain without a run a percept."""
    Brain.of("search", "rover").step(percept)


Entrance = Callable[[dict[str, Any]], None]
ENTRANCES: dict[str, tuple[Entrance, str]] = {
    "commands": (by_command, "commands.rover/1.outbox[1]"),
    "brains": (by_python_brain, "brains.rover/0.step().outbox[1]"),
    "percepts": (lambda each: percepts(received(each)), "percepts.rover/0.inbox[1].message"),
    "Brain.step": (lambda each: brain_alone(received(each)), "percept.inbox[1].message"),
}


@pytest.fixture(params=ENTRANCES)
def entrance(request: pytest.FixtureRequest) -> tuple[Entrance, str]:
    """Return a way for a message to enter, and its path in errors."""
    return ENTRANCES[request.param]


def error_of(act: Callable[[], None]) -> str:
    """Return the error of a call."""
    with pytest.raises(InputError) as caught:
        act()
    return str(caught.value).replace('"', "")


@pytest.mark.parametrize("confidence", [0, 0.0, 0.5, 1])
def test_a_confidence_from_0_to_1_is_accepted(
    entrance: tuple[Entrance, str], confidence: float
) -> None:
    entrance[0](item(confidence=confidence))
    entrance[0](SENDER | {"confidence": confidence})


@pytest.mark.parametrize("confidence", [5, 1.0000001, -0.1, math.nan, math.inf])
def test_another_confidence_is_refused(entrance: tuple[Entrance, str], confidence: float) -> None:
    enter, path = entrance
    for message in (item(confidence=confidence), SENDER | {"confidence": confidence}):
        error = error_of(lambda given=message: enter(given))  # type: ignore[misc]
        assert error.startswith(f"{path}.confidence = ")
        if math.isfinite(confidence):
            assert error.endswith(f"= {confidence}: must be a number from 0 to 1")


@pytest.mark.parametrize(("kind", "allowed"), [(1, False), (65535, False), (0, True)])
def test_an_item_of_an_unknown_kind_is_refused(
    entrance: tuple[Entrance, str], kind: int, *, allowed: bool
) -> None:
    enter, path = entrance
    if allowed:
        enter(item(kind))
        return
    why = "must be a number below 1, the number of item kinds"
    assert error_of(lambda: enter(item(kind))) == f"{path}.about.item.kind = {kind}: {why}"


def test_an_observer_of_an_unknown_kind_is_refused(entrance: tuple[Entrance, str]) -> None:
    enter, path = entrance
    why = "must be a number below 1, the number of robot kinds"
    error = error_of(lambda: enter(item(observer=7)))
    assert error == f"{path}.about.item.provenance.observer.kind = 7: {why}"


@pytest.mark.parametrize(
    ("enter", "path"), [(percepts, "percepts.rover/0"), (brain_alone, "percept")]
)
def test_robots_of_an_unknown_kind_are_refused_in_percepts(
    enter: Callable[[Percept], None], path: str
) -> None:
    robot = {"kind": 3, "index": 0}
    neighbour = {"range_m": 1.0, "bearing_rad": 0.0, "age_s": 0.0}
    near = [neighbour | {"id": {"kind": 0, "index": 1}}, neighbour | {"id": robot}]
    for given, at in (
        ({"id": robot}, "id"),
        ({"neighbours": near}, "neighbours[1].id"),
        (received(SENDER, sender=3), "inbox[1].from"),
    ):
        error = error_of(lambda given=given: enter(cast("Percept", given)))  # type: ignore[misc]
        why = "must be a number below 1, the number of robot kinds"
        assert error == f"{path}.{at}.kind = 3: {why}"


def test_a_body_that_does_not_know_the_robot_kinds_accepts_each() -> None:
    rover = {"radius_m": 0.25, "max_speed_m_s": 1, "max_turn_rate_rad_s": 1.5, "period_s": 0.1}
    brain = Brain(None, cast("Any", rover))
    brain.step(received(SENDER, sender=9))
    with pytest.raises(InputError, match="the number of item kinds"):
        brain.step(received(item()))
