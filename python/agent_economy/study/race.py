"""A study in its folder, from its beginning or where it was: the race, the store and the engine.

To go on with a study is to run it again from its beginning over what is stored: every decision
follows from `study.toml` and the data, so a study that was killed comes to the same bytes as one
that was not, and asking again for what is known computes nothing.
"""

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from agent_economy import _core
from agent_economy.given import check
from agent_economy.study.answer.conclude import Answer, conclude
from agent_economy.study.answer.effort import remaining
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.results import Ending
from agent_economy.study.arguments import Floats
from agent_economy.study.plan import Plan, digest, is_same_data
from agent_economy.study.rectangle import Columns, Compute, Rectangle
from agent_economy.study.selection import Elimination, Integers, drive, in_words, within
from agent_economy.study.store import Store

KEPT = ("time_s", "failed", "robots")
"""Columns that an answer is made of, besides the merit."""

LEADERS = 10
"""Configurations that watchers see."""

PIECE_ROWS = 20_000
"""Runs between two reports of progress while a block is computed in this process."""


@dataclass(frozen=True)
class Leader:
    """One of the best so far."""

    configuration: int
    runs: int
    merit: float


@dataclass(frozen=True)
class Progress:
    """How far a study is.

    Attributes:
        round: Rounds over.
        runs: Runs of all configurations, the stored ones included.
        computed: Those of them that this process had to compute.
        seconds: Since it began.
        survivors: Configurations still in.
        leaders: The best of them so far.
        eliminated: Those put out in this round, and by whom.
        is_over: Whether it was the last round.
        foretell: Returns about how many runs are left; None if nobody can say. It takes a moment.
    """

    round: int
    runs: int
    computed: int
    seconds: float
    survivors: int
    leaders: tuple[Leader, ...]
    eliminated: tuple[Elimination, ...]
    is_over: bool
    foretell: Callable[[], float | None]

    def facts(self) -> dict[str, Any]:
        """Return what the ledger keeps of the round: what follows from the data alone."""
        return {
            "runs": self.runs,
            "survivors": self.survivors,
            "leaders": [[each.configuration, each.runs, each.merit] for each in self.leaders],
            "eliminated": [[each.configuration, each.by, each.runs] for each in self.eliminated],
            "is_over": self.is_over,
        }

    @classmethod
    def of_facts(
        cls, number: int, facts: Mapping[str, Any], computed: int, seconds: float
    ) -> "Progress":
        """Return a round as the ledger keeps it; nobody can say how many runs are left."""
        return cls(
            round=number + 1,
            runs=facts["runs"],
            computed=computed,
            seconds=seconds,
            survivors=facts["survivors"],
            leaders=tuple(Leader(*each) for each in facts["leaders"]),
            eliminated=tuple(Elimination(*each) for each in facts["eliminated"]),
            is_over=facts["is_over"],
            foretell=lambda: None,
        )


OnProgress = Callable[[Progress], None]


def hold(
    plan: Plan,
    folder: Path,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
    finish: Callable[[Answer, Evidence], None] | None = None,
) -> tuple[Answer, Evidence]:
    """Run a study, or go on with it, until it has an answer.

    Args:
        plan: What is asked. Another question about the same runs (another delta, confidence or
            guarantee than the folder's) takes the folder over and uses its runs.
        folder: Of the study; made if it is not there.
        compute: What computes rectangles: the plan's engine in this process if None.
        on_progress: Called after each round.
        finish: Called with what is found, before another process may work on the folder.

    Raises:
        InputError: If the folder holds another study, is damaged, or cannot be written.
    """
    for name, function in (("compute", compute), ("on_progress", on_progress)):
        check(function is None or callable(function), name, function, "a function or None")
    columns = plan.engine.columns
    content = {digest(data): data for data in plan.files.values()}
    with Store.open(
        folder, plan.text(), columns, content=content, may_replace=is_same_data
    ) as store:
        race = Race(plan, store, compute or in_pieces(plan.engine), on_progress)
        evidence, ending = race.run()
        answer = conclude(plan, evidence, ending)
        if finish:
            finish(answer, evidence)
    return answer, evidence


