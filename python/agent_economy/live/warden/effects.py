"""What a request would change now: one that changes nothing is refused with the reason.

What has been requested since the last turn of the warden counts: it is certain to come first.
"""

from collections.abc import Iterator, Sequence

from agent_economy.live.rules import Decision, Mode
from agent_economy.live.rules.faults import EMERGENCY_STOP
from agent_economy.live.warden.warden import Warden


def is_latched(warden: Warden) -> bool:
    """Return whether the emergency stop of a robot is latched."""
    return any(EMERGENCY_STOP in each.latched for each in warden.outputs.robots.values())


def is_held(warden: Warden) -> bool:
    """Return whether all robots are held."""
    return warden.operator.hold or warden.outputs.is_held


def mode_of(warden: Warden, name: str) -> Mode:
    """Return the mode that a robot has in the next turn."""
    decision = warden.outputs.robots.get(name)
    return warden.operator.mode.get(name, Mode.AUTO if decision is None else decision.mode)


def navigates(warden: Warden, name: str) -> bool:
    """Return whether a robot follows its plan from the next turn on."""
    decision = warden.outputs.robots.get(name)
    return warden.operator.navigate.get(name, True if decision is None else decision.navigates)


def of_stop(warden: Warden) -> str:
    """Return what an emergency stop does, in words. It is never refused."""
    if warden.is_ending:
        return "emergency stop: the drive ends, and all robots are being stopped already"
    if warden.operator.stop:
        return "emergency stop: already requested"
    robots = warden.outputs.robots.values()
    is_latched_for_all = all(EMERGENCY_STOP in each.latched for each in robots)
    if robots and is_latched_for_all and not warden.operator.release:
        return "emergency stop: already latched"
    return "emergency stop of all robots"


def of_hold(warden: Warden) -> str:
    """Return what a hold does, in words. It is never refused."""
    if warden.is_ending:
        return "hold: the drive ends, and all robots are being stopped already"
    is_resumed = warden.operator.resume and not warden.operator.hold
    text = "hold: already active" if is_held(warden) and not is_resumed else "hold of all robots"
    arming = ", ".join(sorted(warden.operator.arm))
    return (
        f"{text}; cancelled: the arming of {arming} that has just been requested"
        if arming
        else text
    )


def check_drive(warden: Warden) -> None:
    """Refuse what has no effect because the drive ends.

    Raises:
        ValueError: If it does.
    """
    _refuse_if(warden.is_ending, "the drive ends: all robots are being stopped")


def check_release(warden: Warden) -> None:
    """Refuse a release without an emergency stop, or together with one, which wins.

    Raises:
        ValueError: If the release has no effect.
    """
    requested = warden.operator
    _refuse_if(
        requested.stop, "an emergency stop has just been requested: release it once it is latched"
    )
    _refuse_if(not is_latched(warden), "no emergency stop is latched")
    _refuse_if(requested.release, "the release has been requested already")


def check_resume(warden: Warden) -> None:
    """Refuse a resume without a hold, or together with one, which wins.

    Raises:
        ValueError: If the resume has no effect.
    """
    requested = warden.operator
    _refuse_if(requested.hold, "a hold has just been requested: resume once it is active")
    _refuse_if(not warden.outputs.is_held, "the robots are not held")
    _refuse_if(requested.resume, "the resume has been requested already")


def check_mode(warden: Warden, name: str, mode: Mode) -> None:
    """Refuse a change to the mode that a robot has, and one that undoes a request of this turn.

    Raises:
        ValueError: If the change has no effect, or if it would leave another request without one.
    """
    _refuse_if(mode_of(warden, name) is mode, f"{name} is in {mode} mode already")
    is_changing = name in warden.operator.mode
    _refuse_if(is_changing, f"a change of the mode of {name} has just been requested")
    _refuse_while_arming(warden, name)


def check_navigate(warden: Warden, name: str, *, is_on: bool) -> None:
    """Refuse to switch navigation to the state that it has, or to undo a request of this turn.

    Raises:
        ValueError: If the switch has no effect, or if it would leave another request without one.
    """
    state = "on" if is_on else "off"
    is_same = navigates(warden, name) == is_on
    _refuse_if(is_same, f"the navigation of {name} is {state} already")
    is_changing = name in warden.operator.navigate
    _refuse_if(is_changing, f"a change of the navigation of {name} has just been requested")
    _refuse_while_arming(warden, name)


def check_confirm(warden: Warden, name: str, port: str) -> None:
    """Refuse to confirm the value of an input that is not doubted, or that is confirmed already.

    Raises:
        ValueError: If the confirmation has no effect.
    """
    decision = warden.outputs.robots.get(name)
    is_doubted = decision is not None and port in decision.doubted
    _refuse_if(not is_doubted, f"{port} of {name} is not doubted: there is nothing to confirm")
    is_requested = port in warden.operator.confirm.get(name, ())
    _refuse_if(is_requested, f"the confirmation of {port} of {name} has been requested already")


def robots_to_arm(warden: Warden, names: Sequence[str]) -> list[str]:
    """Return those of some robots that are not armed.

    Raises:
        ValueError: If all are, or if a request of this turn keeps one from being armed.
    """
    decisions = warden.outputs.robots
    armed = [name for name in names if name in decisions and decisions[name].is_armed]
    left = [name for name in names if name not in armed]
    _refuse_if(not left, f"armed already: {', '.join(names)}")
    _refuse_if(warden.operator.arm >= set(left), "arming has been requested already")
    _refuse_if(warden.operator.hold, "no robot can be armed: a hold has just been requested")
    for name in left:
        is_changing = name in warden.operator.mode or name in warden.operator.navigate
        reason = "a change of its mode or navigation has just been requested"
        _refuse_if(is_changing, f"{name} cannot be armed: {reason}")
    return left


def waiting(warden: Warden, name: str) -> Iterator[str]:
    """Yield why a robot does not follow its plan now, and so takes up no new waypoint."""
    decision = warden.outputs.robots.get(name)
    if mode_of(warden, name) is Mode.MANUAL:
        yield f"{name} is in manual mode"
    is_armed = name in warden.operator.arm or _is_armed(decision)
    if warden.operator.stop or not is_armed:
        yield f"{name} is not armed"
    if is_held(warden):
        yield "the robots are held"
    if not navigates(warden, name):
        yield f"the navigation of {name} is off"


def _is_armed(decision: Decision | None) -> bool:
    return decision is not None and decision.is_armed


def _refuse_while_arming(warden: Warden, name: str) -> None:
    """Refuse what would disarm a robot of which the arming has been accepted in this turn."""
    is_arming = name in warden.operator.arm
    _refuse_if(is_arming, f"the arming of {name} has just been requested: repeat this afterwards")


def _refuse_if(is_refused: bool, message: str) -> None:  # noqa: FBT001  (what it depends on)
    if is_refused:
        raise ValueError(message)
