"""The race of a study in its folder: procedure, store and engine together.

A study is resumed by repeating it from its beginning over the stored runs: every decision follows
from `study.toml` and the data, so a study that was killed ends with the same bytes as one that was
not, and repeating a finished study computes nothing.
"""

import math
import time
from collections.abc import Callable, Generator, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from agent_economy._core import InputError
from agent_economy.runs import quarantine
from agent_economy.scenario.validation import check
from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.clearance import CLEARANCE_COLUMNS
from agent_economy.study.answer.effort import MIN_ROUNDS, remaining_range
from agent_economy.study.answer.evidence import Evidence, Sample
from agent_economy.study.answer.goal_time import GOAL_COLUMNS
from agent_economy.study.answer.lane_truth import is_lane_truth
from agent_economy.study.arguments import Floats
from agent_economy.study.chunks import in_chunks
from agent_economy.study.errors import NoConfigurationError, NoMoreRunsError
from agent_economy.study.plan import Plan, digest, may_replace
from agent_economy.study.progress import (
    NOTHING,
    ROUND_S,
    Leader,
    LeaderInterval,
    OnProgress,
    Progress,
    Range,
)
from agent_economy.study.run_block import Compute, Part, Partwise, RunBlock
from agent_economy.study.selection import Integers, drive, eliminations, is_over, within
from agent_economy.study.store import Store, StoredRuns
from agent_economy.study.store.ledger import Answered