def in_pieces(compute: Compute) -> Compute:
    """Return what computes a rectangle a piece at a time, so that Ctrl-C is heard between two."""

    def pieces(rectangle: Rectangle) -> Columns:
        runs = max(1, PIECE_ROWS // len(rectangle.configurations))
        firsts = range(rectangle.first_run, rectangle.end, runs)
        parts = [
            compute(Rectangle(rectangle.configurations, first, min(runs, rectangle.end - first)))
            for first in firsts
        ]
        return {name: np.concatenate([part[name] for part in parts], axis=1) for name in parts[0]}

    return pieces


class Race:
    """A race over a store: what it asks for is looked up or computed, scored, kept and told."""

    def __init__(
        self, plan: Plan, store: Store, compute: Compute, on_progress: OnProgress | None
    ) -> None:
        """Begin with no runs."""
        self._plan = plan
        self._store = store
        self._compute = compute
        self._on_progress = on_progress
        self._begin = time.monotonic()
        self._gone: set[int] = set()
        count = len(plan.configurations)
        self._limits = [plan.engine.limits(index) for index in range(count)]
        self._columns: list[dict[str, list[Floats]]] = [
            {name: [] for name in ("merit", *KEPT)} for _ in range(count)
        ]
        self._sums = np.zeros(count)
        self._quarantined = np.zeros(count, dtype=np.int64)

    def run(self) -> tuple[Evidence, Ending]:
        """Run it to its end."""
        procedure = self._procedure()
        for number, _ in enumerate(drive(procedure, self._ask, self._plan.max_runs)):
            progress = self._progress(number, procedure)
            self._store.note(number, progress.facts())
            if self._on_progress:
                self._on_progress(progress)
        eliminations = tuple(Elimination(*each) for each in procedure.eliminations)
        is_over = self._plan.runs is None and procedure.next() is None
        guarantee = self._guarantee(procedure)
        return self.evidence(), Ending(procedure.best, eliminations, guarantee, is_over)

    def evidence(self) -> Evidence:
        """Return the runs so far."""
        samples = [self._sample(index) for index in range(len(self._columns))]
        return Evidence(tuple(samples), self._plan.confidence)

    def _procedure(self) -> _core.Procedure:
        plan = self._plan
        if plan.runs is None:
            return _core.selection(
                plan.limits,
                delta=plan.delta,
                confidence=plan.confidence,
                guarantee=plan.guarantee,
            )
        return _core.reference(
            "equal",
            len(plan.configurations),
            delta=plan.delta,
            confidence=plan.confidence,
            runs=plan.runs,
        )

    def _guarantee(self, procedure: _core.Procedure) -> str:
        plan = self._plan
        if len(plan.configurations) == 1:
            return "One configuration has nothing to be compared with; the intervals hold."
        if plan.runs is None:
            return in_words(procedure, plan.delta, plan.confidence, plan.guarantee)
        return (
            "No error rate is promised for the choice itself, because the number of runs was fixed "
            "beforehand; the intervals hold."
        )

    def _ask(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        rectangle = Rectangle(tuple(configurations.tolist()), first_run, runs)
        columns = self._store.block(rectangle, self._compute)
        scored = self._plan.scenario.merit.score(columns)
        merits, quarantined = within(self._plan.limits, configurations, scored)
        self._quarantined[configurations] += quarantined
        for row, configuration in enumerate(rectangle.configurations):
            limits = self._limits[configuration]
            for name in KEPT:
                # A quarantined run is as bad as can be: late, failed, and paid for.
                values = columns[name][row]
                known = np.where(np.isnan(values), limits[name][1], values)
                self._columns[configuration][name].append(known)
            self._columns[configuration]["merit"].append(merits[row])
            self._sums[configuration] += merits[row].sum()
        return merits

    def _sample(self, index: int) -> Sample:
        least, greatest = self._plan.limits[index].tolist()
        return Sample(
            values=self._plan.configurations[index],
            columns={
                name: np.concatenate([np.empty(0), *parts])
                for name, parts in self._columns[index].items()
            },
            limits={**self._limits[index], "merit": (least, greatest)},
            quarantined=int(self._quarantined[index]),
        )

    def _progress(self, number: int, procedure: _core.Procedure) -> Progress:
        runs = procedure.runs
        survivors = procedure.survivors
        means = self._sums[survivors] / np.maximum(runs[survivors], 1)
        best = survivors[np.argsort(-means, kind="stable")][:LEADERS]
        eliminated = tuple(Elimination(*each) for each in procedure.eliminations)
        fresh = tuple(each for each in eliminated if each.configuration not in self._gone)
        self._gone = {each.configuration for each in eliminated}
        return Progress(
            round=number + 1,
            runs=int(runs.sum()),
            computed=self._store.computed,
            seconds=time.monotonic() - self._begin,
            survivors=len(survivors),
            leaders=tuple(
                Leader(int(each), int(runs[each]), float(self._sums[each] / runs[each]))
                for each in best
            ),
            eliminated=fresh,
            is_over=self._is_over(procedure),
            foretell=lambda: self._foretell(procedure),
        )

    def _is_over(self, procedure: _core.Procedure) -> bool:
        """Return whether it has selected, or must stop before its next round."""
        asked, max_runs = procedure.next(), self._plan.max_runs
        if asked is None or max_runs is None:
            return asked is None
        configurations, _, runs = asked
        return bool(procedure.runs.sum() + len(configurations) * runs > max_runs)

    def _foretell(self, procedure: _core.Procedure) -> float | None:
        plan = self._plan
        if plan.runs is not None:
            return float(plan.runs * len(plan.configurations) - procedure.runs.sum())
        survivors = procedure.survivors.tolist()
        evidence = Evidence(tuple(map(self._sample, survivors)), plan.confidence)
        rivals = len(plan.configurations) - 1
        return remaining(evidence, survivors.index(procedure.best), plan.delta, rivals)
