"""The sections of a report in their order: notes, charts and tables."""

from collections.abc import Iterator

from agent_economy.study.answer.goal_time import in_words
from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.paths import robot_kind
from agent_economy.study.report import goal_table, tables
from agent_economy.study.report.any_view import AnyView
from agent_economy.study.report.clearance_section import clearance
from agent_economy.study.report.formatting import MINUS, TIMES, brief, count, percent
from agent_economy.study.report.merit_view import MeritView
from agent_economy.study.report.section import Picture, Section
from agent_economy.study.report.view import MAX_SHOWN, factor_name
from agent_economy.study.selection import percentage


def sections(view: MeritView) -> Iterator[Section]:
    """Return the sections that the answer has data for."""
    yield merit(view)
    if view.is_grid:
        yield heat(view)
    if view.with_clearance:
        yield clearance(view)
    yield failed(view)
    if view.with_goal_time:
        yield goal_time(view)
    if view.compares:
        yield front(view)
        yield from (saturation(view, found) for found in view.saturations)
        yield history(view)
    if view.answer.sensitivity:
        yield sensitivity(view)
    if view.answer.efforts:
        yield efforts(view)
    yield times(view)
    if view.answer.published:
        yield published(view)
    if view.answer.omissions:
        yield omissions(view)


def merit(view: MeritView) -> Section:
    """Return the section on the figure of merit."""
    notes = [formula(view), f"{together(view)} {cut(view, 'the best by merit')}".strip()]
    pictures = []
    if view.compares:
        pictures.append(Picture("merit", "Figure of merit with its interval"))
        others = f"the {len(view.nearest)} next best" if len(view.nearest) > 1 else "the other one"
        shows = f"Difference from the selected configuration: {others}, run by run (shaded: delta)"
        pictures.append(Picture("behind", shows))
        notes.append(
            "Verdicts: tied within delta means that the merit differs from the selected one by at "
            f"most {brief(view.answer.delta)}; worse, that it is lower; not better by delta, that "
            "it is not higher by more than delta; undecided, that the intervals prove none of "
            "these. The guarantee includes eliminated configurations whose verdict is undecided."
        )
        notes += meaning_of_differences(view)
    if view.impossible:
        notes.append(
            f"{count(len(view.impossible), 'configuration')} cannot be run, because all first runs "
            "were quarantined, and cannot be selected."
        )
    found = (tables.merit(view),)
    return Section("Figure of merit", tuple(notes), tuple(pictures), found, is_folded=False)


def meaning_of_differences(view: MeritView) -> list[str]:
    """Return what negative differences from the selected one mean; nothing if there are none."""
    behind = [view.result(index).standing.behind for index in view.shown]
    if all(each is None or each.value >= 0 for each in behind):
        return []
    note = (
        "Differences are the merit of the selected configuration minus that of the other one, in "
        "their common runs. Where one is negative, the other one has the higher mean there; its "
        "verdict states what the runs prove."
    )
    return [note]


def heat(view: MeritView) -> Section:
    """Return the section on the merit over two factors."""
    across, down = map(factor_name, view.varied)
    shows = "Mean merit of every combination; the selected one is framed, those not decided marked"
    heading = f"Merit by {across} and {down}"
    note = "Combinations without a mark are proved to be worse, or cannot be run."
    return Section(heading, (note,), (Picture("heat", shows),), tables.heat(view))


def formula(view: MeritView) -> str:
    """Return the formula of the merit."""
    merit = view.answer.scenario.merit
    parts = ((brief(term.weight), weighed(term.column, term.max)) for term in merit.terms)
    summed = " + ".join(map(f" {TIMES} ".join, parts)).replace(f"+ {MINUS}", f"{MINUS} ")
    return f"Merit of a run = {summed} ({merit.name}). Higher is better."


def weighed(column: str, limit: float | None) -> str:
    """Return the quantity of a term."""
    return column if limit is None else f"min({column}, {brief(limit)})"


