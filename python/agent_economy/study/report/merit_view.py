"""The selection and order of what a report on the best configuration by merit shows."""

import math
from dataclasses import dataclass, replace
from functools import cached_property

from agent_economy.study.answer.best import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.results import Result
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.paths import robot_kind
from agent_economy.study.report.formatting import brief, finite, places
from agent_economy.study.report.view import MAX_SHOWN, View

MIN_NEAREST, MAX_NEAREST = 5, 12
"""Configurations that a report compares with the selected one run by run."""


@dataclass(frozen=True)
class MeritView(View):
    """An answer by merit and its evidence."""

    answer: Answer
    evidence: Evidence

    quarantine = "without a finite merit: quarantined, each counts as the worst merit"
    principles = (
        ("bounds", "the merit of a run has known bounds; no distribution is assumed"),
        (
            "quarantine",
            "a run without a finite merit counts as the worst merit and is never omitted",
        ),
    )
    max_name = 32

    @property
    def facts(self) -> tuple[tuple[str, str], ...]:
        """The indifference zone."""
        return ((brief(self.answer.delta), "indifference zone (delta)"),)

    @cached_property
    def ranks(self) -> dict[int, int]:
        """The rank of each configuration, from 1; those that cannot be run are the last."""
        return {each: rank for rank, each in enumerate((*self.known, *self.impossible), start=1)}

    def price(self, index: int) -> float:
        """Return the price of a configuration; without prices, its number of robots."""
        return self.result(index).place.price

    @cached_property
    def known(self) -> tuple[int, ...]:
        """All that can be run, the selected one first, then by mean merit."""
        merits = [finite(result.merit.value) for result in self.answer.results]
        possible = (at for at, each in enumerate(self.answer.results) if each.is_possible)

        def rank(index: int) -> tuple[bool, float]:
            merit = merits[index]
            return index != self.answer.best, math.inf if merit is None else -merit

        return tuple(sorted(possible, key=rank))

    @cached_property
    def impossible(self) -> tuple[int, ...]:
        """The configurations that cannot be run."""
        return tuple(at for at, each in enumerate(self.answer.results) if not each.is_possible)

    @cached_property
    def shown(self) -> tuple[int, ...]:
        """The best configurations, in the order of the axis."""
        best = self.known[:MAX_SHOWN]
        path = self.numeric_factor
        if path is None:
            return best
        return tuple(sorted(best, key=lambda index: float(self.result(index).values[path])))

    @property
    def selected(self) -> int:
        """The selected configuration."""
        return self.answer.best

    @cached_property
    def nearest(self) -> tuple[int, ...]:
        """Those closest to the selected one, which are compared with it run by run."""
        others = self.known[1:]
        return others[: min(MAX_NEAREST, max(MIN_NEAREST, len(others) // 2))]

    @cached_property
    def by_runs(self) -> tuple[int, ...]:
        """Configurations by their number of runs, descending; of equals, the better one first."""
        return tuple(sorted(self.known, key=lambda index: -self.result(index).runs))[:MAX_SHOWN]

    @cached_property
    def on_front(self) -> tuple[int, ...]:
        """The possibly efficient ones by merit, then the dominated ones."""

        def is_dominated(index: int) -> bool:
            return self.result(index).place.dominated_by is not None

        return tuple(sorted(self.known, key=is_dominated))[:MAX_SHOWN]

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
        return len(self.known) > 1

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
