"""Scenarios of the metric engine for tests."""

from typing import Any

from agent_economy import Scenario
from agent_economy.scenario import Override


def world(text: str) -> str:
    """Return the text of a scenario of the metric engine."""
    return f'engine = "metric"\nsummary = "A test."\nmerit = "equation-5.2"\n{text}'


ENDLESS = {
    "clock.time_limit_s": 1_000_000,
    "items.mine.target": False,
    "robots.rover.battery.capacity_j": 1e12,
}
"""A run of weeks without targets."""

HUGE = {"robots.rover.count": 3000, "world.size_m": [300, 300], "clock.time_limit_s": 1}
"""Enough robots for threads to share a step."""

FULL = world("""
clock.time_limit_s = 10
world.size_m = [10, 10]
items.mine.count = 1
robots.first = { model = "ugv", count = 1, start = { kind = "fixed", at_m = [[5, 5]] } }
[robots.second]
model = "ugv"
count = 1
start = { kind = "uniform", within_m = [[4.9, 4.9], [5.1, 5.1]] }
""")


def search(changes: dict[str, Any] | None = None) -> Scenario:
    """Return the bundled search with other values at paths."""
    overrides = [Override.at(path, value, "test") for path, value in (changes or {}).items()]
    return Scenario.load("search", tuple(overrides))
