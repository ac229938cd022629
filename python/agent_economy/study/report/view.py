"""What of an answer a report shows, in which order, under which names."""

import math
from collections import Counter
from dataclasses import dataclass, replace
from functools import cached_property

from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.labels import is_number, robot_kind, varied
from agent_economy.study.answer.results import Result
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.report.writing import finite, places

MOST = 50
"""Configurations in a chart or a table; answer.json has all."""

FEWEST, NEAREST = 5, 12
"""Configurations of which a report shows how far they are behind the selected one."""

LONG = 32
"""Letters of a long name."""

MOST_CELLS = 1500
"""Of a map of two factors."""


@dataclass(frozen=True)
class View:
    """An answer and its evidence, as a report shows them."""

    answer: Answer
    evidence: Evidence

    @cached_property
    def names(self) -> tuple[str, ...]:
        """What people call each configuration; no two the same.

        Where some are so long that a chart on a narrow screen cuts them, their rank comes first.
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
        """The rank of each configuration, from 1."""
        return {index: rank for rank, index in enumerate(self.ranked, start=1)}

    @cached_property
    def ranked(self) -> tuple[int, ...]:
        """All configurations, the selected one first, then by mean merit."""
        merits = [finite(result.merit.value) for result in self.answer.results]

        def rank(index: int) -> tuple[bool, float]:
            merit = merits[index]
            return index != self.answer.best, math.inf if merit is None else -merit

        return tuple(sorted(range(len(merits)), key=rank))

    @cached_property
    def shown(self) -> tuple[int, ...]:
        """The best configurations, as they stand along the axis."""
        best = self.ranked[:MOST]
        path = self.numeric_factor
        if path is None:
            return best
        return tuple(sorted(best, key=lambda index: float(self.result(index).values[path])))

    @cached_property
    def varied(self) -> tuple[str, ...]:
        """Paths that have more than one value."""
        return varied([result.values for result in self.answer.results])

    @cached_property
    def numeric_factor(self) -> str | None:
        """The only factor that is varied, if it is a number: the axis of the charts."""
        if len(self.varied) != 1:
            return None
        path = self.varied[0]
        numbers = all(is_number(result.values[path]) for result in self.answer.results)
        return path if numbers else None

    @cached_property
    def nearest(self) -> tuple[int, ...]:
        """Those nearest behind the selected one: few enough that the far ones set no scale."""
        others = self.ranked[1:]
        return others[: min(NEAREST, max(FEWEST, len(others) // 2))]

    @cached_property
    def by_runs(self) -> tuple[int, ...]:
        """Those that took the most runs, the better first among equals."""
        return tuple(sorted(self.ranked, key=lambda index: -self.result(index).runs))[:MOST]

    @cached_property
    def on_front(self) -> tuple[int, ...]:
        """The possibly efficient ones, by merit, then the surely dominated ones."""

        def is_dominated(index: int) -> bool:
            return self.result(index).place.dominated_by is not None

        return tuple(sorted(self.ranked, key=is_dominated))[:MOST]

    @cached_property
    def is_grid(self) -> bool:
        """Whether two factors are varied, and each pair of their values is there once."""
        results = self.answer.results
        if len(self.varied) != len(("across", "down")) or len(results) > MOST_CELLS:
            return False
        points = {tuple(each.values[path] for path in self.varied) for each in results}
        sides = [len(set(side)) for side in zip(*points, strict=True)]
        return len(points) == len(results) == sides[0] * sides[1]

    @cached_property
    def saturations(self) -> tuple[Saturation, ...]:
        """Where each varied team size saturates, with what the nearest larger teams gain."""
        return tuple(
            replace(each, gains=dict(list(each.gains.items())[:MOST]))
            for each in self.answer.saturations
        )

    @property
    def published_axis(self) -> str | None:
        """The only factor, if it is a team size by which results of others can be shown."""
        path = self.numeric_factor
        is_team = path is not None and robot_kind(path) is not None
        return path if self.answer.published and is_team else None

    @property
    def compares(self) -> bool:
        """Whether there is more than one configuration."""
        return len(self.answer.results) > 1

    def result(self, index: int) -> Result:
        """Return what the runs of a configuration came to."""
        return self.answer.results[index]

    @cached_property
    def merit_places(self) -> int:
        """Decimals of merits: delta has two figures."""
        return places(self.answer.delta)

    @cached_property
    def time_places(self) -> int:
        """Decimals of times."""
        longest = max(finite(result.time_s.value) or 0.0 for result in self.answer.results)
        return places(longest / 50)

    @cached_property
    def share_places(self) -> int:
        """Decimals of percentages: the narrowest interval has two figures, three at most."""
        widths = [100 * (each.failed.high - each.failed.low) for each in self.answer.results]
        return min(3, places(min((width for width in widths if width > 0), default=10.0)))


def factor_name(path: str) -> str:
    """Return what an axis calls a factor: "rovers" for robots.rover.count, else its last key."""
    kind = robot_kind(path)
    return path.rsplit(".", 1)[-1] if kind is None else f"{kind}s"
