"""One emulated Bender and its brain in virtual time: the real lines, without sockets and clocks.

The robot is the emulator's: its lines, its tracks, the world of the engine. The errors of its drive
and of its sensors come from `imperfect_robot`. The brain side is that of the loop: driver, team,
simulation with an external body. The warden is reduced to arming once and writing motor lines.
"""

import math
from dataclasses import dataclass, field, replace
from typing import Any

from imperfect_robot import ROBOT, DriveErrors, EmulatedRobot, SensorErrors, overrides, phases

from agent_economy.live import fleet
from agent_economy.live.drivers import DRIVERS, PortLine
from agent_economy.live.emulator.faults import SENDING
from agent_economy.live.emulator.world import STEP_S
from agent_economy.live.frame import frame_of
from agent_economy.live.line_readings import LineReadings
from agent_economy.live.loop.team import Team
from agent_economy.live.plan import RobotPlan
from agent_economy.live.readings import Motion
from agent_economy.live.warden.motor_line import MotorLines
from agent_economy.runs.simulation import Simulation

ARMED_S = 2.0
"""When the robot is armed. Until then it stands, and its inputs arrive."""

MOTOR_PERIOD_S = 0.1
"""Time between two motor lines of the same motion."""

TURN_GAP_S, TURN_MARGIN_S = 1.0, 5.0
"""As in the warden's rule: turns with a shorter gap are one, and a turn does not end if it takes
longer than a full turn and this margin."""


@dataclass(frozen=True)
class Case:
    """What is measured in one run.

    Attributes:
        scenario: The name of a bundled scenario of Bender.
        drive: Errors of the drive.
        sensors: Errors of the sensors.
        seed: Seed of all random numbers.
        limit_s: Time after arming at which the run ends.
    """

    scenario: str
    drive: DriveErrors
    sensors: SensorErrors
    seed: int
    limit_s: float


@dataclass
class Turns:
    """The longest turn; turns with a gap of less than a second are one."""

    longest_s: float = 0.0
    _since_s: float = math.inf
    _turned_s: float = -math.inf

    def add(self, time_s: float, *, is_turning: bool) -> None:
        """Take the state at a time."""
        self._turned_s = time_s if is_turning else self._turned_s
        if time_s - self._turned_s >= TURN_GAP_S:
            self._since_s = math.inf
            return
        self._since_s = min(self._since_s, time_s)
        self.longest_s = max(self.longest_s, time_s - self._since_s)


@dataclass
class Record:
    """What a run has shown. Times are from arming on.

    Attributes:
        waypoints: The number of waypoints.
        complete: Each waypoint that was declared complete: its name, its time, and the robot's
            true distance from it.
        given_up: Waypoints that were declared impossible at some time.
        end_s: When the run ended.
        turns: Turns to a heading, as the warden counts them.
        spot_turns: Turns with tracks of opposite directions.
        turn_limit_s: What the warden allows for a turn to a heading.
        turn_fault_s: When it would have stopped the robot first; None if never.
        motor_lines: Number of motions that were written, and of those that turn on the spot.
        contacts: Contacts with walls.
        beliefs: At each step of the brain: time, true error of the position and stated deviation.
    """

    waypoints: int = 0
    complete: list[tuple[str, float, float]] = field(default_factory=list)
    given_up: set[str] = field(default_factory=set)
    end_s: float = 0.0
    turns: Turns = field(default_factory=Turns)
    spot_turns: Turns = field(default_factory=Turns)
    turn_limit_s: float = math.inf
    turn_fault_s: float | None = None
    motor_lines: list[int] = field(default_factory=lambda: [0, 0])
    contacts: int = 0
    beliefs: list[tuple[float, float, float]] = field(default_factory=list)


class BrainSide:
    """The loop and what is left of the warden."""

    def __init__(self, case: Case, brain_fleet: fleet.Fleet) -> None:
        """Create it without readings."""
        plan = brain_fleet.plan
        self.plan = plan.robots[0]
        self.simulation = Simulation(
            brain_fleet.scenario, seed=case.seed, threads=1, external=(ROBOT,)
        )
        self.team = Team(plan, self.simulation, {}, seed=case.seed, start_s=0.0)
        driver, settings = DRIVERS[self.plan.driver], self.plan.settings
        # A little less than the period: the times of two ticks differ by it but for rounding.
        period_s = MOTOR_PERIOD_S - 1e-6
        self._motors = MotorLines(driver, settings, frame_of(plan.origin), period_s)
        self._lines = LineReadings(plan)
        self.motion, self.has_stepped = Motion(), False

    def add(self, port: str, line: bytes, time_s: float) -> None:
        """Take a line that was received."""
        text = line.decode("latin-1")
        reading = self._lines.of({"robot": ROBOT, "port": port, "t": time_s, "line": text})
        if reading is not None:
            self.team.add(reading)

    def arm(self, time_s: float) -> None:
        """Let the robot drive."""
        lists = {key: [] for key in ("faults", "latched", "blockers", "warnings")}  # type: ignore[var-annotated]
        event = {"type": "event", "t": time_s, "robot": ROBOT, "action": "move", "mode": "auto"}
        self.team.add(event | lists | {"is_armed": True, "is_confirmed": False, "reasons": {}})

    def tick(self, time_s: float) -> tuple[PortLine, ...]:
        """Take one step of the loop; return the motor lines that are due."""
        percepts = self.team.percepts(self.simulation.tick, time_s)
        self.has_stepped = bool(percepts)
        commands = self.simulation.step(percepts=percepts)
        self.motion = limited(Motion(*self.team.motions(commands)[ROBOT]), self.plan)
        return self._motors.due(self.motion, time_s, is_empty=True)

    def belief(self) -> tuple[list[float], float] | None:
        """Return the believed position and its stated deviation."""
        state: Any = self.simulation.belief_state(ROBOT)
        pose = state and state["pose"]
        return (pose["at"], pose["deviation_m"]) if pose else None