def together(view: MeritView) -> str:
    """Return the meaning of intervals and verdicts."""
    return (
        "All intervals and verdicts hold simultaneously, for all configurations and quantities, "
        f"with {percentage(view.answer.confidence)} confidence."
    )


def cut(view: MeritView, which: str) -> str:
    """Return which configurations are shown if these are not all."""
    total = len(view.known)
    if total <= MAX_SHOWN:
        return ""
    return f"{MAX_SHOWN} of {total:,} configurations are shown, {which}; answer.json contains all."


def failed(view: MeritView) -> Section:
    """Return the section on failed runs."""
    notes = [f"Intervals as above. {cut(view, 'the best by merit')}".strip()]
    if view.with_goal_time:
        notes.append(
            "A run fails if it is not complete when it ends: complete means that all goals are "
            "served, or what end.when of the scenario states."
        )
    pictures = (Picture("failed", "Share of runs that failed, with its interval"),)
    return Section(
        "Failures",
        tuple(notes),
        pictures if view.compares else (),
        (tables.failed(view),),
        is_folded=view.compares,
    )


def goal_time(view: AnyView) -> Section:
    """Return the section on where the time of a goal goes."""
    own = [
        f"{view.names[index]}: {in_words(time)}"
        for index, time in view.with_goal_time.items()
        if index == view.selected
    ]
    meaning = (
        "Waiting: from the issue of a goal until the robot that serves it sets out, so for its "
        "award and for the robot to finish other goals. Travel: from there to the arrival. "
        "Blocked: the time in which the robot stood under way. Service: from the arrival until "
        "the goal is served. Means over all goals served. A larger team serves them sooner "
        "only as far as one of these parts becomes shorter."
    )
    return Section(
        "Where the time of a goal goes",
        (*own, meaning),
        (Picture("goal-time", "Mean time from the issue of a goal until it is served"),),
        (goal_table.goal_time(view),),
    )


def front(view: MeritView) -> Section:
    """Return the section on the Pareto front of price, time and failures."""
    total = len(view.known)
    out = sum(view.result(index).place.dominated_by is not None for index in view.known)
    note = (
        "A configuration is dominated if another of no higher price is proved to be faster and to "
        f"fail less often: {out:,} of {total:,}. The others are possibly efficient. "
        f"{cut(view, 'the possibly efficient first')}"
    )
    picture = Picture(
        "front", "Price and mean time with its interval; larger marks fail more often"
    )
    return Section("Price, time and failures", (note.strip(),), (picture,), (tables.front(view),))


def saturation(view: MeritView, found: Saturation) -> Section:
    """Return the section on whether a larger team is worth its price."""
    number = view.saturations.index(found)
    shows = f"Gain of more than {found.base:,} {factor_name(found.path)} (dashed: delta)"
    return Section(
        f"How many {factor_name(found.path)} are enough",
        (saturation_in_words(view, found),),
        (Picture(f"saturation-{number}", shows),) if found.gains else (),
        (tables.gains(view, found),) if found.gains else (),
    )


def saturation_in_words(view: MeritView, found: Saturation) -> str:
    """Return how many robots are enough, as far as it is decided."""
    proved, possible = found.proved, found.possible
    largest = found.sizes[-1]
    weighs_robots = (
        robot_kind(found.path) is not None and "robots" in view.answer.scenario.merit.columns
    )
    enough = (
        f"A number is enough if no larger compared one (up to {largest:,}) gains more than "
        f"{brief(view.answer.delta)} of merit"
        f"{', after the cost of its robots' if weighs_robots else ''}."
    )
    if proved == possible == largest:
        return (
            f"Not reached: for every number below {largest:,}, a larger one is proved to be better."
        )
    if proved > possible:
        return f"Undecided between {possible:,} and {proved:,}. {enough}"
    little = (
        " A larger one gains more than nothing, but less than that." if proved < possible else ""
    )
    return f"Decided: {proved:,} are enough; no smaller number is proved to be. {enough}{little}"


