"""The sections of a report, in their order: words, charts and tables."""

from collections.abc import Iterator
from dataclasses import dataclass

from agent_economy.study.answer.saturation import Saturation
from agent_economy.study.report import tables
from agent_economy.study.report.tables import Table
from agent_economy.study.report.view import MOST, View, factor_name
from agent_economy.study.report.writing import MINUS, TIMES, brief, count
from agent_economy.study.selection import certainty


@dataclass(frozen=True)
class Picture:
    """A chart by name, and what it shows in words."""

    name: str
    shows: str


@dataclass(frozen=True)
class Section:
    """A section of the page.

    Attributes:
        heading: What it answers.
        notes: How to read it, a paragraph each.
        pictures: Its charts.
        tables: Its numbers.
        is_folded: Whether its tables are closed until asked for.
    """

    heading: str
    notes: tuple[str, ...]
    pictures: tuple[Picture, ...] = ()
    tables: tuple[Table, ...] = ()
    is_folded: bool = True


def sections(view: View) -> Iterator[Section]:
    """Return the sections that have something to show."""
    yield merit(view)
    if view.is_grid:
        yield heat(view)
    yield failed(view)
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


def merit(view: View) -> Section:
    """Return who is how good, and how far behind the selected one."""
    notes = [formula(view), f"{together(view)} {cut(view, 'the best by merit')}".strip()]
    pictures = []
    if view.compares:
        pictures.append(Picture("merit", "Figure of merit with its range"))
        some = f"the {len(view.nearest)} nearest" if len(view.nearest) > 1 else "the other"
        shows = f"How far behind the selected one: {some}, compared run by run (shaded: delta)"
        pictures.append(Picture("behind", shows))
        notes.append(
            f"Tied within delta: differs from the selected one by {brief(view.answer.delta)} at "
            "most, for sure. Worse: for sure, if perhaps by little. No better: not by more than "
            "delta, for sure. Undecided: these ranges leave it open; what the guarantee says of "
            "those put out holds all the same."
        )
    found = (tables.merit(view),)
    return Section("Figure of merit", tuple(notes), tuple(pictures), found, is_folded=False)


def heat(view: View) -> Section:
    """Return the merit over two factors together."""
    across, down = map(factor_name, view.varied)
    picture = Picture("heat", "Mean merit of every pair; the selected one is framed")
    heading = f"Merit by {across} and {down}"
    return Section(heading, (), (picture,), tables.heat(view))


def formula(view: View) -> str:
    """Return how the merit is made up."""
    merit = view.answer.scenario.merit
    parts = ((brief(term.weight), weighed(term.column, term.max)) for term in merit.terms)
    summed = " + ".join(map(f" {TIMES} ".join, parts)).replace(f"+ {MINUS}", f"{MINUS} ")
    return f"Merit of a run = {summed} ({merit.name}). Higher is better."


def weighed(column: str, most: float | None) -> str:
    """Return what a term weighs."""
    return column if most is None else f"min({column}, {brief(most)})"


def together(view: View) -> str:
    """Return what ranges mean."""
    return (
        f"Ranges hold simultaneously: for all configurations and all quantities together, and at "
        f"any moment, with {certainty(view.answer.confidence)} confidence."
    )


def cut(view: View, which: str) -> str:
    """Return which configurations are shown, where these are not all."""
    total = len(view.answer.results)
    if total <= MOST:
        return ""
    return f"Shown are {MOST} of {total:,} configurations, {which}; answer.json has all."


def failed(view: View) -> Section:
    """Return how often runs fail."""
    pictures = (Picture("failed", "Share of runs that failed, with its range"),)
    return Section(
        "How often it fails",
        (f"Ranges as above. {cut(view, 'the best by merit')}".strip(),),
        pictures if view.compares else (),
        (tables.failed(view),),
        is_folded=view.compares,
    )


def front(view: View) -> Section:
    """Return which configurations somebody might want for price, time and success."""
    total = len(view.answer.results)
    out = sum(result.place.dominated_by is not None for result in view.answer.results)
    note = (
        "Surely dominated: the runs prove that another, which costs no more, is faster and fails "
        f"less often. That is true of {out:,} of {total:,}; the others are possibly efficient. "
        f"{cut(view, 'the possibly efficient first')}"
    )
    picture = Picture("front", "Price against mean time, with its range; larger: fails more often")
    return Section("Price, time and certainty", (note.strip(),), (picture,), (tables.front(view),))


