"""Measure and draw docs/economy.md: what controllers and rules of allocation are worth.

The measurements are in docs/economy/cases.csv; the tables of the page are between `<!-- NAME -->`
and `<!-- end -->`. Examples:

    python scripts/economy.py          run everything; write CSV, pictures and page
    python scripts/economy.py --draw   only pictures and page, from the CSV
    python scripts/economy.py --check  exit with 1 if pictures or page are stale
"""

import math
import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields
from itertools import groupby, product
from typing import Any

import numpy as np
from measured import ROOT, Page, table
from plots import Axes, Row, Spec, connected, interval, page_of, panel
from scipy import stats

import agent_economy as ae

PAGE = Page("economy")

SEED = 0

MISSION_S = 240.0
"""About the length of a mission of eight robots, in which a share of them is to fail."""

ROBOTS = "robots.rover.count"
CONTROLLERS = "controllers.base.count"
RULE = "controllers.base.allocation"
BEHAVIOURS = "robots.rover.brain.behaviours"
LOSS = ("robots.rover.radio.loss_probability", "controllers.base.radio.loss_probability")
BANDWIDTH = ("robots.rover.radio.messages_per_step", "controllers.base.radio.messages_per_step")
FAILURES = "robots.rover.mean_time_between_failures_s"
CONTROLLER_FAILURES = "controllers.base.mean_time_between_failures_s"
LOST = {CONTROLLER_FAILURES: MISSION_S}
SELDOM_LOST = {CONTROLLER_FAILURES: 5 * MISSION_S}
LEASE = "controllers.base.service_lease_s"
START = "robots.rover.start"

Changes = dict[str, Any]

WAYPOINTS = ae.Scenario.load(ROOT / "scenarios" / "waypoints.toml")
NAVIGATE, SERVE, AVOID = WAYPOINTS.to_dict()["robots"]["rover"]["brain"]["behaviours"]

ONLY_SERVE = {BEHAVIOURS: [SERVE, AVOID]}

SEARCH = (ROOT / "scenarios" / "search-beliefs.toml").read_text(encoding="utf-8")

AREAS = """
[end]
when = "missed == 0"

[goals.area]
count = 9
work = "search"
within_m = 6
placement = { kind = "fixed", at_m = [
    [4, 4], [12.5, 4], [21, 4], [4, 12.5], [12.5, 12.5], [21, 12.5], [4, 21], [12.5, 21], [21, 21],
] }

[controllers.base]
count = 1
start = { kind = "fixed", at_m = [[12.5, 12.5]] }
radio = { range_m = 60, messages_per_step = 20 }

[study]"""
"""Nine areas that cover the field of the search, and a controller that owns them."""

SEARCH_IN_AREAS = SEARCH.replace("[study]", AREAS).replace(
    '{ kind = "bayesian_search" },', '{ kind = "bayesian_search" }, { kind = "serve" },'
)
AREA_SEARCH = ae.Scenario.loads(SEARCH_IN_AREAS, "search-beliefs.toml")
BAYESIAN, _, HOME, _ = AREA_SEARCH.to_dict()["robots"]["rover"]["brain"]["behaviours"]
ONE_AREA = SERVE | {"max_goals": 1}
AWARDED = {BEHAVIOURS: [ONE_AREA, HOME, AVOID]}

TEXT = (ROOT / "scenarios" / "waypoints.toml").read_text(encoding="utf-8")
SHORT_RADIOS = ae.Scenario.loads(TEXT.partition("[study]")[0], "waypoints.toml")
"""The waypoints, without a study of a single controller, for which trade is refused."""

BACKUP, TRADE = "controllers.base.backup", "controllers.base.trade"
ALONE: Changes = {BACKUP: "none"}
TRADING: Changes = {TRADE: {}}

TEAMS: dict[str, Changes] = {
    "1": {CONTROLLERS: 1},
    "2": {CONTROLLERS: 2},
    "2, trade": {CONTROLLERS: 2, **TRADING},
    "2 alone, trade": {CONTROLLERS: 2, **ALONE, **TRADING},
    "3, trade": {CONTROLLERS: 3, **TRADING},
}
"""Controllers whose radios, and those of robots, are short."""

HALF = """
[goals.NAME]
count = 30
owner = "OWNER"
requires = "NAME"
within_m = 1
service_s = 5
placement = { kind = "uniform", within_m = [[FROM, 5], [TO, 95]] }

[robots.NAME]
count = 4
capabilities = ["NAME"]
radius_m = 0.3
start = { kind = "uniform", within_m = [[START, 40], [END, 60]] }
drive = { max_speed_m_s = 2, max_acceleration_m_s2 = 2, max_turn_rate_deg_s = 120 }
radio = { range_m = 130, messages_per_step = 20, loss_probability = 0.02 }
sensors = { gps = { kind = "position" }, compass = { kind = "heading" } }
brain = { behaviours = [{ kind = "serve" }] }

[controllers.NAME_base]
count = 0
start = { kind = "fixed", at_m = [[CENTRE, 50]] }
radio = { range_m = 400, messages_per_step = 20, loss_probability = 0.02 }
"""
"""A half of a field, whose robots reach only the controller in it."""


