"""The selection, order and names of what a report shows."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from agent_economy.scenario import Value
from agent_economy.study.answer.clearance import Clearance
from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.goal_time import GoalTime
from agent_economy.study.answer.labels import Values, is_number, varied
from agent_economy.study.answer.results import Result
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.paths import counted_kind, robot_kind
from agent_economy.study.report.formatting import finite, places

MAX_SHOWN = 50
"""Maximum number of configurations in a chart or a table; answer.json contains all."""

MIN_NEAREST, MAX_NEAREST = 5, 12
"""Configurations that a report compares with the selected one run by run."""

LONG = 32
"""Length above which a name is long."""

MAX_CELLS = 1500
"""Maximum number of cells of a heat map."""


@dataclass(frozen=True)
class View:
    """An answer and its evidence, as a report shows them."""

    answer: Answer
    evidence: Evidence

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The name of each configuration; all are different.

        If some are too long for a chart on a narrow screen, all begin with their rank.
        """
        labels = [result.label for result in self.answer.results]
        is_long = max(map(len, labels)) > LONG
        times = Counter(labels)
        return tuple(
            f"{self.ranks[index]}: {label}" if is_long or times[label] > 1 else label
            for index, label in enumerate(labels)
        )

    @cached_property
    def ranks(self) -> dict[int, int]:
        """The rank of each configuration, from 1; those that cannot be run are the last."""
        ordered = (*self.ranked, *self.impossible)
        return {index: rank for rank, index in enumerate(ordered, start=1)}

    @cached_property
    def ranked(self) -> tuple[int, ...]:
        """All that can be run, the selected one first, then by mean merit."""
        merits = [finite(result.merit.value) for result in self.answer.results]

        def rank(index: int) -> tuple[bool, float]:
            merit = merits[index]
            return index != self.answer.best, math.inf if merit is None else -merit

        return tuple(sorted(filter(self.is_possible, range(len(merits))), key=rank))

    @cached_property
    def impossible(self) -> tuple[int, ...]:
        """The configurations that cannot be run."""
        return tuple(
            index for index in range(len(self.answer.results)) if not self.is_possible(index)
        )

    def is_possible(self, index: int) -> bool:
        """Return whether a configuration can be run."""
        return self.result(index).is_possible

    @cached_property
    def shown(self) -> tuple[int, ...]:
        """The best configurations, in the order of the axis."""
        best = self.ranked[:MAX_SHOWN]
        path = self.numeric_factor
        if path is None:
            return best
        return tuple(sorted(best, key=lambda index: float(self.result(index).values[path])))

    @property
    def selected(self) -> int:
        """The selected configuration."""
        return self.answer.best

    @cached_property
    def with_goal_time(self) -> dict[int, GoalTime]:
        """Where the time of a goal goes in those that are shown, in the order of the design."""
        times = {index: self.result(index).goal_time for index in sorted(self.shown)}
        return {index: time for index, time in times.items() if time is not None}

    @cached_property
    def with_clearance(self) -> dict[int, Clearance]:
        """The lanes declared clear by those that are shown, in their order."""
        lanes = {index: self.result(index).clearance for index in self.shown}
        return {index: of for index, of in lanes.items() if of is not None}

    @cached_property
    def configurations(self) -> list[dict[str, Value]]:
        """The values of the varied factors of each configuration."""
        return [result.values for result in self.answer.results]

    @cached_property
    def varied(self) -> tuple[str, ...]:
        """Paths that have more than one value."""
        return varied(self.configurations)

    @cached_property
    def numeric_factor(self) -> str | None:
        """The only varied factor, if it is a number: the axis of the charts."""
        if len(self.varied) != 1:
            return None
        path = self.varied[0]
        numbers = all(is_number(result.values[path]) for result in self.answer.results)
        return path if numbers else None

    @cached_property
    def nearest(self) -> tuple[int, ...]:
        """Those closest to the selected one, which are compared with it run by run."""
        others = self.ranked[1:]
        return others[: min(MAX_NEAREST, max(MIN_NEAREST, len(others) // 2))]

    @cached_property
    def by_runs(self) -> tuple[int, ...]:
        """Configurations by their number of runs, descending; of equals, the better one first."""
        return tuple(sorted(self.ranked, key=lambda index: -self.result(index).runs))[:MAX_SHOWN]

    @cached_property
    def on_front(self) -> tuple[int, ...]:
        """The possibly efficient ones by merit, then the dominated ones."""

        def is_dominated(index: int) -> bool:
            return self.result(index).place.dominated_by is not None

        return tuple(sorted(self.ranked, key=is_dominated))[:MAX_SHOWN]

    @cached_property
    def is_grid(self) -> bool:
        """Whether two factors are varied in a full grid."""
        return are_grid(self.configurations, self.varied)

    @cached_property
    def saturations(self) -> tuple[Saturation, ...]:
        """The saturation of each varied team size, with the gains of the next larger teams."""
        return tuple(
            replace(each, gains=dict(list(each.gains.items())[:MAX_SHOWN]))
            for each in self.answer.saturations
        )

    @property
    def published_axis(self) -> str | None:
        """The only factor, if it is a team size with published results."""
        path = self.numeric_factor
        is_team = path is not None and robot_kind(path) is not None
        return path if self.answer.published and is_team else None

    @property
    def price_title(self) -> tuple[str, ...]:
        """The title of prices, and their unit if it is known: without prices, robots count."""
        return ("price",) if self.evidence.has_prices else ("price", "robots")

    @property
    def compares(self) -> bool:
        """Whether more than one configuration can be run."""
        return len(self.ranked) > 1

    def result(self, index: int) -> Result:
        """Return the result of a configuration."""
        return self.answer.results[index]

    @cached_property
    def merit_places(self) -> int:
        """Decimals of merits: two figures of delta."""
        return places(self.answer.delta)

    @cached_property
    def time_places(self) -> int:
        """Decimals of times."""
        longest = max(finite(result.time_s.value) or 0.0 for result in self.answer.results)
        return places(longest / 50)

    @cached_property
    def share_places(self) -> int:
        """Decimals of percentages: two figures of the narrowest interval, but at most three."""
        widths = [100 * (each.failed.high - each.failed.low) for each in self.answer.results]
        return min(3, places(min((width for width in widths if width > 0), default=10.0)))


def factor_name(path: str) -> str:
    """Return the name of a factor on an axis: rovers for robots.rover.count, else the last key."""
    kind = counted_kind(path)
    return path.rsplit(".", 1)[-1] if kind is None else f"{kind}s"


def are_grid(configurations: Sequence[Values], paths: tuple[str, ...]) -> bool:
    """Return whether configurations are a full grid of two factors, which a heat map can show."""
    if len(paths) != len(("across", "down")) or len(configurations) > MAX_CELLS:
        return False
    points = {tuple(each[path] for path in paths) for each in configurations}
    sides = [len(set(side)) for side in zip(*points, strict=True)]
    return len(points) == len(configurations) == sides[0] * sides[1]