def run_race(
    plan: Plan,
    folder: Path,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
    finish: Callable[[AnyAnswer, Evidence], None] | None = None,
) -> tuple[AnyAnswer, Evidence]:
    """Run or resume a study until it has an answer.

    Args:
        plan: The question. If the folder contains another question about the same runs (another
            delta, confidence or guarantee), this one replaces it and reuses the runs.
        folder: Folder of the study; created if it does not exist.
        compute: Computes blocks of runs; None for the plan's engine on this machine.
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
    with ExitStack() as stack:
        store = stack.enter_context(
            Store.open(
                folder,
                plan.text(),
                columns,
                content=content,
                may_replace=partial(may_replace, folder),
            )
        )
        compute = compute or stack.enter_context(plan.engine.on_this_machine())
        try:
            answer, evidence = Race(plan, store, compute, on_progress).run()
        except KeyboardInterrupt:
            if plan.question.certifies:
                # What its runs prove already can be read: a promise, too.
                record_questions(plan, store)
            raise
        if finish:
            finish(answer, evidence)
    return answer, evidence


def answer_of(plan: Plan, store: StoredRuns, compute: Compute) -> tuple[AnyAnswer, Evidence]:
    """Return the answer from the stored runs, without writing anything."""
    return Race(plan, store, compute, None).run()


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
        source = compute or plan.engine
        self._source = source if isinstance(source, Partwise) else in_chunks(source)
        self._compute = Partwise(self._parts)
        self._on_progress = on_progress
        self._start = self._reported_at = time.monotonic()
        self._procedure = plan.question.procedure(plan.engine, plan.confidence, plan.runs)
        self._value_limits = plan.question.limits(plan.engine)
        self._rounds = 0
        self._eliminated: set[int] = set()
        count = len(plan.configurations)
        self._limits = [plan.engine.limits(index) for index in range(count)]
        self._columns: list[dict[str, list[Floats]]] = [
            {name: [] for name in reported(plan, self._limits[0])} for _ in range(count)
        ]
        self._runs = np.zeros(count, dtype=np.int64)
        self._sums = np.zeros(count)
        self._quarantined = np.zeros(count, dtype=np.int64)

    def run(self) -> tuple[AnyAnswer, Evidence]:
        """Run it to its end.

        Raises:
            InputError: If no configuration can be run.
        """
        try:
            self._rounds_until_over()
        except NoConfigurationError as error:
            message = f"no configuration can be run: {error} ({self._obstacle(0)})"
            raise InputError(message) from None
        except NoMoreRunsError:
            pass  # It is concluded as it is, as if its run budget were reached.
        impossible = self._impossible()
        if len(impossible) == len(self._runs):
            message = f"no configuration can be run: all runs are quarantined ({self._obstacle(0)})"
            raise InputError(message)
        plan, evidence = self._plan, self.evidence()
        obstacle = self._obstacle(impossible[0]) if impossible else ""
        answer = plan.question.conclude(plan.engine, evidence, self._procedure, plan.runs, obstacle)
        questions = record_questions(plan, self._store)
        return replace(answer, questions=questions, agents=plan.engine.agents), evidence

    def _rounds_until_over(self) -> None:
        procedure = self._procedure
        for number, _ in enumerate(drive(procedure, self._values, self._plan.max_runs)):
            self._rounds = number + 1
            self._store.pending = 0
            progress = self._progress()
            self._store.note(number, progress.facts())
            self._report(progress)

    def _impossible(self) -> list[int]:
        """Return the configurations of which all runs are quarantined."""
        is_impossible = (self._quarantined == self._runs) & (self._runs > 0)
        return [int(each) for each in np.flatnonzero(is_impossible)]

    def _obstacle(self, configuration: int) -> str:
        """Return why the runs of a configuration are quarantined, from its first run."""
        return quarantine.reason(self._plan.alone(configuration), self._plan.seed, 0)

    def _report(self, progress: Progress) -> None:
        if self._on_progress:
            self._reported_at = time.monotonic()
            self._on_progress(progress)

    def _parts(self, block: RunBlock) -> Generator[Part]:
        """Yield the parts of a block, and report progress after each."""
        for part in self._source.parts(block):
            yield part
            if time.monotonic() - self._reported_at > ROUND_S:
                self._report(self._progress())

    def evidence(self) -> Evidence:
        """Return the runs until now."""
        samples = [self._sample(index) for index in range(len(self._columns))]
        return Evidence(tuple(samples), self._plan.confidence, self._plan.question.part)

    def _values(
        self, configurations: Integers, first_run: int, runs: int
    ) -> tuple[Floats, Integers]:
        block = RunBlock(tuple(configurations.tolist()), first_run, runs)
        columns = self._store.block(block, self._compute)
        question = self._plan.question
        found = question.sample(self._plan.scenario, columns)
        values, quarantined = within(self._value_limits, configurations, found)
        self._quarantined[configurations] += quarantined
        self._runs[configurations] += runs
        for row, configuration in enumerate(block.configurations):
            limits = self._limits[configuration]
            for name, parts in self._columns[configuration].items():
                if name == question.quantity:
                    parts.append(values[row])
                    continue
                if name == "quarantined":
                    parts.append(np.isnan(found[row]).astype(np.float64))
                    continue
                given = columns[name][row]
                if name not in question.columns:
                    parts.append(given)
                    continue
                # A quarantined run counts as the worst possible: late, failed, and with its cost.
                parts.append(np.where(np.isnan(given), limits[name][1], given))
            self._sums[configuration] += values[row].sum()
        if question.counts_quarantined:
            # They count as not met, and exclude no configuration: its share of missions decides.
            return values, np.zeros_like(quarantined)
        return values, quarantined

    def _sample(self, index: int) -> Sample:
        lowest, highest = self._value_limits[index].tolist()
        return Sample(
            values=self._plan.configurations[index],
            columns={
                name: np.concatenate([np.empty(0), *parts])
                for name, parts in self._columns[index].items()
            },
            limits={**self._limits[index], self._plan.question.quantity: (lowest, highest)},
            quarantined=int(self._quarantined[index]),
        )

    def _progress(self) -> Progress:
        procedure = self._procedure
        question, runs = self._plan.question, procedure.runs
        best = tuple(
            Leader(each, int(runs[each]), float(self._sums[each] / runs[each]), status)
            for each, status in question.leaders(self._plan.engine, procedure, self._sums).items()
        )
        eliminated = eliminations(procedure)
        new = tuple(each for each in eliminated if each.configuration not in self._eliminated)
        self._eliminated = {each.configuration for each in eliminated}
        return Progress(
            round=self._rounds,
            runs=int(self._runs.sum()) + self._store.pending,
            computed=self._store.computed,
            seconds=time.monotonic() - self._start,
            survivors=len(procedure.survivors),
            leaders=best[question.shown_leaders],
            eliminated=new,
            certified=tuple(procedure.certified.tolist()) if question.certifies else None,
            may_meet=frozenset(self._eliminated).difference(procedure.below.tolist()),
            is_over=self._is_over(),
            estimate_remaining=self._estimate_remaining,
            intervals=lambda: self._intervals(best),
        )

    def _intervals(self, shown: tuple[Leader, ...]) -> tuple[LeaderInterval, ...]:
        evidence = self.evidence()
        quantity = self._plan.question.quantity
        return tuple((each, evidence.interval(each.configuration, quantity)) for each in shown)

    def _is_over(self) -> bool:
        """Return whether it has selected, or its run budget does not allow another round."""
        return is_over(self._procedure, int(self._runs.sum()), self._plan.max_runs)

    def _estimate_remaining(self) -> Range | None:
        """Return the range of the runs left: at least those of the round, at most the budget."""
        plan, procedure, pending = self._plan, self._procedure, self._store.pending
        request = procedure.next()
        if request is None or self._is_over():
            return NOTHING
        if plan.runs is not None:
            missing = plan.runs - self._runs[procedure.survivors]
            return float(missing.sum() - pending), float(missing.sum() - pending)
        configurations, _, runs = request
        of_round = len(configurations) * runs
        if self._rounds < MIN_ROUNDS:
            return None
        expected = plan.question.remaining(procedure, self._sample, plan.confidence)
        if expected is None:
            return None
        most = math.inf if plan.max_runs is None else float(plan.max_runs - self._runs.sum())
        low, high = remaining_range(expected, of_round, most)
        return low - pending, high - pending


def record_questions(plan: Plan, store: Store | StoredRuns) -> tuple[Answered, ...]:
    """Record that the questions of a plan were answered; return all that were from these runs."""
    questions: tuple[Answered, ...] = ()
    for identity in plan.question.identities(plan.scenario, plan.confidence):
        words = ", ".join(f"{key} {value}" for key, value in identity.items())
        questions = store.answered(Answered(words, plan.confidence))
    return questions


def reported(plan: Plan, limits: Mapping[str, object]) -> Iterator[str]:
    """Yield the columns that an answer uses, of those that the simulator has, and its own."""
    question = plan.question
    yield question.quantity
    if question.counts_quarantined:
        yield "quarantined"
    names = dict.fromkeys((*question.columns, *GOAL_COLUMNS, *CLEARANCE_COLUMNS))
    yield from (name for name in names if name in limits)
    yield from (name for name in limits if is_lane_truth(name) and name not in names)