def history(view: MeritView) -> Section:
    """Return the section on eliminations."""
    outs = sorted(each.eliminated.runs for each in view.answer.results if each.eliminated)
    note = "No configuration was eliminated."
    if outs:
        half, last = outs[(len(outs) - 1) // 2], outs[-1]
        note = (
            f"{len(outs):,} of {count(len(view.answer.results), 'configuration')} were eliminated: "
            f"half of them within {count(half, 'run')} each, the last after {last:,}. A "
            "configuration is eliminated when the runs prove that it is not better than another by "
            "delta."
        )
    picture = Picture("runs", "Runs per configuration until its elimination")
    notes = (f"{note} {cut(view, 'those with the most runs')}".strip(),)
    return Section("Eliminations", notes, (picture,), (tables.history(view),))


def sensitivity(view: MeritView) -> Section:
    """Return the section on the influence of factors."""
    note = (
        "Shares of the variance of the mean merit among the compared configurations. Alone: what a "
        "factor explains by itself (Sobol' index of first order). With interactions: what it "
        "explains by itself and together with others (total index); as an interaction counts for "
        "each of its factors, these shares may add up to more than 100%."
    )
    picture = Picture("sensitivity", "Share of each factor, with its 95% interval")
    notes = (note, *basis_of_shares(view))
    return Section("Influence of factors", notes, (picture,), (tables.sensitivity(view),))


def basis_of_shares(view: MeritView) -> Iterator[str]:
    """Yield what the shares of factors are based on."""
    found = view.answer.sensitivity
    if found is None:
        return
    yield (
        f"Noise of the runs is {percent(found.noise, 1)} of the variance of the observed means. It "
        "is subtracted, and the intervals show what it leaves uncertain."
    )
    if found.unexplained is not None:
        yield (
            "The shares are those of a polynomial in the factors, which leaves "
            f"{percent(found.unexplained, 1)} of the variance unexplained. Any factor may explain "
            "that part, so upper bounds include it."
        )
    if any(len(each.paths) > 1 for each in found.influences):
        yield (
            "Numbers of robots and controllers are one factor, the team, because not all of their "
            "combinations are compared."
        )


def efforts(view: MeritView) -> Section:
    """Return the section on smaller deltas."""
    note = (
        f"This study had a delta of {brief(view.answer.delta)} and took "
        f"{view.answer.runs:,} runs. The runs for smaller deltas are predicted from them."
    )
    heading, found = "Runs for a smaller delta", (tables.efforts(view),)
    return Section(heading, (note,), tables=found, is_folded=False)


def times(view: MeritView) -> Section:
    """Return the section on the times of runs."""
    note = f"Failed runs count with the time at which they ended. {cut(view, 'the best by merit')}"
    shows = "Median (diamond), middle 50% (box) and middle 90% (line) of the runs"
    tail = (
        "The time of success of a failed run is infinite; a mean with a time limit hides these. "
        "The quantiles of all configurations hold simultaneously, as a statement of their own, "
        f"with {percentage(view.answer.confidence)} confidence."
    )
    found = (tables.success_times(view), tables.times(view))
    return Section("Times", (note.strip(), tail), (Picture("times", shows),), found)


def published(view: MeritView) -> Section:
    """Return the section on published results."""
    theirs = view.answer.scenario.published
    source, time_limit_s = (theirs.source, brief(theirs.time_limit_s)) if theirs else ("", "")
    note = (
        f"The published runs, with a time limit of {time_limit_s} s, scored with the same figure "
        "of merit, with individual 95% intervals: Student's for merits, exact for failures."
    )
    shows = f"Figure of merit in this study and in {source}"
    pictures = (Picture("published", shows),) if view.published_axis else ()
    return Section(source, (note,), pictures, (tables.published(view),))


def omissions(view: MeritView) -> Section:
    """Return the section on side statements that could not be made."""
    notes = (f"{each.statement}: {each.reason}." for each in view.answer.omissions)
    return Section("Left out", tuple(notes))
