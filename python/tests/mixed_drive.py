"""A real Bender and a simulated robot that meet, in virtual time; and the same, all simulated.

The real robot is the emulator's, with the lines of its ports and its motor lines. The drive has a
simulated robot that the emulator does not know, and that the real one perceives by a virtual
sensor.
"""

import math
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from imperfect_robot import ROBOT, DriveErrors, EmulatedRobot, SensorErrors
from virtual_drive import ARMED_S, MOTOR_PERIOD_S

from agent_economy.live import fleet
from agent_economy.live.drivers import DRIVERS, PortLine
from agent_economy.live.emulator.world import STEP_S
from agent_economy.live.external import bodies_of
from agent_economy.live.frame import frame_of
from agent_economy.live.line_readings import LineReadings
from agent_economy.live.loop.team import Team
from agent_economy.live.readings import Motion
from agent_economy.live.warden.motor_line import MotorLines
from agent_economy.runs.brain import Command
from agent_economy.runs.simulation import Simulation
from agent_economy.scenario import Scenario

OTHER = "walker/0"
RADIUS_M, OTHER_RADIUS_M = 0.4, 0.3
SPEED_M_S = 0.6

STAND: Command = {"motion": {"speed_m_s": 0.0, "turn_rate_rad_s": 0.0}}  # type: ignore[typeddict-item]

SCENARIO = """
engine = "metric"
merit = "equation-5.2"
summary = "A real robot and a simulated one meet."
clock = {{ step_s = 0.1, time_limit_s = 240 }}
world = {{ size_m = [40, 30], origin = {{ latitude_deg = 36.595267, longitude_deg = -121.875003, \
declination_deg = 14.5 }} }}

[robots.walker]
count = 1
radius_m = {other_radius_m}
start = {{ kind = "fixed", at_m = [[{x_m}, {y_m}]], heading_deg = [{heading_deg}] }}
drive = {{ max_speed_m_s = {other_m_s}, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 60 }}
sensors.lidar = {{ kind = "range", rays = 72, range_m = 6, noise_m = 0.03 }}
brain.behaviours = [{{ kind = "cruise" }}{other_avoids}]

[robots.bender]
count = 1
radius_m = {radius_m}
start = {{ kind = "fixed", at_m = [[5, 15]], heading_deg = [0] }}
drive = {{ max_speed_m_s = {m_s}, max_reverse_speed_m_s = {m_s}, max_acceleration_m_s2 = 1, \
max_turn_rate_deg_s = 60 }}
brain = {{ rate_hz = 5, behaviours = [{{ kind = "cruise" }}, {{ kind = "avoid", near_m = 1 }}] }}
sensors.lidar = {{ kind = "range", rays = 72, range_m = 6, noise_m = 0.03 }}
sensors.gps = {{ kind = "position", noise_m = {noise_m}, rate_hz = 1 }}
sensors.compass = {{ kind = "heading", noise_deg = 1, rate_hz = 10 }}
"""

SONARS = {0: 20, 1: -20, 2: -140, 3: 140, 4: -90, 5: 90}
SONAR = """
[robots.bender.sensors.sonar_{number}]
kind = "range"
rays = 1
fov_deg = 0
facing_deg = {facing_deg}
range_m = 6
noise_m = 0.03
rate_hz = 5
"""


@dataclass(frozen=True)
class Meeting:
    """How a simulated robot reaches a place ahead of the real one.

    Attributes:
        heading_deg: Its heading.
        speed_m_s: Its maximum speed; at 0, it is there from the start.
        ahead_m: The distance of that place from the start of the real one.
        noise_m: Standard deviation of positions of the real one.
        avoids: Whether the simulated one avoids what is near, as the real one does.
        seed: Seed of all random numbers.
    """

    heading_deg: float
    speed_m_s: float
    ahead_m: float
    noise_m: float
    avoids: bool
    seed: int

    def scenario(self) -> Scenario:
        """Return the scenario in which they arrive together."""
        way_m = self.speed_m_s * self.ahead_m / SPEED_M_S
        heading_rad = math.radians(self.heading_deg)
        text = SCENARIO.format(
            x_m=5 + self.ahead_m - way_m * math.cos(heading_rad),
            y_m=15 - way_m * math.sin(heading_rad),
            heading_deg=self.heading_deg,
            other_m_s=self.speed_m_s,
            other_radius_m=OTHER_RADIUS_M,
            radius_m=RADIUS_M,
            m_s=SPEED_M_S,
            noise_m=self.noise_m,
            other_avoids=', { kind = "avoid", near_m = 1 }' if self.avoids else "",
        )
        sonars = (
            SONAR.format(number=number, facing_deg=facing) for number, facing in SONARS.items()
        )
        return Scenario.loads(text + "".join(sonars), "meeting.toml")

    def fleet(self, folder: Path) -> fleet.Fleet:
        """Return the fleet of the real robot."""
        (folder / "meeting.toml").write_text(self.scenario().source.text, encoding="utf-8")
        text = (
            'scenario = "meeting.toml"\n'
            '[robots."bender/0"]\ndriver = "bender"\nhost = "127.0.0.1"\n'
            '[robots."bender/0".settings]\nno_echo = 99.0\n'
        )
        file = folder / "fleet.toml"
        file.write_text(text, encoding="utf-8")
        return fleet.load(file)


