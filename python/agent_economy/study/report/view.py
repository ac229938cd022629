"""What a report shows of an answer to any question: names, axes, and parts that all have."""

import math
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Sequence
from functools import cached_property

from agent_economy.scenario import Value
from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.clearance import Clearance
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.goal_time import GoalTime
from agent_economy.study.answer.labels import is_number, listed, varied
from agent_economy.study.paths import counted_kind

MAX_SHOWN = 50
"""Maximum number of configurations in a chart or a table; answer.json contains all."""

MAX_CELLS = 1500
"""Maximum number of cells of a heat map."""


class View(ABC):
    """An answer and its evidence, as a report shows them."""

    answer: AnyAnswer
    evidence: Evidence
    max_name = math.inf
    """Length up to which names need no rank."""

    @property
    @abstractmethod
    def shown(self) -> tuple[int, ...]:
        """The configurations that are shown, in the order of the report."""

    @cached_property
    def ranks(self) -> dict[int, int]:
        """The number of each configuration in its name, if that needs one."""
        return {index: index + 1 for index in range(len(self.answer.results))}

    @cached_property
    def names(self) -> tuple[str, ...]:
        """The name of each configuration; all are different.

        If some are too long for a chart on a narrow screen, all begin with their rank.
        """
        labels = [result.label for result in self.answer.results]
        is_long = max(map(len, labels)) > self.max_name
        times = Counter(labels)
        return tuple(
            f"{self.ranks[index]}: {label}" if is_long or times[label] > 1 else label
            for index, label in enumerate(labels)
        )

    @cached_property
    def with_goal_time(self) -> dict[int, GoalTime]:
        """Where the time of a goal goes in those that are shown, in the order of the design."""
        times = {index: self.answer.results[index].goal_time for index in sorted(self.shown)}
        return {index: time for index, time in times.items() if time is not None}

    @cached_property
    def with_clearance(self) -> dict[int, Clearance]:
        """The lanes declared clear by those that are shown, in their order."""
        lanes = {index: self.answer.results[index].clearance for index in self.shown}
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
    def is_grid(self) -> bool:
        """Whether two factors are varied in a full grid, which a heat map can show."""
        count = len(self.configurations)
        if len(self.varied) != len(("across", "down")) or count > MAX_CELLS:
            return False
        points = {tuple(each[path] for path in self.varied) for each in self.configurations}
        across, down = (len(set(side)) for side in zip(*points, strict=True))
        return len(points) == count == across * down


def factor_names(paths: Sequence[str]) -> str:
    """Return the names of factors that are one: "rovers and drones"."""
    return listed([factor_name(path) for path in paths])


def factor_name(path: str) -> str:
    """Return the name of a factor on an axis: rovers for robots.rover.count, else the last key."""
    kind = counted_kind(path)
    return path.rsplit(".", 1)[-1] if kind is None else f"{kind}s"