def half(name: str, start_m: int) -> str:
    """Return a half of the field that begins there."""
    ends = {"FROM": 5, "TO": 95, "START": 40, "END": 60, "CENTRE": 50}
    text = HALF.replace("NAME", name).replace("OWNER", "base")
    for word, along_m in ends.items():
        text = text.replace(word, str(start_m + along_m))
    return text


FIELD = """
engine = "metric"
summary = "Two halves of a field."
merit = { time = -0.01 }
clock = { step_s = 0.2, time_limit_s = 600 }
world = { size_m = [300, 100] }

[controllers.base]
count = 2
start = { kind = "fixed", at_m = [[50, 50], [250, 50], [150, 50]] }
radio = { range_m = 400, messages_per_step = 20, loss_probability = 0.02 }
"""
HALVES = ae.Scenario.loads(FIELD + half("west", 0) + half("east", 200), "halves.toml")

DEALS: dict[str, Changes] = {
    "right deal": {
        CONTROLLERS: 0,
        "controllers.west_base.count": 1,
        "controllers.east_base.count": 1,
        "goals.west.owner": "west_base",
        "goals.east.owner": "east_base",
    },
    "no trade": {},
    "trade": TRADING,
    "trade, alone": {**TRADING, **ALONE},
}
"""Goals of two halves of a field that are dealt to the right controller, or to two in turn."""

SEARCHES: dict[str, Changes] = {
    "random": {CONTROLLERS: 0, BEHAVIOURS: [{"kind": "random_bounce"}, HOME, AVOID]},
    "messages": {CONTROLLERS: 0, BEHAVIOURS: [BAYESIAN, HOME, AVOID]},
    "nearest": {RULE: "nearest", **AWARDED},
    "auction": {RULE: "auction", **AWARDED},
    "optimal": {RULE: "optimal", **AWARDED},
    "auction and messages": {BEHAVIOURS: [BAYESIAN, ONE_AREA, HOME, AVOID]},
}
"""The same for the search: robots that search at random, or share what they find; and awards."""

RULES: dict[str, Changes] = {
    "messages": {CONTROLLERS: 0},
    "nearest": {RULE: "nearest", **ONLY_SERVE},
    "auction": {RULE: "auction", **ONLY_SERVE},
    "auction_last": {RULE: "auction_last", **ONLY_SERVE},
    "optimal": {RULE: "optimal", **ONLY_SERVE},
    "fixed plan": {LEASE: 3600, BEHAVIOURS: [SERVE | {"max_goals": 64}, AVOID]},
    "auction and messages": {RULE: "auction"},
}
"""Rules of allocation: without controllers; with one, whose awards are all robots do; and both.

A fixed plan is an auction of all goals at the start, with leases that outlast the mission.
"""


RULES_OF = {
    id(WAYPOINTS): RULES,
    id(AREA_SEARCH): SEARCHES,
    id(SHORT_RADIOS): TEAMS,
    id(HALVES): DEALS,
}
"""The rows of the tables, by scenario."""


@dataclass(frozen=True)
class Case:
    """A table of the page: a number that varies, by rule."""

    name: str
    rules: tuple[str, ...]
    varied: str
    numbers: tuple[float, ...]
    changes: Callable[[Any], Changes]
    scenario: ae.Scenario = WAYPOINTS
    runs: int = 100

    def all_changes(self, rule: str, number: float) -> Changes:
        """Return what differs from the scenario for a rule and a number."""
        return RULES_OF[id(self.scenario)][rule] | self.changes(number)


@dataclass(frozen=True)
class Result:
    """Means of the runs of one scenario, with standard errors of the time."""

    case: str
    rule: str
    number: float
    runs: int
    time_s: float
    time_error_s: float
    complete: float
    served: float
    served_twice: float
    waiting_s: float
    travel_s: float
    blocked_s: float
    service_s: float
    distance_m: float
    messages_sent: float
    messages_dropped: float


def failing(share: float) -> Changes:
    """Return failures that stop a share of the robots during a mission, on average."""
    return {FAILURES: -MISSION_S / math.log(1 - share)} if share > 0 else {}


def narrow(messages: int) -> Changes:
    """Return radios of sixteen robots and of controllers that send few messages per step."""
    return {ROBOTS: 16, **dict.fromkeys(BANDWIDTH, messages)}


def crowd(robots: int) -> Changes:
    """Return a team that starts anywhere: the start area of the scenario is too small for it."""
    return {ROBOTS: robots, START: {"kind": "uniform"}}


def short(range_m: float) -> Changes:
    """Return robots that only serve, and radios of a range."""
    ranges = dict.fromkeys(
        ("robots.rover.radio.range_m", "controllers.base.radio.range_m"), range_m
    )
    return {**ONLY_SERVE, **ranges}


def dense(goals: int) -> Changes:
    """Return a number of goals in each half."""
    return {"goals.west.count": goals, "goals.east.count": goals}


