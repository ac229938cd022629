"""Run studies, resume them, and read their answers."""

import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from agent_economy._core import InputError
from agent_economy.runs.python_brains import Brains, Controllers
from agent_economy.scenario import Override, Scenario, Value, as_scenario, validation
from agent_economy.scenario.source import check_path
from agent_economy.shell_word import shell_word
from agent_economy.study import files
from agent_economy.study import plan as plans
from agent_economy.study.answer.any_answer import AnyAnswer
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.answer.labels import word
from agent_economy.study.answer.requirement import RequirementAnswer
from agent_economy.study.arguments import Guarantee
from agent_economy.study.errors import NoMoreRunsError
from agent_economy.study.plan import Plan
from agent_economy.study.progress import OnProgress
from agent_economy.study.race import answer_of, run_race
from agent_economy.study.report.script import ChartScript
from agent_economy.study.run_block import Compute, RunBlock
from agent_economy.study.store import read


def run(  # noqa: PLR0913  (keywords with defaults)
    scenario: Scenario | str | Path,
    *,
    vary: Mapping[str, str | Iterable[Value]] | None = None,
    only_vary: bool = False,
    design: str | None = None,
    merit: str | Mapping[str, Any] | None = None,
    require: str | Sequence[str] | None = None,
    probability: float | None = None,
    tolerance: float | None = None,
    minimize: str | None = None,
    where: str | None = None,
    delta: float | None = None,
    confidence: float | None = None,
    guarantee: Guarantee | None = None,
    decide: bool = False,
    runs: int | None = None,
    max_runs: int | None = None,
    brains: Brains | str | None = None,
    controllers: Controllers | str | None = None,
    seed: int = 0,
    out: str | Path | None = None,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
) -> AnyAnswer:
    """Run the study of a scenario until its answer is settled, and return the answer.

    The question of a scenario with a requirement is the cheapest configuration that meets it,
    unless `delta`, `guarantee` or `runs` select the best by merit.

    Args:
        scenario: The scenario, its file, or the name of a bundled one.
        vary: Values of each varied factor, by path, as a list or a string such as "1..40"; they are
            added to what the scenario varies. None for what the scenario varies.
        only_vary: Whether `vary` replaces what the scenario varies.
        design: "factorial", "lhs:N" or "sobol:N"; None for the scenario's.
        merit: A name, or weights by term, as in a scenario; None for the scenario's.
        require: What a mission must meet: a condition, or a list of them; None for the scenario's.
        probability: The share of missions that must meet it; above 0, below 1. None for the
            scenario's, or 0.95.
        tolerance: The share above `probability` that need not be found; None for the scenario's, or
            40% of 1 - `probability`.
        minimize: With a requirement, the cost of a team: "robots", "price", or an expression of
            team sizes; None for the scenario's.
        where: A condition on team sizes that selects the compared configurations; None for the
            scenario's.
        delta: Indifference zone, in units of merit, above 0; None for the scenario's, or 2% of the
            merit's range.
        confidence: Confidence of the guarantee, 0.5 to below 1; None for the scenario's.
        guarantee: As in `select_best`; None for "indifference".
        decide: With a requirement, whether to continue until cheaper teams that may meet it
            are decided at a quarter of the tolerance.
        runs: Fixed number of runs per configuration; None to stop when the answer is settled.
        max_runs: Run budget of all configurations together; if it is reached first, the answer has
            no guarantee, or that of the tolerance that was reached. None for no limit.
        brains: Brains in Python that replace those of the scenario, by kind of robots, as in
            `Simulation`: classes or functions at the top level of a module. Or the name of such a
            dict, "MODULE:NAME". The runs are computed by one process per processor, each of which
            imports the brains by name; without workers, the script must guard its code with
            `if __name__ == "__main__":`. The hash of their source, with the modules that it imports
            and that are not installed, identifies the study.
        controllers: Controllers in Python, by kind of controllers, as `brains`.
        seed: Seed of all random numbers, 0 to 2^64 - 1.
        out: Folder of the study; None stores nothing.
        compute: Computes blocks of runs, always the same for the same block. `Workers.columns`
            computes them on several workers; any other function is called for about half a second
            of runs at a time. None for this machine.
        on_progress: Called after each round, and about every second during a long one.

    Returns:
        An `Answer`, or a `RequirementAnswer` to the question of a requirement.

    Raises:
        InputError: If an argument is invalid; or the folder contains another study or runs of
            another build of this program, is damaged, or cannot be written.
    """
    validation.of_type("vary", vary, Mapping | None, "a dict of values by their paths")
    weights = "the name of a figure of merit, or a dict of weights"
    validation.of_type("merit", merit, str | Mapping | None, weights)
    conditions = "a condition, or a list of them"
    validation.of_type("require", require, str | list | tuple | None, conditions)
    options = {
        "study.design": design,
        "merit": merit if merit is None or isinstance(merit, str) else dict(merit),
        "require.all": [require] if isinstance(require, str) else require and list(require),
        "require.probability": probability,
        "require.tolerance": tolerance,
        "study.minimize": minimize,
        "study.where": where,
    }
    changes = factor_changes(vary or {}, only_vary=only_vary)
    changes += [
        Override(tuple(path.split(".")), value, path.split(".")[-1])
        for path, value in options.items()
        if value is not None
    ]
    plan = plans.make(
        as_scenario(scenario).changed(tuple(changes)),
        seed=seed,
        delta=delta,
        confidence=confidence,
        guarantee=guarantee,
        runs=runs,
        max_runs=max_runs,
        brains=brains,
        controllers=controllers,
    )
    if decide:
        plan = plans.decided(plan, max_runs=max_runs)
    if out is not None:
        return run_plan(plan, validation.path("out", out), compute=compute, on_progress=on_progress)
    with tempfile.TemporaryDirectory() as folder:
        return run_race(plan, Path(folder), compute, on_progress)[0]