class VirtualDrive:
    """One run of a case: `VirtualDrive(case).run()`."""

    def __init__(self, case: Case) -> None:
        """Create it at its first step."""
        self._case, brain_fleet = case, fleet_of(case)
        self._robot = EmulatedRobot(brain_fleet.scenario, case.drive, case.sensors, case.seed)
        self._brain = BrainSide(case, brain_fleet)
        self._record = Record()
        # The last one differs from those that the ports use.
        self._phase_s = phases(case.seed, len(SENDING) + 1)[-1] * STEP_S
        self._verdicts: dict[str, str] = {}
        plan = self._brain.plan
        self._record.turn_limit_s = 2 * math.pi / plan.max_turn_rate_rad_s + TURN_MARGIN_S

    def run(self) -> Record:
        """Run until all waypoints are complete or the time is over."""
        every = round(self._brain.simulation.step_s / STEP_S)
        steps = round((ARMED_S + self._case.limit_s) / STEP_S)
        for step in range(1, steps + 1):
            self._robot.step()
            for port, line in self._robot.lines():
                self._brain.add(port, line, self._robot.time_s)
            if step % every == 0:
                self._tick(self._robot.time_s + self._phase_s)
            if self._is_complete():
                break
        self._record.contacts = self._robot.contacts
        self._record.waypoints = len(self._verdicts)
        self._record.end_s = self._robot.time_s - ARMED_S
        return self._record

    def _is_complete(self) -> bool:
        return bool(self._verdicts) and set(self._verdicts.values()) == {"complete"}

    def _tick(self, time_s: float) -> None:
        if 0 <= time_s - ARMED_S < self._brain.simulation.step_s:
            self._brain.arm(time_s)
        lines = self._brain.tick(time_s)
        self._note_belief(time_s)
        for line in lines:
            self._robot.obey(line, time_s)
        if time_s >= ARMED_S:
            self._note_motion(time_s - ARMED_S, has_lines=bool(lines))
        self._note_verdicts(time_s)

    def _note_belief(self, time_s: float) -> None:
        belief = self._brain.belief()
        if self._brain.has_stepped and belief is not None:
            error_m = math.dist(belief[0], self._robot.place(time_s))
            self._record.beliefs.append((time_s - ARMED_S, error_m, belief[1]))

    def _note_motion(self, time_s: float, *, has_lines: bool) -> None:
        record = self._record
        left, right = self._robot.tracks()
        is_on_spot = left * right < 0
        record.motor_lines[0] += has_lines
        record.motor_lines[1] += has_lines and is_on_spot
        record.turns.add(time_s, is_turning=self._brain.motion.heading_rad is not None)
        record.spot_turns.add(time_s, is_turning=is_on_spot)
        if record.turn_fault_s is None and record.turns.longest_s > record.turn_limit_s:
            record.turn_fault_s = time_s

    def _note_verdicts(self, time_s: float) -> None:
        for goal in self._brain.team.new_verdicts():
            name, verdict = goal["goal"], goal["verdict"]
            if verdict == "complete" and self._verdicts.get(name) != "complete":
                distance_m = math.dist(goal["at_m"], self._robot.place(time_s))
                self._record.complete.append((name, time_s - ARMED_S, distance_m))
            if verdict == "impossible":
                self._record.given_up.add(name)
            self._verdicts[name] = verdict


def fleet_of(case: Case) -> fleet.Fleet:
    """Return the bundled fleet of one Bender with the scenario and the stated errors of a case."""
    text = fleet.fleets()["bender"].read_text(encoding="utf-8")
    text = text.replace('scenario = "bender"', f'scenario = "{case.scenario}"')
    values = {
        "robots.bender.count": 1,
        **{f"robots.bender.sensors.gps.{key}": each for key, each in case.sensors.stated().items()},
        "robots.bender.sensors.compass.noise_deg": case.sensors.noise_deg,
    }
    return fleet.loads(text, "bender.toml", overrides(values))


def limited(motion: Motion, plan: RobotPlan) -> Motion:
    """Return a motion within the limits of the robot, as the warden limits it."""
    speed_m_s, rate_rad_s = plan.max_speed_m_s, plan.max_turn_rate_rad_s
    return replace(
        motion,
        speed_m_s=max(-speed_m_s, min(speed_m_s, motion.speed_m_s)),
        turn_rate_rad_s=max(-rate_rad_s, min(rate_rad_s, motion.turn_rate_rad_s)),
    )
