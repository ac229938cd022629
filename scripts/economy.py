"""Measure and draw docs/economy.md: what controllers and rules of allocation are worth.

The measurements are in docs/economy/cases.csv; the tables of the page are between `<!-- NAME -->`
and `<!-- end -->`. Examples:

    python scripts/economy.py          run everything; write CSV, pictures and page
    python scripts/economy.py --draw   only pictures and page, from the CSV
    python scripts/economy.py --check  exit with 1 if pictures or page are stale
"""

import csv
import math
import sys
import time
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, fields
from typing import Any, get_type_hints

import numpy as np
from page import ROOT, Page, table
from plots import Z95, Axes, Row, Spec, line, page_of, panel, points, values

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
    "optimal": {RULE: "optimal", **ONLY_SERVE},
    "fixed plan": {LEASE: 3600, BEHAVIOURS: [SERVE | {"max_goals": 64}, AVOID]},
    "auction and messages": {RULE: "auction"},
}
"""Rules of allocation: without controllers; with one, whose awards are all robots do; and both.

A fixed plan is an auction of all goals at the start, with leases that outlast the mission.
"""


@dataclass(frozen=True)
class Case:
    """A table of the page: a number that varies, by rule."""

    name: str
    runs: int
    rules: tuple[str, ...]
    varied: str
    numbers: tuple[float, ...]
    changes: Callable[[float], Changes]
    scenario: ae.Scenario = WAYPOINTS

    def all_changes(self, rule: str, number: float) -> Changes:
        """Return what differs from the scenario for a rule and a number."""
        rules = RULES if self.scenario is WAYPOINTS else SEARCHES
        return rules[rule] | self.changes(number)


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


def both(keys: tuple[str, str], value: float) -> Changes:
    """Return a change of robots and controllers."""
    return dict.fromkeys(keys, value)


def failing(share: float) -> Changes:
    """Return failures that stop a share of the robots during a mission, on average."""
    return {FAILURES: -MISSION_S / math.log(1 - share)} if share > 0 else {}


def crowd(robots: float) -> Changes:
    """Return a team that starts anywhere: the start area of the scenario is too small for it."""
    return {ROBOTS: int(robots), START: {"kind": "uniform"}}


ALL = tuple(RULES)
TWO = ("messages", "auction", "auction and messages")

CASES = [
    Case("rules", 100, ALL, "robots", (2, 4, 8, 16, 32), lambda n: {ROBOTS: int(n)}),
    Case(
        "failures",
        100,
        ("messages", "auction", "fixed plan", "auction and messages"),
        "share of robots lost",
        (0, 0.1, 0.2, 0.3, 0.4, 0.5),
        failing,
    ),
    Case("loss", 100, TWO, "lost messages", (0, 0.1, 0.3, 0.5, 0.7, 0.9), lambda p: both(LOSS, p)),
    Case(
        "bandwidth",
        100,
        TWO,
        "messages per step",
        (2, 4, 8, 16, 32),
        lambda n: {ROBOTS: 16, **both(BANDWIDTH, int(n))},
    ),
    Case(
        "controllers",
        100,
        ("auction", "auction and messages"),
        "controllers",
        (1, 2, 3),
        lambda n: {CONTROLLERS: int(n)},
    ),
    Case(
        "lost_controllers",
        100,
        ("auction", "auction and messages"),
        "controllers",
        (1, 2, 3),
        lambda n: {CONTROLLERS: int(n), CONTROLLER_FAILURES: MISSION_S},
    ),
    Case("crowd", 5, ("messages", "auction"), "robots", (1, 10, 100, 300, 1000), crowd),
    Case(
        "search",
        100,
        tuple(SEARCHES),
        "robots",
        (1, 2, 4, 8, 16),
        lambda n: {ROBOTS: int(n)},
        AREA_SEARCH,
    ),
]


def main() -> None:
    """Measure, draw or check."""
    if not {"--check", "--draw"} & set(sys.argv[1:]):
        measure()
    PAGE.draw(lambda name: BLOCKS[name](), specifications())


# Measured.


