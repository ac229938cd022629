"""Classical procedures, to measure ours against and to teach with."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from agent_economy import _core
from agent_economy._core import InputError
from agent_economy.given import fault, is_whole
from agent_economy.study.arguments import (
    LEAST_CONFIDENCE,
    MAX_CONFIGURATIONS,
    Floats,
    is_between,
)
from agent_economy.study.selection import LANE, SAMPLER, Integers, Sampler, drive, shaped

MAX_KN = 2000

Name = Literal["equal", "rinott", "kn"]


@dataclass(frozen=True)
class Reference:
    """What a reference procedure selected, after how many runs of each; shape (k,)."""

    best: int
    runs: Integers


def reference(  # noqa: PLR0913  (keywords with defaults)
    name: Name,
    sampler: Sampler,
    k: int,
    *,
    runs: int,
    delta: float = 1.0,
    confidence: float = 0.95,
    seed: int = 0,
) -> Reference:
    """Select the best of k configurations as others do.

    Args:
        name: "equal": `runs` of each, the highest mean is chosen, with no guarantee. "rinott": two
            stages, a first one of `runs`. "kn": Kim and Nelson's sequential procedure after a first
            stage of `runs`. The last two hold for normal merits only.
        sampler: As in `select_best`; merits must be finite.
        k: How many configurations, 1 to 100,000 (to 2,000 for "kn", which compares all pairs).
        runs: 2 to 1,000,000.
        delta: As in `select_best`; "equal" has no use for it.
        confidence: Likewise.
        seed: As in `select_best`.

    Raises:
        InputError: If anything is not allowed, or a merit is not finite.

    Source: Rinott (1978), Communications in Statistics A7; Kim and Nelson (2001), ACM Transactions
        on Modeling and Computer Simulation 11.
    """
    most = MAX_KN if name == "kn" else MAX_CONFIGURATIONS
    sure = is_between(confidence, np.nextafter(LEAST_CONFIDENCE, 0), 1)
    names = get_args(Name)
    faults = [
        *fault(name in names, "name", name, "one of " + ", ".join(map(repr, names))),
        *fault(callable(sampler), "sampler", sampler, SAMPLER),
        *fault(is_whole(k, 1, most), "k", k, f"a whole number from 1 to {most}"),
        *fault(is_whole(runs, 2, 10**6), "runs", runs, "a whole number from 2 to 1000000"),
        *fault(is_between(delta, 0, np.inf), "delta", delta, "a number above 0"),
        *fault(sure, "confidence", confidence, "a number from 0.5 to below 1"),
        *fault(is_whole(seed, 0, 2**31 - 1), "seed", seed, "a whole number from 0 to 2147483647"),
    ]
    if faults:
        raise InputError("\n".join(faults))

    def ask(configurations: Integers, first_run: int, count: int) -> Floats:
        given = sampler(configurations, seed * LANE + first_run, count)
        merits = shaped(given, (len(configurations), count))
        if not np.isfinite(merits).all():
            message = "the sampler must return finite merits"
            raise InputError(message)
        return merits

    procedure = _core.reference(name, k, delta=delta, confidence=confidence, runs=runs)
    for _ in drive(procedure, ask):
        pass
    return Reference(procedure.best, procedure.runs)
