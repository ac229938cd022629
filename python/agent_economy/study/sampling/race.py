"""The loop of a selection, with its progress."""

import math
import time
from collections.abc import Generator

from agent_economy.study.answer.effort import MIN_ROUNDS, remaining_range
from agent_economy.study.arguments import Floats
from agent_economy.study.chunks import in_chunks
from agent_economy.study.progress import (
    MAX_SHOWN,
    NOTHING,
    ROUND_S,
    Leader,
    LeaderInterval,
    OnProgress,
    Progress,
    Range,
)
from agent_economy.study.questions.best import leaders
from agent_economy.study.run_block import Part, Partwise, RunBlock
from agent_economy.study.sampling.folder import Unstored
from agent_economy.study.sampling.plan import SelectionPlan
from agent_economy.study.sampling.result import Selection, result
from agent_economy.study.sampling.sampler import MERIT
from agent_economy.study.sampling.samples import Samples
from agent_economy.study.selection import Integers, drive, eliminations, is_over
from agent_economy.study.store import Store


class SelectionRace:
    """The loop of a selection: what it has computed, read and reported."""

    def __init__(
        self, plan: SelectionPlan, store: Store | Unstored, on_progress: OnProgress | None
    ) -> None:
        """Start without runs; in chunks, if they are stored or reported."""
        self._plan = plan
        self._store = store
        self._on_progress = on_progress
        self._is_followed = on_progress is not None or isinstance(store, Store)
        self._source = (
            in_chunks(plan.sampled) if self._is_followed else Partwise(plan.sampled.whole)
        )
        self._compute = Partwise(self._parts)
        self._start = self._reported_at = time.monotonic()
        self._procedure = plan.procedure()
        self._samples = Samples(plan.sampled.limits, plan.confidence)
        self._rounds = 0
        self._eliminated: set[int] = set()

    def run(self) -> Selection:
        """Run it to its end.

        Raises:
            NoConfigurationError: If all configurations are excluded.
        """
        for number, _ in enumerate(drive(self._procedure, self._merits, self._plan.max_runs)):
            self._rounds = number + 1
            self._store.pending = 0
            if self._is_followed:
                progress = self._progress()
                self._store.note(number, progress.facts())
                self._report(progress)
        return result(self._plan, self._procedure, self._samples)

    def _merits(
        self, configurations: Integers, first_run: int, runs: int
    ) -> tuple[Floats, Integers]:
        block = RunBlock(tuple(configurations.tolist()), first_run, runs)
        columns = self._store.block(block, self._compute)
        return self._samples.add(configurations, columns[MERIT])

    def _parts(self, block: RunBlock) -> Generator[Part]:
        """Yield the parts of a block, and report progress after each."""
        for part in self._source.parts(block):
            yield part
            if time.monotonic() - self._reported_at > ROUND_S:
                self._report(self._progress())

    def _report(self, progress: Progress) -> None:
        if self._on_progress:
            self._reported_at = time.monotonic()
            self._on_progress(progress)

    def _progress(self) -> Progress:
        procedure, samples = self._procedure, self._samples
        means = [(each, samples.mean(each)) for each in leaders(procedure, samples.sums)]
        best = tuple(Leader(each, int(samples.runs[each]), mean) for each, mean in means)
        eliminated = eliminations(procedure)
        new = tuple(each for each in eliminated if each.configuration not in self._eliminated)
        self._eliminated.update(each.configuration for each in new)
        return Progress(
            round=self._rounds,
            runs=int(samples.runs.sum()) + self._store.pending,
            computed=self._store.computed,
            seconds=time.monotonic() - self._start,
            survivors=len(procedure.survivors),
            leaders=best[:MAX_SHOWN],
            eliminated=new,
            certified=None,
            may_meet=frozenset(),
            is_over=self._is_over(),
            estimate_remaining=self._estimate_remaining,
            intervals=lambda: self._intervals(best),
        )

    def _intervals(self, shown: tuple[Leader, ...]) -> tuple[LeaderInterval, ...]:
        return tuple((each, self._samples.interval(each.configuration)) for each in shown)

    def _is_over(self) -> bool:
        return is_over(self._procedure, int(self._samples.runs.sum()), self._plan.max_runs)

    def _estimate_remaining(self) -> Range | None:
        """Return the range of the runs left: at least those of the round, at most the budget."""
        plan, procedure, pending = self._plan, self._procedure, self._store.pending
        request = procedure.next()
        if request is None or self._is_over():
            return NOTHING
        if self._rounds < MIN_ROUNDS:
            return None
        configurations, _, runs = request
        expected = plan.question.remaining(procedure, self._samples.sample, plan.confidence)
        most = math.inf if plan.max_runs is None else plan.max_runs - self._samples.runs.sum()
        low, high = remaining_range(expected, len(configurations) * runs, float(most))
        return low - pending, high - pending
