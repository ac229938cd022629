"""The race of a study in its folder: procedure, store and engine together.

A study is resumed by repeating it from its beginning over the stored runs: every decision follows
from `study.toml` and the data, so a study that was killed ends with the same bytes as one that was
not, and repeating a finished study computes nothing.
"""

import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import numpy as np

from agent_economy import _core
from agent_economy.scenario.validation import check
from agent_economy.study.answer.conclude import Answer, conclude
from agent_economy.study.answer.effort import remaining_runs
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.results import Ending
from agent_economy.study.arguments import Floats
from agent_economy.study.chunks import in_chunks
from agent_economy.study.plan import Plan, digest, may_replace
from agent_economy.study.progress import Leader, LeaderInterval, OnProgress, Progress
from agent_economy.study.run_block import Compute, RunBlock
from agent_economy.study.selection import Elimination, Integers, drive, guarantee_text, within
from agent_economy.study.store import Store, StoredRuns

REPORTED = ("time_s", "failed", "robots")
"""Columns that an answer uses besides the merit."""

LEADERS = 10
"""Leaders in a progress report."""

INTERVALS = 50
"""Leaders with intervals in a progress report."""

ROUND_S = 0.5
"""Interval of progress reports during a round."""


def run_race(
    plan: Plan,
    folder: Path,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
    finish: Callable[[Answer, Evidence], None] | None = None,
) -> tuple[Answer, Evidence]:
    """Run or resume a study until it has an answer.

    Args:
        plan: The question. If the folder contains another question about the same runs (another
            delta, confidence or guarantee), this one replaces it and reuses the runs.
        folder: Folder of the study; created if it does not exist.
        compute: Computes blocks of runs; None for the plan's engine in this process.
        on_progress: Called after each round, and during long ones that this process computes.
        finish: Called with the result while the folder is still locked.

    Raises:
        InputError: If the folder contains another study or runs of another build, is damaged, or
            cannot be written.
    """
    for name, function in (("compute", compute), ("on_progress", on_progress)):
        check(function is None or callable(function), name, function, "a function or None")
    columns = plan.engine.columns
    content = {digest(data): data for data in plan.files.values()}
    with Store.open(
        folder, plan.text(), columns, content=content, may_replace=partial(may_replace, folder)
    ) as store:
        race = Race(plan, store, compute, on_progress)
        evidence, ending = race.run()
        answer = conclude(plan, evidence, ending)
        if finish:
            finish(answer, evidence)
    return answer, evidence


def answer_of(plan: Plan, store: StoredRuns, compute: Compute) -> tuple[Answer, Evidence]:
    """Return the answer from the stored runs, without writing anything."""
    evidence, ending = Race(plan, store, compute, None).run()
    return conclude(plan, evidence, ending), evidence