TWO = ("messages", "auction", "auction and messages")
AWARDING = ("auction", "auction and messages")
LASTING = ("messages", "auction", "fixed plan", "auction and messages")
SHARES = (0, 0.1, 0.2, 0.3, 0.4, 0.5)
LOSSES = (0, 0.1, 0.3, 0.5, 0.7, 0.9)

CASES = [
    Case("rules", tuple(RULES), "robots", (2, 4, 8, 16, 32), lambda n: {ROBOTS: n}),
    Case("failures", LASTING, "share of robots lost", SHARES, failing),
    Case("loss", TWO, "lost messages", LOSSES, lambda p: dict.fromkeys(LOSS, p)),
    Case("bandwidth", TWO, "messages per step", (2, 4, 8, 16, 32), narrow),
    Case("controllers", AWARDING, "controllers", (1, 2, 3), lambda n: {CONTROLLERS: n}),
    Case(
        "lost_controllers", AWARDING, "controllers", (1, 2, 3), lambda n: {CONTROLLERS: n, **LOST}
    ),
    Case(
        "seldom_lost",
        ("auction",),
        "controllers",
        (1, 2, 3),
        lambda n: {CONTROLLERS: n, **SELDOM_LOST},
        runs=400,
    ),
    Case(
        "short_radios", tuple(TEAMS), "radio range in m", (130, 160, 200), short, SHORT_RADIOS, 50
    ),
    Case("halves", tuple(DEALS), "goals in each half", (20, 30, 50), dense, HALVES, 50),
    Case("crowd", ("messages", "auction"), "robots", (1, 10, 100, 300, 1000), crowd, runs=5),
    Case("search", tuple(SEARCHES), "robots", (1, 2, 4, 8, 16), lambda n: {ROBOTS: n}, AREA_SEARCH),
]


def main() -> None:
    """Measure, draw or check."""
    if not {"--check", "--draw"} & set(sys.argv[1:]):
        PAGE.write("cases", Result, measured())
    PAGE.draw(of_case, specifications())


def measured() -> Iterator[Result]:
    """Yield the means of each case, rule and number, all in the same worlds."""
    for case in CASES:
        for rule, number in product(case.rules, case.numbers):
            scenario = case.scenario
            for path, value in case.all_changes(rule, number).items():
                scenario = scenario.replace(path, value)
            yield result(case, rule, number, ae.replicate(scenario, case.runs, SEED))


def result(case: Case, rule: str, number: float, runs: Any) -> Result:
    """Return the means of the runs of a scenario."""
    names = {each.name for each in fields(Result)}.intersection(runs.column_names)
    means = {name: np.mean(runs[name]) for name in names}
    error_s = stats.sem(runs["time_s"])
    return Result(case.name, rule, number, case.runs, time_error_s=error_s, **means)


# Tables.


def read(name: str) -> tuple[Case, list[Result]]:
    """Return a case with its results."""
    (case,) = (each for each in CASES if each.name == name)
    return case, [each for each in PAGE.read("cases", Result) if each.case == name]


def of_case(name: str) -> str:
    """Return the table CASE, of times, or CASE_CELL: a row per rule, a column per number."""
    first, _, last = name.rpartition("_")
    case, own = read(first if last in CELLS else name)
    cell = CELLS.get(last, seconds)
    lines = ([rule, *map(cell, each)] for rule, each in groupby(own, lambda each: each.rule))
    return table([case.varied, *(f"{number:g}" for number in case.numbers)], lines)


def seconds(each: Result) -> str:
    """Return the time of a mission with its 95% interval."""
    text = interval(each.time_s, each.time_error_s, 0)
    return text if each.complete == 1 else f"{text} ({each.complete:.0%} complete)"


def split(each: Result) -> str:
    """Return the parts of the time of a goal."""
    parts = (each.waiting_s, each.travel_s, each.blocked_s, each.service_s)
    return " + ".join(f"{part:.1f}" for part in parts)


def radio(each: Result) -> str:
    """Return how many messages were sent, and the share of received ones that was dropped."""
    return f"{each.messages_sent:,.0f}, {each.messages_dropped:,.0f} dropped"


CELLS: dict[str, Callable[[Result], str]] = {
    "time": seconds,
    "twice": lambda each: f"{each.served_twice:.1f}",
    "served": lambda each: f"{each.served:.1f}",
    "distance": lambda each: f"{each.distance_m:,.0f}",
    "split": split,
    "radio": radio,
}


# Pictures.


def specifications() -> dict[str, Spec]:
    """Return each picture's specification by its name."""
    title = "mean time until all are served, s"
    return {
        "rules": drawn("rules", title, lambda each: (each.time_s, each.time_error_s), log=True),
        "failures": drawn("failures", "goals served, of 60", lambda each: (each.served, 0.0)),
    }


def drawn(
    name: str, title: str, number: Callable[[Result], tuple[float, float]], *, log: bool = False
) -> Spec:
    """Return a number of a case by what varies, with a curve for each rule."""
    case, own = read(name)
    some = [Row(each.rule, each.number, *number(each), None) for each in own]
    axes = Axes("log" if log else "linear", x_ticks=case.numbers)
    return page_of(panel(connected(some), case.varied, title, width=520, axes=axes))


if __name__ == "__main__":
    main()
