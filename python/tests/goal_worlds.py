"""Random worlds with goals that a robot can reach, cannot reach, or can reach after a change."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from random import Random

from metric import world

from agent_economy import Scenario

WORLD = world("""
clock.time_limit_s = {time_limit_s}
world = {{ size_m = [30, 20], obstacles = [{obstacles}] }}
items.mine = {{ target = false, count = 1 }}
[robots.rover]
count = 1
radius_m = {radius_m}
start = {{ kind = "fixed", at_m = [{start}] }}
drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 120 }}
[robots.rover.sensors]
laser = {{ kind = "range", rays = 36, range_m = 6 }}
gps = {{ kind = "position", noise_m = {noise_m}, rate_hz = 5 }}
compass = {{ kind = "heading", noise_deg = 1, rate_hz = 5 }}
{sensors}
[robots.rover.brain]
rate_hz = 5
arbitration = {{ kind = "goals" }}
behaviours = [{{ kind = "navigate", waypoints_m = {waypoints}, within_m = 0.2 }}{avoid}]
beliefs.cell_m = 0.5
{parked}
""")
PARKED = """
[robots.waiting]
count = {count}
radius_m = 0.3
start = {{ kind = "fixed", at_m = {at} }}
drive = {{ max_speed_m_s = 1, max_acceleration_m_s2 = 1, max_turn_rate_deg_s = 90 }}
brain.behaviours = []
"""
EYE = 'kind = "robots", range_m = 6'
EYES = [
    "noise_m = 0.0",
    "noise_m = 0.3, dropout_probability = 0.3",
    "latency_s = 0.3, rate_hz = 2",
    "detection_probability = { peak = 0.7, half_range_m = 3 }",
]
TIME_LIMIT_S = 600.0
LATE_S = 250.0
"""When a door opens that has been closed since the start."""

Place = tuple[float, float]
Box = tuple[float, float, float, float]
"""x and y of the lower left corner, and of the upper right one, in metres."""


@dataclass
class World:
    """A world with waypoints; `count` of them, the first ones, are unreachable."""

    waypoints: list[Place]
    count: int = 1
    start: Place = (3.0, 10.0)
    boxes: list[Box] = field(default_factory=list)
    changes: list[tuple[float, list[Box]]] = field(default_factory=list)
    """Times in seconds, and the boxes from then on."""
    parked: list[Place] = field(default_factory=list)
    radius_m: float = 0.25
    eye: str = ""
    """The sensor of robots; without it, the robot detects none."""

    @property
    def time_limit_s(self) -> float:
        """Return the time limit: a goal may be tried again some minutes after the last change."""
        return TIME_LIMIT_S + max([0.0, *(time_s for time_s, _ in self.changes)])

    @property
    def next_change_s(self) -> float:
        """Return the time of the next change."""
        return self.changes[0][0] if self.changes else math.inf

    def scenario(self, random: Random) -> Scenario:
        """Return its scenario, with random noise and with or without *avoid*."""
        parked = PARKED.format(count=len(self.parked), at=[list(at) for at in self.parked])
        text = WORLD.format(
            time_limit_s=self.time_limit_s,
            obstacles=", ".join(f"{{ polygon_m = {corners(box)} }}" for box in self.boxes),
            radius_m=self.radius_m,
            start=list(self.start),
            noise_m=random.choice([0.02, 0.1]),
            sensors=f"eye = {{ {self.eye} }}" if self.eye else "",
            waypoints=[list(at) for at in self.waypoints],
            avoid=random.choice(["", ', { kind = "avoid" }']),
            parked=parked if self.parked else "",
        )
        return Scenario.loads(text)


def corners(box: Box) -> list[list[float]]:
    """Return the corners of a box."""
    left, low, right, high = box
    return [[left, low], [right, low], [right, high], [left, high]]


def block(random: Random) -> World:
    """Return a world with a place inside a block, up to 1 m from its surface."""
    left, low = random.uniform(10, 18), random.uniform(3, 10)
    right, high = left + random.uniform(2, 5), low + random.uniform(2, 5)
    inside_m = random.choice([0.1, 0.3, 0.6, 1.0])
    place = (left + inside_m, random.uniform(low + inside_m, high - inside_m))
    if random.random() < 0.5:
        place = (right - inside_m, place[1])
    return World([place, (26.0, 4.0)], boxes=[(left, low, right, high)])


def room(random: Random, door_m: float = 0.0) -> World:
    """Return a world with a place in a room, with a door in the wall at its left or without."""
    left, low = random.uniform(9, 16), random.uniform(2, 9)
    right, high = left + random.uniform(3, 8), low + random.uniform(3, 8)
    middle = random.uniform(low + 1, high - 1)
    wall_m = 0.4
    boxes = [
        (left, low, left + wall_m, middle - door_m / 2),
        (left, middle + door_m / 2, left + wall_m, high),
        (left, low, right, low + wall_m),
        (left, high - wall_m, right, high),
        (right - wall_m, low, right, high),
    ]
    place = ((left + right) / 2, (low + high) / 2)
    return World([place, (27.0, 18.0)], boxes=boxes)


def door(random: Random) -> World:
    """Return a world with a place in a room with a door that is narrower than the robot."""
    radius_m = random.uniform(0.2, 0.4)
    world = room(random, 2 * radius_m * random.uniform(0.5, 0.95))
    world.radius_m = radius_m
    return world


def corner(random: Random) -> World:
    """Return a world with a place in a corner of it."""
    place = (random.choice([0.1, 29.9]), random.choice([0.1, 19.9]))
    return World([place, (15.0, 10.0)], radius_m=0.3)


def aisle(random: Random) -> World:
    """Return a world with a place at the end of an aisle that a parked robot blocks."""
    width_m, length_m = random.uniform(0.8, 1.3), random.uniform(6, 12)
    left, low = random.uniform(8, 14), random.uniform(6, 13)
    right, high = left + length_m, low + width_m
    boxes = [
        (left, low - 0.5, right, low),
        (left, high, right, high + 0.5),
        (right, low - 0.5, right + 0.5, high + 0.5),
    ]
    middle = (low + high) / 2
    return World(
        [(right - 1.0, middle), (26.0, 2.0)],
        boxes=boxes,
        parked=[(left + random.uniform(1.0, length_m - 2.5), middle)],
        eye=EYE if random.random() < 0.5 else "",
    )


def wide_aisle(random: Random) -> World:
    """Return a world with a place at the end of a wide aisle with one or two parked robots."""
    width_m, left, low = random.uniform(1.6, 2.0), random.uniform(8, 20), random.uniform(4, 13)
    middle, aside_m = low + width_m / 2, random.uniform(0, 0.2)
    first_m = left + random.uniform(1, 3)
    parked = [(first_m, middle + aside_m), (first_m + 1.5, middle - aside_m)]
    gap_m = width_m / 2 + aside_m - 0.3
    return World(
        [(29.0, middle), (3.0, 2.0)],
        boxes=[(left, 0.0, 30.0, low), (left, low + width_m, 30.0, 20.0)],
        parked=parked[: random.randint(1, 2)],
        radius_m=gap_m / 2 * random.uniform(1.05, 1.4),
        eye=f"{EYE}, {random.choice(EYES)}",
    )


def blocks(random: Random) -> World:
    """Return a world of random blocks with reachable places."""
    boxes = []
    for _ in range(random.randint(6, 14)):
        left, low = random.uniform(5, 24), random.uniform(1, 16)
        boxes.append((left, low, left + random.uniform(0.5, 5), low + random.uniform(0.5, 3)))
    return World(list(free_places(random, boxes, 6)), 0, boxes=boxes)


def maze(random: Random) -> World:
    """Return a world of walls across it, each with a gap at one end, and reachable places."""
    gap_m = random.uniform(1.2, 2.0)
    boxes = []
    for number, left in enumerate(range(6, 28, random.choice([4, 6, 9]))):
        is_up = (number + random.randint(0, 1)) % 2
        low, high = (0.0, 20.0 - gap_m) if is_up else (gap_m, 20.0)
        boxes.append((float(left), low, left + 0.4, high))
    return World([(28.5, 10.0), (3.0, 3.0)], 0, boxes=boxes)


def trap(random: Random) -> World:
    """Return a world with a dead end that opens towards the robot, before a reachable place."""
    width_m, depth_m = random.uniform(4, 12), random.uniform(3, 9)
    left, low = random.uniform(8, 12), 10 - width_m / 2
    boxes = [
        (left, low, left + depth_m, low + 0.4),
        (left, low + width_m, left + depth_m, low + width_m + 0.4),
        (left + depth_m, low, left + depth_m + 0.4, low + width_m + 0.4),
    ]
    return World([(left + depth_m + random.uniform(1.5, 5), 10.0), (3.0, 10.0)], 0, boxes=boxes)


def doors(random: Random) -> World:
    """Return a world with a place in a room with a door that the robot fits through."""
    world = room(random, random.uniform(1.2, 1.6))
    world.count = 0
    return world


def late_door(random: Random) -> World:
    """Return a world with a place in a room with a door that opens late."""
    world = doors(random)
    return opening(world, [gap(world.boxes)])


def late_gate(random: Random) -> World:
    """Return a world with a place behind a wall across it with gates, of which one opens late."""
    left, thick_m = random.uniform(9, 16), random.uniform(0.3, 2.5)
    count = random.randint(2, 4)
    levels = [20.0 * (gate + 0.5) / count + random.uniform(-1, 1) for gate in range(count)]
    ends = [0.0, *(level + side for level in levels for side in (-0.7, 0.7)), 20.0]
    walls = [
        (left, low, left + thick_m, high) for low, high in zip(ends[::2], ends[1::2], strict=True)
    ]
    gates = [(left, level - 0.7, left + thick_m, level + 0.7) for level in levels]
    last = gates.pop(random.randrange(count))
    place = (left + thick_m + random.uniform(2, 6), random.uniform(3, 17))
    return opening(World([place, (4.0, random.uniform(2, 18))], 0, boxes=[*walls, *gates]), [last])


def late_exit(random: Random) -> World:
    """Return a world with a robot in a room with a door that opens late, and a place outside."""
    world = late_door(random)
    world.start, world.waypoints = world.waypoints[0], [(3.0, random.uniform(2, 18))]
    return world


def late_doors(random: Random) -> World:
    """Return a world with a place behind two doors, of which the inner one opens last."""
    world = doors(random)
    left = world.boxes[0][0] - 2.5
    gate = (left, 16.0, left + 0.4, 17.5)
    world.boxes += [(left, 0.0, left + 0.4, 16.0), (left, 17.5, left + 0.4, 20.0)]
    world.waypoints[1] = (3.0, random.uniform(2, 8))
    return opening(world, [gate], [gap(world.boxes)])


def busy_door(random: Random) -> World:
    """Return a world with a place in a room with a door that closes and opens several times."""
    world = late_door(random)
    closed, (_, opened) = world.boxes, world.changes[0]
    first_s = random.uniform(2, 12)
    world.boxes = opened
    world.changes = [(first_s, closed), (120.0, opened), (125.0, closed), (LATE_S, opened)]
    return world


def left_box(random: Random) -> World:
    """Return a world with a place under a box that leaves late."""
    left, low = random.uniform(9, 20), random.uniform(4, 12)
    width_m, depth_m = random.uniform(0.4, 3), random.uniform(0.4, 3)
    box = (left, low, left + width_m, low + depth_m)
    place = (left + width_m / 2, low + depth_m / 2)
    return opening(World([place, (27.0, 18.0)], 0), [box])


def opening(world: World, *doors: list[Box]) -> World:
    """Return a world with further boxes, which are removed in turn, at long intervals."""
    left = [box for each in doors for box in each]
    walls = world.boxes
    world.boxes = walls + left
    for number, each in enumerate(doors):
        left = [box for box in left if box not in each]
        world.changes.append((LATE_S * (number + 1), walls + left))
    return world


def gap(boxes: list[Box]) -> Box:
    """Return the gap between the first two of some boxes, which are the parts of a wall."""
    (left, _, right, low), (_, high, _, _) = boxes[:2]
    return (left, low, right, high)


def free_places(random: Random, boxes: list[Box], count: int) -> Iterator[Place]:
    """Yield places at least 1 m from all boxes; among random boxes, one may be enclosed."""
    while count:
        at = (random.uniform(1, 29), random.uniform(1, 19))
        if all(distance_m(at, box) >= 1 for box in boxes):
            count -= 1
            yield at


def distance_m(at: Place, box: Box) -> float:
    """Return the distance of a place from a box."""
    left, low, right, high = box
    return math.hypot(max(left - at[0], 0.0, at[0] - right), max(low - at[1], 0.0, at[1] - high))


UNREACHABLE: dict[str, Callable[[Random], World]] = {
    "inside a block": block,
    "closed room": room,
    "door narrower than the robot": door,
    "corner of the world": corner,
    "aisle with a parked robot": aisle,
    "wide aisle with parked robots": wide_aisle,
}
REACHABLE: dict[str, Callable[[Random], World]] = {
    "blocks": blocks,
    "maze": maze,
    "dead end": trap,
    "room with a door": doors,
}
CHANGING: dict[str, Callable[[Random], World]] = {
    "room with a door that opens": late_door,
    "wall with a gate that opens": late_gate,
    "door that opens to the outside": late_exit,
    "two doors that open in turn": late_doors,
    "door that closes and opens again": busy_door,
    "box that leaves": left_box,
}


def random_world(family: str, number: int) -> tuple[World, Scenario]:
    """Return a world of a family, and a scenario of it with random noise, the same each time."""
    random = Random(f"{family} {number}")  # noqa: S311
    world = {**UNREACHABLE, **REACHABLE, **CHANGING}[family](random)
    return world, world.scenario(random)