@dataclass
class Track:
    """Where both robots were at equal times from the start of their motion.

    Attributes:
        path_m: Places of the real robot, or of the one in its place.
        other_path_m: Places of the other.
    """

    path_m: list[tuple[float, float]] = field(default_factory=list)
    other_path_m: list[tuple[float, float]] = field(default_factory=list)

    def stop_m(self) -> tuple[float, float] | None:
        """Return where the robot first slowed down to half of its speed; None if nowhere."""
        ways = zip(self.path_m, self.path_m[2:], strict=False)
        speeds = [math.dist(before, after) / 0.2 for before, after in ways]
        moving = next((step for step, each in enumerate(speeds) if each > 0.9 * SPEED_M_S), None)
        if moving is None:
            return None
        slow = (step for step in range(moving, len(speeds)) if speeds[step] < 0.5 * SPEED_M_S)
        step = next(slow, None)
        return None if step is None else self.path_m[step + 2]

    def gap_m(self) -> float:
        """Return the smallest distance between their footprints."""
        pairs = zip(self.path_m, self.other_path_m, strict=True)
        return min(math.dist(*pair) for pair in pairs) - RADIUS_M - OTHER_RADIUS_M


def simulated(meeting: Meeting, limit_s: float) -> Track:
    """Return the meeting of two simulated robots."""
    simulation = Simulation(meeting.scenario(), seed=meeting.seed, threads=1)
    track = Track()
    for _ in range(round(limit_s / simulation.step_s)):
        note(track, simulation, place_of(simulation, ROBOT))
        simulation.step()
    return track


def mixed(meeting: Meeting, limit_s: float, folder: Path) -> Track:
    """Return the meeting of a real robot and a simulated one."""
    loaded = meeting.fleet(folder)
    plan = loaded.plan
    simulation = Simulation(loaded.scenario, seed=meeting.seed, threads=1, external=bodies_of(plan))
    team = Team(plan, simulation, {}, seed=meeting.seed, start_s=0.0)
    errors = SensorErrors(noise_m=meeting.noise_m, noise_deg=1.0)
    robot = EmulatedRobot(loaded.scenario, DriveErrors(), errors, meeting.seed)
    motors = MotorLines(
        DRIVERS["bender"], plan.robots[0].settings, frame_of(plan.origin), MOTOR_PERIOD_S - 1e-6
    )
    readings, track = LineReadings(plan), Track()
    every = round(simulation.step_s / STEP_S)
    for step in range(1, round((ARMED_S + limit_s) / STEP_S) + 1):
        robot.step()
        for port, line in robot.lines():
            message = {"robot": ROBOT, "port": port, "t": robot.time_s}
            reading = readings.of(message | {"line": line.decode("latin-1")})
            if reading is not None:
                team.add(reading)
        if step % every:
            continue
        time_s = robot.time_s
        if time_s >= ARMED_S:
            if not track.path_m:
                team.add(armed(time_s))
            note(track, simulation, robot.place(time_s))
        for motor_line in tick(team, simulation, motors, time_s):
            robot.obey(motor_line, time_s)
    return track


def tick(
    team: Team, simulation: Simulation, motors: MotorLines, time_s: float
) -> tuple[PortLine, ...]:
    """Take a step of the loop; return the motor lines that are due. Both stand before arming."""
    percepts = team.percepts(simulation.tick, time_s)
    observed = team.observed(simulation.tick, time_s)
    others = {} if time_s >= ARMED_S else {OTHER: STAND}
    commands = simulation.step(percepts=percepts, observed=observed, commands=others)
    motion = Motion(*team.motions(commands)[ROBOT])
    return motors.due(motion, time_s, is_empty=True)


def armed(time_s: float) -> dict[str, object]:
    """Return the event of a robot that may drive."""
    lists: dict[str, object] = {key: [] for key in ("faults", "latched", "blockers", "warnings")}
    event = {"type": "event", "t": time_s, "robot": ROBOT, "action": "move", "mode": "auto"}
    return event | lists | {"is_armed": True, "is_confirmed": False, "reasons": {}}


def note(track: Track, simulation: Simulation, place_m: tuple[float, float]) -> None:
    """Note where both robots are."""
    track.path_m.append(place_m)
    track.other_path_m.append(place_of(simulation, OTHER))


def place_of(simulation: Simulation, robot: str) -> tuple[float, float]:
    """Return the position of a robot in a run."""
    x_m, y_m, _ = simulation.poses[simulation.robots.index(robot)]
    return float(x_m), float(y_m)


def meetings(count: int, noise_m: float, *, avoids: bool, seed: int = 1) -> list[Meeting]:
    """Return meetings at random angles; in one of four, the simulated robot stands."""
    random = np.random.default_rng(seed)
    return [
        Meeting(
            heading_deg=round(float(random.uniform(-180, 180)), 3),
            speed_m_s=0.0 if number % 4 == 0 else 0.4,
            ahead_m=round(float(random.uniform(4, 7)), 3),
            noise_m=noise_m,
            avoids=avoids,
            seed=number,
        )
        for number in range(count)
    ]
