"""The warden's event loop: drains, applies the rules, writes; 50 times per second."""

import asyncio
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from agent_economy.live import rules
from agent_economy.live.channel import BEAT_S, Message
from agent_economy.live.clock import now_s
from agent_economy.live.frame import frame_of
from agent_economy.live.locks import AddressLocks
from agent_economy.live.plan import FleetPlan, Point, plan_of
from agent_economy.live.readings import Motion
from agent_economy.live.rules import Action, Decision, Inputs, LoopInputs, Outputs, Setpoint
from agent_economy.live.rules.faults import SETTLING_S, STANDSTILL_S
from agent_economy.live.warden.connection import Share
from agent_economy.live.warden.endings import End
from agent_economy.live.warden.loop_process import LoopProcess
from agent_economy.live.warden.mission import Mission
from agent_economy.live.warden.operator import Operator
from agent_economy.live.warden.robot import DriveContext, Robot

TURN_S = 0.02
"""Time between two turns."""

LATE_S = 0.2
"""After a longer gap between two turns, lines that are read first may be as old as the gap."""

CONFIRM_S = SETTLING_S + STANDSTILL_S + 4.0
"""Time for which the end of a drive waits until all robots have a confirmed standstill."""

Report = Callable[[Mapping[str, Any]], None]
"""Takes an event: a change of a robot's state, a verdict, or a message."""


