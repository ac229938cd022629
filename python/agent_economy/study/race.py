"""A study in its folder, from its beginning or where it was: the race, the store and the engine.

To go on with a study is to run it again from its beginning over what is stored: every decision
follows from `study.toml` and the data, so a study that was killed comes to the same bytes as one
that was not, and asking again for what is known computes nothing.
"""

import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from agent_economy import _core
from agent_economy.scenario.validation import check
from agent_economy.study.answer.conclude import Answer, conclude
from agent_economy.study.answer.effort import remaining
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.results import Ending
from agent_economy.study.arguments import Floats
from agent_economy.study.pieces import in_pieces
from agent_economy.study.plan import Plan, digest, is_same_data
from agent_economy.study.progress import Leader, OnProgress, Progress, Ranged
from agent_economy.study.rectangle import Compute, Rectangle
from agent_economy.study.selection import Elimination, Integers, drive, in_words, within
from agent_economy.study.store import Store, Stored

KEPT = ("time_s", "failed", "robots")
"""Columns that an answer is made of, besides the merit."""

LEADERS = 10
"""Configurations that watchers see."""

RANGED = 50
"""Configurations of which watchers can have the range of the merit."""

ROUND_S = 0.5
"""A round that takes longer is reported on while it goes on, this often."""


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
        on_progress: Called after each round, and each second or so of a long one that this
            process computes.
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
        race = Race(plan, store, compute, on_progress)
        evidence, ending = race.run()
        answer = conclude(plan, evidence, ending)
        if finish:
            finish(answer, evidence)
    return answer, evidence


def look(plan: Plan, store: Stored, compute: Compute) -> tuple[Answer, Evidence]:
    """Return what stored runs say; nothing is written."""
    evidence, ending = Race(plan, store, compute, None).run()
    return conclude(plan, evidence, ending), evidence


class Race:
    """A race over a store: what it asks for is looked up or computed, scored, kept and told."""

    def __init__(
        self,
        plan: Plan,
        store: Store | Stored,
        compute: Compute | None,
        on_progress: OnProgress | None,
    ) -> None:
        """Begin with no runs."""
        self._plan = plan
        self._store = store
        self._compute = compute or in_pieces(plan.engine, self._on_piece)
        self._on_progress = on_progress
        self._begin = self._told_at = time.monotonic()
        self._procedure = procedure_of(plan)
        self._rounds = self._computed = self._under_way = 0
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
        procedure = self._procedure
        for number, _ in enumerate(drive(procedure, self._ask, self._plan.max_runs)):
            self._rounds = number + 1
            self._computed, self._under_way = self._store.computed, 0
            progress = self._progress()
            self._store.note(number, progress.facts())
            self._tell(progress)
        eliminations = tuple(Elimination(*each) for each in procedure.eliminations)
        is_over = self._plan.runs is None and procedure.next() is None
        guarantee = guarantee_of(self._plan, procedure)
        return self.evidence(), Ending(procedure.best, eliminations, guarantee, is_over)

    def _tell(self, progress: Progress) -> None:
        if self._on_progress:
            self._told_at = time.monotonic()
            self._on_progress(progress)

    def _on_piece(self, rows: int) -> None:
        self._under_way = self._store.computed - self._computed + rows
        if time.monotonic() - self._told_at > ROUND_S:
            self._tell(self._progress())

    def evidence(self) -> Evidence:
        """Return the runs so far."""
        samples = [self._sample(index) for index in range(len(self._columns))]
        return Evidence(tuple(samples), self._plan.confidence)

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

    def _progress(self) -> Progress:
        procedure = self._procedure
        runs = procedure.runs
        survivors = procedure.survivors
        best = self._best()
        eliminated = tuple(Elimination(*each) for each in procedure.eliminations)
        fresh = tuple(each for each in eliminated if each.configuration not in self._gone)
        self._gone = {each.configuration for each in eliminated}
        return Progress(
            round=self._rounds,
            runs=int(runs.sum()) + self._under_way,
            computed=self._computed + self._under_way,
            seconds=time.monotonic() - self._begin,
            survivors=len(survivors),
            leaders=best[:LEADERS],
            eliminated=fresh,
            is_over=self._is_over(),
            foretell=self._foretell,
            ranged=lambda: self._ranged(best[:RANGED]),
        )

    def _best(self) -> tuple[Leader, ...]:
        """Return the survivors that have runs, the best first."""
        runs, survivors = self._procedure.runs, self._procedure.survivors
        begun = survivors[runs[survivors] > 0]
        means = self._sums[begun] / runs[begun]
        order = np.argsort(-means, kind="stable")
        rows = zip(begun[order], runs[begun[order]], means[order], strict=True)
        return tuple(Leader(int(each), int(count), float(mean)) for each, count, mean in rows)

    def _ranged(self, leaders: tuple[Leader, ...]) -> tuple[Ranged, ...]:
        evidence = self.evidence()
        return tuple((each, evidence.interval(each.configuration, "merit")) for each in leaders)

    def _is_over(self) -> bool:
        """Return whether it has selected, or must stop before its next round."""
        procedure = self._procedure
        asked, max_runs = procedure.next(), self._plan.max_runs
        if asked is None or max_runs is None:
            return asked is None
        configurations, _, runs = asked
        return bool(procedure.runs.sum() + len(configurations) * runs > max_runs)

    def _foretell(self) -> float | None:
        plan, procedure = self._plan, self._procedure
        if plan.runs is not None:
            left = float(plan.runs * len(plan.configurations) - procedure.runs.sum())
        elif self._rounds:
            survivors = procedure.survivors.tolist()
            evidence = Evidence(tuple(map(self._sample, survivors)), plan.confidence)
            rivals = len(plan.configurations) - 1
            left = remaining(evidence, survivors.index(procedure.best), plan.delta, rivals)
        else:
            return None
        return max(0.0, left - self._under_way)


def procedure_of(plan: Plan) -> _core.Procedure:
    """Return what says which runs a study needs next."""
    if plan.runs is None:
        return _core.selection(
            plan.limits,
            delta=plan.delta,
            confidence=plan.confidence,
            guarantee=plan.guarantee,
        )
    return _core.equal_allocation(len(plan.configurations), plan.runs)


def guarantee_of(plan: Plan, procedure: _core.Procedure) -> str:
    """Return what is guaranteed of an answer, in words."""
    if len(plan.configurations) == 1:
        return "One configuration has nothing to be compared with; the intervals hold."
    if plan.runs is None:
        return in_words(procedure, plan.delta, plan.confidence, plan.guarantee)
    return (
        "No error rate is promised for the choice itself, because the number of runs was fixed "
        "beforehand; the intervals hold."
    )