class Race:
    """A race over a store: requested runs are read or computed, scored, recorded and reported."""

    def __init__(
        self,
        plan: Plan,
        store: Store | StoredRuns,
        compute: Compute | None,
        on_progress: OnProgress | None,
    ) -> None:
        """Start without runs."""
        self._plan = plan
        self._store = store
        self._compute = compute or in_chunks(plan.engine, self._on_chunk)
        self._on_progress = on_progress
        self._start = self._reported_at = time.monotonic()
        self._procedure = procedure_of(plan)
        self._rounds = self._computed = self._pending = 0
        self._eliminated: set[int] = set()
        count = len(plan.configurations)
        self._limits = [plan.engine.limits(index) for index in range(count)]
        self._columns: list[dict[str, list[Floats]]] = [
            {name: [] for name in ("merit", *REPORTED)} for _ in range(count)
        ]
        self._sums = np.zeros(count)
        self._quarantined = np.zeros(count, dtype=np.int64)

    def run(self) -> tuple[Evidence, Ending]:
        """Run it to its end."""
        procedure = self._procedure
        for number, _ in enumerate(drive(procedure, self._merits, self._plan.max_runs)):
            self._rounds = number + 1
            self._computed, self._pending = self._store.computed, 0
            progress = self._progress()
            self._store.note(number, progress.facts())
            self._report(progress)
        eliminations = tuple(Elimination(*each) for each in procedure.eliminations)
        is_over = self._plan.runs is None and procedure.next() is None
        guarantee = plan_guarantee(self._plan, procedure)
        return self.evidence(), Ending(procedure.best, eliminations, guarantee, is_over)

    def _report(self, progress: Progress) -> None:
        if self._on_progress:
            self._reported_at = time.monotonic()
            self._on_progress(progress)

    def _on_chunk(self, rows: int) -> None:
        self._pending = self._store.computed - self._computed + rows
        if time.monotonic() - self._reported_at > ROUND_S:
            self._report(self._progress())

    def evidence(self) -> Evidence:
        """Return the runs until now."""
        samples = [self._sample(index) for index in range(len(self._columns))]
        return Evidence(tuple(samples), self._plan.confidence)

    def _merits(self, configurations: Integers, first_run: int, runs: int) -> Floats:
        block = RunBlock(tuple(configurations.tolist()), first_run, runs)
        columns = self._store.block(block, self._compute)
        scored = self._plan.scenario.merit.score(columns)
        merits, quarantined = within(self._plan.limits, configurations, scored)
        self._quarantined[configurations] += quarantined
        for row, configuration in enumerate(block.configurations):
            limits = self._limits[configuration]
            for name in REPORTED:
                # A quarantined run counts as the worst possible: late, failed, and with its cost.
                values = columns[name][row]
                known = np.where(np.isnan(values), limits[name][1], values)
                self._columns[configuration][name].append(known)
            self._columns[configuration]["merit"].append(merits[row])
            self._sums[configuration] += merits[row].sum()
        return merits

    def _sample(self, index: int) -> Sample:
        lowest, highest = self._plan.limits[index].tolist()
        return Sample(
            values=self._plan.configurations[index],
            columns={
                name: np.concatenate([np.empty(0), *parts])
                for name, parts in self._columns[index].items()
            },
            limits={**self._limits[index], "merit": (lowest, highest)},
            quarantined=int(self._quarantined[index]),
        )

    def _progress(self) -> Progress:
        procedure = self._procedure
        runs = procedure.runs
        survivors = procedure.survivors
        best = self._best()
        eliminated = tuple(Elimination(*each) for each in procedure.eliminations)
        new = tuple(each for each in eliminated if each.configuration not in self._eliminated)
        self._eliminated = {each.configuration for each in eliminated}
        return Progress(
            round=self._rounds,
            runs=int(runs.sum()) + self._pending,
            computed=self._computed + self._pending,
            seconds=time.monotonic() - self._start,
            survivors=len(survivors),
            leaders=best[:LEADERS],
            eliminated=new,
            is_over=self._is_over(),
            estimate_remaining=self._estimate_remaining,
            intervals=lambda: self._intervals(best[:INTERVALS]),
        )

    def _best(self) -> tuple[Leader, ...]:
        """Return the remaining configurations that have runs, the best first."""
        runs, survivors = self._procedure.runs, self._procedure.survivors
        sampled = survivors[runs[survivors] > 0]
        means = self._sums[sampled] / runs[sampled]
        order = np.argsort(-means, kind="stable")
        rows = zip(sampled[order], runs[sampled[order]], means[order], strict=True)
        return tuple(Leader(int(each), int(count), float(mean)) for each, count, mean in rows)

    def _intervals(self, leaders: tuple[Leader, ...]) -> tuple[LeaderInterval, ...]:
        evidence = self.evidence()
        return tuple((each, evidence.interval(each.configuration, "merit")) for each in leaders)

    def _is_over(self) -> bool:
        """Return whether it has selected, or its run budget does not allow another round."""
        procedure = self._procedure
        request, max_runs = procedure.next(), self._plan.max_runs
        if request is None or max_runs is None:
            return request is None
        configurations, _, runs = request
        return bool(procedure.runs.sum() + len(configurations) * runs > max_runs)

    def _estimate_remaining(self) -> float | None:
        plan, procedure = self._plan, self._procedure
        if plan.runs is not None:
            missing = float(plan.runs * len(plan.configurations) - procedure.runs.sum())
        elif self._rounds:
            survivors = procedure.survivors.tolist()
            evidence = Evidence(tuple(map(self._sample, survivors)), plan.confidence)
            rivals = len(plan.configurations) - 1
            missing = remaining_runs(evidence, survivors.index(procedure.best), plan.delta, rivals)
        else:
            return None
        return max(0.0, missing - self._pending)


def procedure_of(plan: Plan) -> _core.Procedure:
    """Return the procedure that decides which runs a study needs next."""
    if plan.runs is None:
        return _core.selection(
            plan.limits,
            delta=plan.delta,
            confidence=plan.confidence,
            guarantee=plan.guarantee,
        )
    return _core.equal_allocation(len(plan.configurations), plan.runs)


def plan_guarantee(plan: Plan, procedure: _core.Procedure) -> str:
    """Return the guarantee of an answer in words."""
    if len(plan.configurations) == 1:
        return "There is only one configuration, so nothing was selected; the intervals are valid."
    if plan.runs is None:
        return guarantee_text(procedure, plan.delta, plan.confidence, plan.guarantee)
    return (
        "The selection carries no guarantee, because the number of runs was fixed beforehand; the "
        "intervals are valid."
    )
