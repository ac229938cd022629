"""Where the runs of a selection are: in a folder, or in memory only.

The folder is that of a study, whose study.toml states another kind. It is the same for all
questions about the same runs.
"""

import hashlib
import tomllib
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, closing, nullcontext
from functools import partial
from pathlib import Path
from typing import Any

import tomli_w

from agent_economy._core import InputError
from agent_economy.study.arguments import Floats
from agent_economy.study.run_block import Columns, Compute, Gathered, RunBlock, parts_of
from agent_economy.study.sampling.identity import identity
from agent_economy.study.sampling.plan import SelectionPlan
from agent_economy.study.sampling.sampler import COLUMNS
from agent_economy.study.store import Store
from agent_economy.study.store.differences import differing
from agent_economy.study.store.kind import SELECTION, is_selection

FORMAT = 1
"""Format version of the study.toml of a selection."""

HEADER = (
    "# A selection of Python. To continue it, repeat the call of select_best with this folder.\n"
)


class Unstored:
    """Runs that are not kept, with the interface of `Store`.

    Attributes:
        computed: Number of runs that were computed.
        pending: Number of runs that are known of the block that is requested.
    """

    computed = pending = 0

    def block(self, block: RunBlock, compute: Compute) -> Columns:
        """Return the outcomes of a block of runs, all of them computed."""
        self.pending = 0
        gathered = Gathered(block)
        with closing(parts_of(compute, block)) as parts:
            for part, data in parts:
                gathered.put(part, data)
                self.computed += part.rows
                self.pending += part.rows
        return gathered.columns

    def note(self, round: int, facts: dict[str, Any]) -> None:  # noqa: A002  (as Store's)
        """Record nothing."""


def opened(
    plan: SelectionPlan, folder: Path | None
) -> AbstractContextManager[Store] | AbstractContextManager[Unstored]:
    """Return the runs in a folder, which is created if it does not exist; None keeps no runs.

    Raises:
        InputError: If the sampler has no source; or the folder contains other runs, is damaged,
            in use, or cannot be written.
    """
    if folder is None:
        return nullcontext(Unstored())
    check = partial(may_replace, folder)
    return Store.open(folder, question(plan), COLUMNS, may_replace=check)


def question(plan: SelectionPlan) -> str:
    """Return the text of study.toml."""
    requested = plan.question.as_dict(plan.confidence)
    if plan.max_runs is not None:
        requested["max_runs"] = plan.max_runs
    document = {"format": FORMAT, "question": requested, "data": data(plan)}
    return SELECTION + HEADER + tomli_w.dumps(document)


def data(plan: SelectionPlan) -> dict[str, Any]:
    """Return what determines the runs, and which merits they may have."""
    sampled = plan.sampled
    return {
        "k": plan.k,
        **bounds(sampled.limits),
        "seed": sampled.seed,
        "common_random_numbers": sampled.are_shared,
        **identity(sampled.sampler),
    }


def bounds(limits: Floats) -> dict[str, Any]:
    """Return the outermost limits of merits; with a hash of all, if configurations differ."""
    outermost = [float(limits[:, 0].min()), float(limits[:, 1].max())]
    if (limits == outermost).all():
        return {"bounds": outermost}
    # Zeros have no sign, and bytes the same order on all machines.
    each = hashlib.sha256((limits + 0.0).astype("<f8").tobytes()).hexdigest()
    return {"bounds": outermost, "bounds_of_each": each}


def may_replace(folder: Path, existing: str, requested: str) -> bool:
    """Return True: a study.toml may replace another one that is about the same runs.

    Raises:
        InputError: If it is about other runs, which are named, or of a study, or damaged.
    """
    if not is_selection(existing):
        message = f"{folder}: contains a study, not a selection by select_best: use another folder"
        raise InputError(message)
    stored, wanted = parsed(folder, existing), tomllib.loads(requested)
    if stored["format"] != wanted["format"]:
        message = (
            f"{folder}: format = {stored['format']}: must be {FORMAT}: update this program, or use "
            "another folder"
        )
        raise InputError(message)
    lines = list(differences(stored["data"], wanted["data"]))
    if lines:
        message = f"{folder}: contains other runs: use another folder, or remove it"
        raise InputError("\n".join([message, *lines]))
    return True


def parsed(folder: Path, text: str) -> dict[str, Any]:
    """Return a study.toml that has the tables of a selection.

    Raises:
        InputError: If it has not.
    """
    try:
        document = tomllib.loads(text)
    except (tomllib.TOMLDecodeError, RecursionError):
        document = {}
    if isinstance(document.get("data"), dict) and "format" in document:
        return document
    message = f"{folder}: its study.toml is damaged: restore it, or use another folder"
    raise InputError(message)


def differences(stored: Mapping[str, Any], wanted: Mapping[str, Any]) -> Iterator[str]:
    """Yield what differs in what determines the runs."""
    hashes = {
        "bounds_of_each": "  the bounds of single configurations differ",
        "source": "  the source of the sampler, or of what it imports, was changed",
    }
    yield from differing(
        *({k: v for k, v in each.items() if k not in hashes} for each in (stored, wanted))
    )
    for key, statement in hashes.items():
        if stored.get(key) != wanted.get(key):
            yield statement
