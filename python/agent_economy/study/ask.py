"""Ask a study: a scenario's question, one that was interrupted, or one that is answered already."""

import tempfile
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.scenario import Override, Scenario, Value, validation
from agent_economy.scenario.source import check_path
from agent_economy.study import files
from agent_economy.study import plan as plans
from agent_economy.study.answer.conclude import Answer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.labels import word
from agent_economy.study.arguments import Guarantee
from agent_economy.study.plan import Plan
from agent_economy.study.progress import OnProgress
from agent_economy.study.race import hold
from agent_economy.study.race import look as look_at
from agent_economy.study.rectangle import Compute, Rectangle
from agent_economy.study.report.script import ChartScript
from agent_economy.study.store import read


def run(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario,
    *,
    vary: Mapping[str, str | Iterable[Value]] | None = None,
    design: str | None = None,
    delta: float | None = None,
    confidence: float | None = None,
    guarantee: Guarantee = "indifference",
    runs: int | None = None,
    max_runs: int | None = None,
    seed: int = 0,
    out: str | Path | None = None,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
) -> Answer:
    """Return the answer to a scenario's question, as soon as there is proof.

    Args:
        scenario: What is run.
        vary: Values of each varied factor, by path, or a text of them such as "1..40"; None for
            what the scenario varies.
        design: "factorial", "lhs:N" or "sobol:N"; None for the scenario's.
        delta: The difference of mean merits worth finding; None for the scenario's, or 2% of the
            merit's range.
        confidence: Of the guarantee; None for the scenario's.
        guarantee: As in `select_best`.
        runs: Of each configuration; None for as few as it takes.
        max_runs: Of all together, after which it stops without a guarantee; None for no end.
        seed: 0 to 2^64 - 1.
        out: Folder of the study, to go on with and to look at; None keeps nothing.
        compute: What computes rectangles, such as `Workers`; None for threads in this process.
        on_progress: Called after each round, and each second or so of a long one.

    Raises:
        InputError: If anything is not allowed; or the folder holds another study, is damaged, or
            cannot be written.
    """
    validation.of_kind("scenario", scenario, Scenario, "a Scenario")
    validation.of_kind("vary", vary, Mapping | None, "a dict of values by their paths")
    changes = [varied(path, values) for path, values in (vary or {}).items()]
    if design is not None:
        changes.append(Override(("study", "design"), design, "design"))
    asked = plans.make(
        scenario.changed(tuple(changes)),
        seed=seed,
        delta=delta,
        confidence=confidence,
        guarantee=guarantee,
        runs=runs,
        max_runs=max_runs,
    )
    if out is not None:
        return pursue(asked, validation.path("out", out), compute=compute, on_progress=on_progress)
    with tempfile.TemporaryDirectory() as folder:
        return hold(asked, Path(folder), compute, on_progress)[0]


def resume(
    folder: str | Path,
    *,
    confidence: float | None = None,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
) -> Answer:
    """Go on with a study, or tighten a finished one to a higher confidence with all its runs.

    Raises:
        InputError: As in `run`; or if the folder holds no study.
    """
    asked = plan_of(folder)
    if confidence is not None:
        asked = plans.tightened(asked, confidence)
    return pursue(asked, folder, compute=compute, on_progress=on_progress)


def rebuild(folder: str | Path) -> Answer:
    """Rebuild the answer and the report of a finished study from its runs; computes none.

    Raises:
        InputError: If the folder holds no study, or one that is not finished.
    """
    return pursue(plan_of(folder), folder, compute=refuse(folder), anew=True)


def look(folder: str | Path) -> tuple[Answer, Evidence]:
    """Return the answer of a finished study and its runs; nothing is computed or written.

    Raises:
        InputError: If the folder holds no study, or one that is not finished.
    """
    return look_at(plan_of(folder), read(folder).stored(), refuse(folder))


def pursue(
    asked: Plan,
    folder: str | Path,
    *,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
    anew: bool = False,
) -> Answer:
    """Run a study, or go on with it, and leave its answer and report in its folder.

    Args:
        asked: What is asked.
        folder: Of the study; made if it is not there.
        compute: As in `run`.
        on_progress: As in `run`.
        anew: Whether to write the report though it is there already.

    Raises:
        InputError: As in `run`.
    """
    validation.of_kind("asked", asked, Plan, "a Plan, as make_plan returns")
    place = validation.path("folder", folder)
    with ChartScript() as script:

        def finish(answer: Answer, evidence: Evidence) -> None:
            if anew or not files.are_there(place, answer):
                files.write(place, answer, evidence, script)

        return hold(asked, place, compute, on_progress, finish)[0]


def varied(path: str, values: str | Iterable[Value]) -> Override:
    """Return what varies a factor.

    Raises:
        InputError: If the path is no text, or the values are no list.
    """
    check_path("vary", path)
    validation.of_kind(
        f"vary: {path}", values, Iterable, 'a list of values or a text, such as "1..40"'
    )
    return Override(("study", "vary", path), written(values), "vary")


def written(values: str | Iterable[Value]) -> str:
    """Return values of a factor as scenarios have them."""
    return values if isinstance(values, str) else ",".join(map(word, values))


def plan_of(folder: str | Path) -> Plan:
    """Return what is asked of the study in a folder.

    Raises:
        InputError: If there is none.
    """
    store = read(folder)
    return plans.read(store.asked, str(Path(folder) / "study.toml"), store.content)


def refuse(folder: str | Path) -> Compute:
    """Return what computes nothing, because nothing should be missing."""

    def compute(rectangle: Rectangle) -> Any:
        message = (
            f"{folder}: is not finished ({rectangle} are missing): go on with "
            f"agent-economy study --resume {folder}"
        )
        raise InputError(message)

    return compute