def saturation(view: View, found: Saturation) -> Section:
    """Return whether a larger team is worth its price."""
    number = view.saturations.index(found)
    shows = f"What more {factor_name(found.path)} gain over {found.base:,} (dashed: delta)"
    return Section(
        f"How many {factor_name(found.path)} are enough",
        (saturation_in_words(view, found),),
        (Picture(f"saturation-{number}", shows),) if found.gains else (),
        (tables.gains(view, found),) if found.gains else (),
    )


def saturation_in_words(view: View, found: Saturation) -> str:
    """Return whether it is decided how many are enough."""
    proved, possible = found.proved, found.possible
    largest = found.sizes[-1]
    weighs_robots = "robots" in view.answer.scenario.merit.columns
    enough = (
        f"A number is enough if no larger one that was compared (up to {largest:,}) gains "
        f"{brief(view.answer.delta)} of merit over it"
        f"{', what its robots cost included' if weighs_robots else ''}."
    )
    if proved == possible == largest:
        return f"Not reached: every number below {largest:,} is surely beaten by a larger one."
    if proved > possible:
        return f"Undecided between {possible:,} and {proved:,}. {enough}"
    little = " A larger one gains something, but less than that." if proved < possible else ""
    return (
        f"Decided: {proved:,} are enough, and no smaller number is proved to be. {enough}{little}"
    )


def history(view: View) -> Section:
    """Return who was put out, when and by whom."""
    outs = sorted(each.eliminated.runs for each in view.answer.results if each.eliminated)
    note = "No configuration was put out."
    if outs:
        half, last = outs[(len(outs) - 1) // 2], outs[-1]
        note = (
            f"{len(outs):,} of {count(len(view.answer.results), 'configuration')} were put out: "
            f"half of these by {count(half, 'run')} each, the last after {last:,}. One goes out "
            "when the runs prove that it is not delta better than another; by how much it is "
            "worse may stay undecided."
        )
    picture = Picture("runs", "Runs that each configuration took before it was out")
    notes = (f"{note} {cut(view, 'those that took the most runs')}".strip(),)
    return Section("Who went out when", notes, (picture,), (tables.history(view),))


def sensitivity(view: View) -> Section:
    """Return which factors matter."""
    found = view.answer.sensitivity
    note = (
        "How much of the merit's spread among configurations comes from each factor. Alone: first "
        "order. With all its interactions: Borgonovo's delta."
    )
    chance = (
        f"{found.noise if found else 0:.0%} of that spread is chance, as means of few runs scatter."
    )
    picture = Picture("sensitivity", "Influence of each factor, with 95% bootstrap intervals")
    return Section("What matters", (note, chance), (picture,), (tables.sensitivity(view),))


def efforts(view: View) -> Section:
    """Return what a finer answer would take."""
    note = (
        f"This study looked for differences of {brief(view.answer.delta)} and took "
        f"{view.answer.runs:,} runs. Foretold from them:"
    )
    heading, found = "What a smaller delta would take", (tables.efforts(view),)
    return Section(heading, (note,), tables=found, is_folded=False)


def times(view: View) -> Section:
    """Return how long runs take."""
    note = f"Failed runs count with the time at which they ended. {cut(view, 'the best by merit')}"
    shows = "Diamond: median. Box: the middle half of the runs. Line: the middle nine tenths"
    return Section(
        "How long it takes", (note.strip(),), (Picture("times", shows),), (tables.times(view),)
    )


def published(view: View) -> Section:
    """Return what others found."""
    given = view.answer.scenario.published
    source, time_limit_s = (given.source, brief(given.time_limit_s)) if given else ("", "")
    note = (
        f"Its own runs, stopped at {time_limit_s} s, scored by the same figure of merit. Their ranges are "
        "95% intervals, each for itself: Student's of merits, exact of failures."
    )
    shows = f"Figure of merit in this study and in {source}"
    pictures = (Picture("published", shows),) if view.published_axis else ()
    return Section(source, (note,), pictures, (tables.published(view),))