class Warden:
    """Drives one fleet, from the start of the loop to the end of the drive.

    Attributes:
        operator: Takes requests.
        plan: The fleet; None until the loop has read it.
        record: The recording; empty until then.
        robots: Its robots, once the drive has begun.
        outputs: What the rules decided last.
        goals: The newest verdict of each goal, by robot and goal.
        run: What the loop has reported of the run for a page; None without one.
        page: Takes the tick and the inputs of each step.
        was_late: Whether the loop has reported late steps, or a run that has fallen behind.
        late_steps: Number of steps of the loop that were late by more than a step.
        behind_s: Time by which the run is behind the clock.
        max_behind_s: The longest such time.
    """

    plan: FleetPlan | None

    def __init__(self, report: Report, *, is_headless: bool) -> None:
        """Create it without starting anything."""
        self.operator, self.plan, self.record = Operator(), None, ""
        self._report, self._is_headless = report, is_headless
        self._loop = LoopProcess(self._message)
        self.robots: dict[str, Robot] = {}
        self.outputs = Outputs({})
        self.goals: dict[str, dict[str, Mapping[str, Any]]] = {}
        self.run: Mapping[str, Any] | None = None
        self.page: Callable[[Message], None] = lambda _: None
        self._peers: dict[str, tuple[str, int]] = {}
        self._loop_inputs = LoopInputs(is_alive=True, last_message_s=None)
        self.was_late, self.late_steps = False, 0
        self.behind_s, self.max_behind_s = 0.0, 0.0
        self._planned: asyncio.Future[FleetPlan | None] | None = None
        self._end: End | None = None
        self._is_impatient = False
        self._turned_s = now_s()
        self._beaten_s = 0.0

    async def load(self, arguments: Sequence[str]) -> FleetPlan | None:
        """Start the loop, and return the fleet that it reads; None if that is not valid."""
        self._planned = asyncio.get_running_loop().create_future()
        self._loop.start(arguments)
        self.plan = await self._planned
        if self.plan is None:
            await self.close()
        return self.plan

    def new_locks(self) -> AddressLocks:
        """Return locks of a robot, which the loop holds too, also after the end of the warden."""
        return AddressLocks(self._loop.backup)

    async def drive(self, plan: FleetPlan, locks: Mapping[str, AddressLocks] | None = None) -> End:
        """Drive the robots until the drive ends; then stop them, and close everything.

        Args:
            plan: The fleet.
            locks: The locks of each robot, which the caller closes.
        """
        share = Share.of(sum(len(robot.ports) for robot in plan.robots))
        context = DriveContext(frame_of(plan.origin), self._stamp_s, self._loop.send, share)
        for each in plan.robots:
            self.robots[each.name] = Robot(each, context, (locks or {}).get(each.name))
        async with asyncio.TaskGroup() as tasks:
            connecting = tasks.create_task(self._connect())
            try:
                end = await self._turns(plan)
            finally:  # also after an error in this program
                connecting.cancel()
                await asyncio.gather(*(robot.end() for robot in self.robots.values()))
        await self._loop.end()
        return end

    def unconfirmed(self) -> list[str]:
        """Return the robots whose standstill the inputs do not confirm."""
        return [name for name, each in self.outputs.robots.items() if not each.is_confirmed]

    @property
    def unseen_speed_m_s(self) -> float | None:
        """The fastest motion that the inputs of a robot do not exclude; None if one may move."""
        found = [each.unseen for each in self.outputs.robots.values()]
        return max((each.speed_m_s for each in found if each is not None), default=None)

    @property
    def end_of_load(self) -> End:
        """How the drive ends if there is no fleet to drive."""
        return self._end or End.INVALID

    @property
    def is_ending(self) -> bool:
        """Whether all robots are being stopped because the drive ends."""
        return self._end is not None

    def order(self, robot: str, point_m: Point) -> None:
        """Order a robot to a waypoint, after its others.

        Raises:
            ValueError: If nothing takes orders any more.
        """
        order = {"type": "order", "t": now_s(), "robot": robot, "at_m": list(point_m)}
        is_possible = self._end is None and self._loop_state().is_alive
        if not is_possible or not self._loop.send(order):
            message = (
                "no order is taken: the drive ends, or the process of the loop has ended or does "
                "not read"
            )
            raise ValueError(message)

    def arm(self, robots: Sequence[str]) -> str:
        """Arm robots in the next turn; return an answer in words.

        Raises:
            ValueError: If one cannot be armed; then none is.
        """
        if self.operator.stop or self._end is not None:
            message = "no robot can be armed: an emergency stop has been requested"
            raise ValueError(message)
        blocked = {name: why for name in robots if (why := self._why_not_armed(name))}
        if blocked:
            message = "; ".join(f"{name} cannot be armed: {why}" for name, why in blocked.items())
            raise ValueError(message)
        self.operator.arm |= set(robots)
        return f"armed: {', '.join(robots)}"

    def _why_not_armed(self, name: str) -> str:
        if name not in self.outputs.robots:  # before the first turn
            return "nothing is known of it yet"
        return ", ".join(fault.reason for fault in self.outputs.robots[name].blockers)

    async def close(self) -> None:
        """End the loop of a drive that has not begun, without a recording."""
        await self._loop.end(is_cancelled=True)

    def stop(self) -> None:
        """Stop all robots in the next turn; stop is written then also to those that stand."""
        self.operator.stop = True
        for robot in self.robots.values():
            robot.write_again()

    def interrupt(self) -> None:
        """Stop all robots and end the drive. A second time: without waiting for confirmation."""
        self._is_impatient = self._end is End.INTERRUPTED
        self._end = End.INTERRUPTED
        self.stop()
        if self._planned is not None and not self._planned.done():
            self._planned.set_result(None)

    async def _connect(self) -> None:
        async with asyncio.TaskGroup() as tasks:
            for robot in self.robots.values():
                robot.start(tasks)

    async def _turns(self, plan: FleetPlan) -> End:
        memory = rules.initial(plan)
        mission = Mission(tuple(self.robots), now_s())
        ending_since_s = None
        self._turned_s = now_s()
        while True:
            now = now_s()
            memory = self._turn(memory, plan, now)
            if self._is_headless and self._end is None:
                self.operator.arm |= mission.to_arm(self.outputs.robots)
                self._end = mission.end(self.outputs.robots, self._verdicts(), now)
            if self._end is not None:
                self.operator.stop = True
                ending_since_s = ending_since_s or now
                if self._is_over(now - ending_since_s):
                    return self._end
            await asyncio.sleep(max(0.0, now + TURN_S - now_s()))

    def _turn(self, memory: rules.Memory, plan: FleetPlan, now: float) -> rules.Memory:
        inputs = Inputs(
            robots={name: robot.inputs(now) for name, robot in self.robots.items()},
            loop=self._loop_state(),
            gap_s=now - self._turned_s,
        )
        self._turned_s = now
        memory, outputs = rules.update(memory, plan, now, inputs, self.operator.take())
        for name, decision in outputs.robots.items():
            self.robots[name].command(decision.motion, now)
            self._report_peer(name)
            self._report_changes(name, decision, now)
        self.outputs = outputs
        if now - self._beaten_s >= BEAT_S:
            self._loop.send({"type": "beat", "t": now})
            self._beaten_s = now
        return memory

    def _is_over(self, ending_s: float) -> bool:
        decisions = self.outputs.robots.values()
        if any(decision.action is Action.MOVE for decision in decisions):
            return False
        robots = self.robots.values()
        is_confirmed = all(decision.is_confirmed for decision in decisions)
        # A robot that has not received stop may stand in front of something, and then drive on.
        is_confirmed = is_confirmed and all(robot.has_stop() for robot in robots)
        is_quiet = all(robot.is_quiet() for robot in robots)
        is_waiting = not is_confirmed and not self._is_impatient
        return (not is_waiting and is_quiet) or ending_s > CONFIRM_S

    def _loop_state(self) -> LoopInputs:
        is_alive = not self._loop.has_ended and self._loop.returncode is None
        return replace(self._loop_inputs, is_alive=is_alive)

    def _stamp_s(self) -> float:
        """Return the time of a line read now: after a gap, the time from which on it can be."""
        now = now_s()
        return self._turned_s if now - self._turned_s > LATE_S else now

    def _message(self, message: Mapping[str, Any]) -> None:
        now = now_s()
        lateness_s = message.get("lateness_s", self._loop_inputs.lateness_s)
        error = self._loop_inputs.recording_error
        match message["type"]:
            case "plan":
                self.record = message["record"]
                self._set_plan(plan_of(message["plan"]))
                self._report(message)
            case "invalid":
                self._report(message)
                self._set_plan(None)
            case "ended" if self._planned is not None and not self._planned.done():
                text = "the process of the loop has ended before it had read the fleet"
                self._report({"type": "message", "message": text})
                self._set_plan(None)
            case "beat":
                self.was_late, self.late_steps = message["was_late"], message["late_steps"]
                self.behind_s, self.max_behind_s = message["behind_s"], message["max_behind_s"]
            case "setpoint":
                self._setpoint(message, now)
            case "run":
                self.run = message["run"]
            case "input":
                self.page(message)
            case "goal":
                self.goals.setdefault(message["robot"], {})[message["goal"]] = message
                self._report(message)
            case "radio" | "message" | "recording_error" as kind:
                error = message["message"] if kind == "recording_error" else error
                self._report(message)
        self._loop_inputs = LoopInputs(True, now, lateness_s, error)  # noqa: FBT003

    def _verdicts(self) -> dict[str, dict[str, str]]:
        return {
            robot: {goal: each["verdict"] for goal, each in goals.items()}
            for robot, goals in self.goals.items()
        }

    def _set_plan(self, plan: FleetPlan | None) -> None:
        if self._planned is not None and not self._planned.done():
            self._planned.set_result(plan)

    def _setpoint(self, message: Mapping[str, Any], now: float) -> None:
        robot = self.robots.get(message["robot"])
        if robot is not None and self.plan is not None:
            motion = Motion(*message["motion"])
            lifetime_s = self.plan.setpoint_lifetime_s
            robot.setpoint = Setpoint(motion, message["tick"], now, lifetime_s)

    def _report_peer(self, name: str) -> None:
        """Let the loop know the address of a motor port: if the warden dies, it has to stop it."""
        peer = self.robots[name].peer()
        if peer is not None and self._peers.get(name) != peer:
            self._peers[name] = peer
            self._loop.send({"type": "peer", "robot": name, "address": peer})

    def _report_changes(self, name: str, decision: Decision, now: float) -> None:
        before = self.outputs.robots.get(name)
        if before is not None and _shown(before) == _shown(decision):
            return
        speed_m_s = None if decision.unseen is None else decision.unseen.speed_m_s
        event = {"type": "event", "t": now, "robot": name, **_shown(decision)}
        event["unseen_speed_m_s"] = speed_m_s
        event["reasons"] = {
            fault.name: fault.reason
            for fault in (*decision.latched, *decision.warnings, *decision.faults)
        }
        self._loop.send(event)
        if self._end is None:  # afterwards all robots are stopped, whatever they did before
            self._report(event)


def _shown(decision: Decision) -> dict[str, Any]:
    """Return what changes of a decision are reported."""
    return {
        "action": Action(decision.action).name.lower(),
        "is_armed": decision.is_armed,
        "is_confirmed": decision.is_confirmed,
        "mode": decision.mode.value,
        **{
            key: [fault.name for fault in getattr(decision, key)]
            for key in ("faults", "latched", "blockers", "warnings")
        },
    }