def factor_changes(vary: Mapping[str, str | Iterable[Value]], *, only_vary: bool) -> list[Override]:
    """Return the overrides that vary factors, besides or instead of those of the scenario."""
    changes = [varied(path, values) for path, values in vary.items()]
    if not only_vary:
        return changes
    table = {each.path[-1]: each.value for each in changes}
    return [Override(("study", "vary"), table, "vary")]


def resume(  # noqa: PLR0913  (keywords with defaults)
    folder: str | Path,
    *,
    confidence: float | None = None,
    decide: bool = False,
    max_runs: int | None = None,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
) -> AnyAnswer:
    """Resume a study, or make a finished one more precise; all its runs are reused.

    Args:
        folder: Folder of the study.
        confidence: A higher confidence; None for the study's.
        decide: With a requirement, whether to continue until cheaper teams that may meet it
            are decided at a quarter of the tolerance so far.
        max_runs: With `decide`, the run budget of all configurations together, stored runs
            included; None for no limit.
        compute: As in `run`.
        on_progress: As in `run`.

    Raises:
        InputError: As in `run`; or if the folder contains no study.
    """
    plan = resumed_plan(folder, confidence=confidence, decide=decide, max_runs=max_runs)
    return run_plan(plan, folder, compute=compute, on_progress=on_progress)


def resumed_plan(
    folder: str | Path,
    *,
    confidence: float | None = None,
    decide: bool = False,
    max_runs: int | None = None,
) -> Plan:
    """Return the plan of a study that is resumed, as `resume` takes it.

    Raises:
        InputError: As in `resume`.
    """
    plan = load_plan(folder)
    if confidence is not None:
        plan = plans.with_confidence(plan, confidence)
    if max_runs is not None and not decide:
        message = f"max_runs = {max_runs}: must be left out without decide"
        raise InputError(message)
    if not decide:
        return plan
    answer = answer_so_far(folder)
    if not isinstance(answer, RequirementAnswer):
        return plans.decided(plan, max_runs=max_runs)
    if answer.is_guaranteed and answer.runs_to_decide is None:
        # There is nothing to decide.
        return plan
    return plans.decided(plan, reached=answer.requirement.tolerance, max_runs=max_runs)