def measure() -> None:
    """Run everything, and write the means."""
    PAGE.folder.mkdir(exist_ok=True)
    with (PAGE.folder / "cases.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, [each.name for each in fields(Result)], lineterminator="\n")
        writer.writeheader()
        for case in CASES:
            writer.writerows(asdict(result) for result in results(case))
            file.flush()


def results(case: Case) -> Iterator[Result]:
    """Yield the means of each rule and number, all in the same worlds."""
    for rule in case.rules:
        for number in case.numbers:
            began_s = time.monotonic()
            scenario = case.scenario
            for path, value in case.all_changes(rule, number).items():
                scenario = scenario.replace(path, value)
            yield result(case, rule, number, scenario)
            took_s = time.monotonic() - began_s
            print(f"{case.name}: {rule}, {number:g}: {took_s:.1f} s", flush=True)


def result(case: Case, rule: str, number: float, scenario: ae.Scenario) -> Result:
    """Return the means of the runs of a scenario."""
    runs = ae.replicate(scenario, case.runs, SEED)

    def mean(name: str) -> float:
        return short(float(np.mean(runs[name].to_numpy().astype(np.float64))))

    times_s = runs["time_s"].to_numpy().astype(np.float64)
    named = [each.name for each in fields(Result)][6:]
    return Result(
        case.name,
        rule,
        number,
        case.runs,
        mean("time_s"),
        short(float(np.std(times_s, ddof=1) / math.sqrt(len(times_s)))),
        *(mean(name) for name in named),
    )


def short(value: float) -> float:
    """Return a number with six digits."""
    return float(f"{value:.6g}")


def read() -> list[Result]:
    """Return the rows of the CSV."""
    types = get_type_hints(Result)
    with (PAGE.folder / "cases.csv").open(encoding="utf-8", newline="") as file:
        return [
            Result(**{key: types[key](value) for key, value in row.items()})
            for row in csv.DictReader(file)
        ]


# Tables.


def of_case(name: str, cell: Callable[[Result], str]) -> Callable[[], str]:
    """Return what makes a table with a row for each rule and a column for each number."""

    def made() -> str:
        case = next(each for each in CASES if each.name == name)
        found = {(each.rule, each.number): each for each in read() if each.case == name}
        rows = [
            [rule, *(cell(found[rule, float(number)]) for number in case.numbers)]
            for rule in case.rules
        ]
        return table([case.varied, *(f"{number:g}" for number in case.numbers)], rows)

    return made


def seconds(each: Result) -> str:
    """Return the time of a mission with its 95% interval."""
    text = f"{each.time_s:.0f} ± {Z95 * each.time_error_s:.0f}"
    return text if each.complete == 1 else f"{text} ({each.complete:.0%} complete)"


def split(each: Result) -> str:
    """Return the parts of the time of a goal."""
    parts = (each.waiting_s, each.travel_s, each.blocked_s, each.service_s)
    return " + ".join(f"{part:.1f}" for part in parts)


def radio(each: Result) -> str:
    """Return how many messages were sent, and the share of received ones that was dropped."""
    return f"{each.messages_sent:,.0f}, {each.messages_dropped:,.0f} dropped"


BLOCKS: dict[str, Callable[[], str]] = {
    "rules_time": of_case("rules", seconds),
    "rules_twice": of_case("rules", lambda each: f"{each.served_twice:.1f}"),
    "rules_distance": of_case("rules", lambda each: f"{each.distance_m:,.0f}"),
    "rules_split": of_case("rules", split),
    "rules_radio": of_case("rules", radio),
    "failures": of_case("failures", seconds),
    "failures_served": of_case("failures", lambda each: f"{each.served:.1f}"),
    "loss": of_case("loss", seconds),
    "loss_twice": of_case("loss", lambda each: f"{each.served_twice:.1f}"),
    "bandwidth": of_case("bandwidth", seconds),
    "bandwidth_twice": of_case("bandwidth", lambda each: f"{each.served_twice:.1f}"),
    "controllers": of_case("controllers", seconds),
    "lost_controllers": of_case("lost_controllers", seconds),
    "search": of_case("search", seconds),
    "search_served": of_case("search", lambda each: f"{each.served:.1f}"),
    "crowd": of_case("crowd", seconds),
    "crowd_twice": of_case("crowd", lambda each: f"{each.served_twice:.1f}"),
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
    case = next(each for each in CASES if each.name == name)
    own = [each for each in read() if each.case == name]
    some = [Row(each.rule, each.number, *number(each), None) for each in own]
    layers = [{**line(), "data": {"values": [values(row) for row in some]}}, *points(some)]
    axes = Axes("log" if log else "linear", x_ticks=case.numbers)
    return page_of(panel(layers, case.varied, title, width=520, axes=axes))


if __name__ == "__main__":
    main()