def rebuild(folder: str | Path) -> AnyAnswer:
    """Rebuild the answer and the report of a finished study from its runs; computes none.

    The runs may be of another build: it stays in study.toml.

    Raises:
        InputError: If the folder contains no study, or an unfinished one.
    """
    plan = replace(load_plan(folder), computed_by=plans.build_of(read(folder).question))
    return run_plan(plan, folder, compute=refuse(folder), rewrite=True)


def load_answer(folder: str | Path) -> tuple[AnyAnswer, Evidence]:
    """Return the answer of a finished study and its runs, without computing or writing anything.

    Raises:
        InputError: If the folder contains no study, or an unfinished one.
    """
    return answer_of(load_plan(folder), read(folder).stored(), refuse(folder))


def answer_so_far(folder: str | Path) -> AnyAnswer | None:
    """Return what the stored runs of a study of a requirement prove, whether it is finished or not.

    Nothing is computed or written.

    Returns:
        None for another question, or without runs.

    Raises:
        InputError: If the folder contains no study, or no configuration can be run.
    """

    def compute(_: RunBlock) -> Any:
        raise NoMoreRunsError

    plan = load_plan(folder)
    if not plan.question.certifies:
        return None
    answer, _ = answer_of(plan, read(folder).stored(), compute)
    return answer if answer.runs else None


def run_plan(
    plan: Plan,
    folder: str | Path,
    *,
    compute: Compute | None = None,
    on_progress: OnProgress | None = None,
    rewrite: bool = False,
) -> AnyAnswer:
    """Run or resume a study, and write its answer and report to its folder.

    Args:
        plan: The question, as returned by `make_plan` or `load_plan`.
        folder: Folder of the study; created if it does not exist.
        compute: As in `run`.
        on_progress: As in `run`.
        rewrite: Whether to write the report even if it is up to date.

    Raises:
        InputError: As in `run`.
    """
    validation.of_type("plan", plan, Plan, "a Plan, as make_plan returns")
    place = validation.path("folder", folder)
    with ChartScript() as script:

        def finish(answer: AnyAnswer, evidence: Evidence) -> None:
            if rewrite or not files.are_current(place, answer):
                files.write(place, answer, evidence, script)

        return run_race(plan, place, compute, on_progress, finish)[0]


def varied(path: str, values: str | Iterable[Value]) -> Override:
    """Return the override that varies a factor.

    Raises:
        InputError: If the path is not a string, or the values are not a list.
    """
    check_path("vary", path)
    validation.of_type(
        f"vary: {path}", values, Iterable, 'a list of values or a string, such as "1..40"'
    )
    return Override(("study", "vary", path), written(path, values), "vary")


def written(path: str, values: str | Iterable[Value]) -> str:
    """Return values of a factor as scenarios write them.

    Raises:
        InputError: If they are not plain values in an order.
    """
    if isinstance(values, str):
        return values
    is_list = not isinstance(values, Mapping | set | frozenset | bytes)
    validation.check(is_list, f"vary: {path}", values, "a list of values, which has an order")
    return ",".join(word(validation.plain_value(f"vary: {path}", each)) for each in values)


def load_plan(folder: str | Path) -> Plan:
    """Return the plan of the study in a folder.

    Raises:
        InputError: If there is none.
    """
    store = read(folder)
    return plans.read(store.question, str(Path(folder) / "study.toml"), store.content)


def refuse(folder: str | Path) -> Compute:
    """Return a `compute` for finished studies: it raises an error if runs are missing."""

    def compute(_: RunBlock) -> Any:
        command = f"agent-economy study --resume {shell_word(folder)}"
        message = f"{folder}: is not finished: resume it with {command}"
        raise InputError(message)

    return compute
