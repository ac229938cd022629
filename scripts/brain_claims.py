"""The sentences of docs/brain-comparison.md that state what its measurements show.

Their numbers are computed from the measurements, and what they claim is verified: if it is no
longer so, the page is not written and `--check` fails, with the claim. An order of brains is that
of their means.
"""

import textwrap
from collections import Counter
from collections.abc import Callable, Iterable
from itertools import takewhile

from brain_measurements import Answered, Measurements
from plots import Z95

NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")
"""Numbers up to ten are words."""

SMALL_TEAM = 4
RADIO_TEAMS = (3, 4, 6, 8)
"""The team sizes that radio helps most."""

RELIABLE_TEAM, RARE_FAILURES = 6, 0.02
"""Size from which on hardly any run of the best brains fails, and the share that this means."""

SINGLE_ROBOT_S = 6
"""Time by which brains differ that a single robot hardly gains from."""


class ClaimError(Exception):
    """The measurements no longer show what the page claims."""

    def __init__(self, claim: str) -> None:
        """State the claim."""
        super().__init__(f"the measurements no longer show that {claim}")


BAYES, FRONTIER, LAWNMOWER = (
    f"{name}, radio" for name in ("bayesian_search", "frontier", "lawnmower")
)


def wrapped(text: str) -> str:
    """Return a paragraph or an item of a list in lines of the page's width."""
    indent = "  " if text.startswith("* ") else ""
    return textwrap.fill(
        text, 110, subsequent_indent=indent, break_on_hyphens=False, break_long_words=False
    )


def listed(title: str, items: Iterable[str]) -> str:
    """Return a list below its title."""
    return "\n".join(map(wrapped, (title, "", *items)))


def verify(holds: bool, claim: str) -> None:  # noqa: FBT001  (a condition, as in assert)
    """Raise an error if a claim does not hold."""
    if not holds:
        raise ClaimError(claim)


def from_size(data: Measurements, is_so: Callable[[int], bool], claim: str) -> int:
    """Return the team size from which on something is so."""
    last, *smaller = reversed(data.sizes)
    verify(is_so(last), claim)
    return min([last, *takewhile(is_so, smaller)])


def word(number: int) -> str:
    """Return a number as the page writes it."""
    return NUMBERS[number] if number < len(NUMBERS) else str(number)


def selected(studies: Iterable[Answered]) -> str:
    """Return the team sizes that studies selected: "5", "5 or 6", "7 to 10"."""
    sizes = sorted({study.robots for study in studies})
    if len(sizes) == 1:
        return str(sizes[0])
    joint = "or" if sizes == [sizes[0], sizes[0] + 1] else "to"
    return f"{sizes[0]} {joint} {sizes[-1]}"


def votes(studies: Iterable[Answered]) -> str:
    """Return how many studies selected each team size: "5 (7 of 10), 6 (3 of 10)"."""
    counts = Counter(study.robots for study in studies)
    total = counts.total()
    return ", ".join(f"{size} ({count} of {total})" for size, count in sorted(counts.items()))


def mean_time_s(studies: list[Answered]) -> float:
    """Return the mean time of the teams that studies selected."""
    return sum(study.time_s for study in studies) / len(studies)


def mean_size(studies: list[Answered]) -> float:
    """Return the mean size of the teams that studies selected."""
    return sum(study.robots for study in studies) / len(studies)


def fastest_from(data: Measurements) -> int:
    """Return the team size from which on bayesian_search with radio is the fastest brain."""
    claim = "bayesian_search with radio is the fastest brain of large teams"
    return from_size(data, lambda robots: data.place(BAYES, robots, data.teams) == 1, claim)


def in_short(data: Measurements) -> str:
    """Return the summary."""
    bayes, bounce = data.studies[BAYES], data.studies["random_bounce"]
    verify(
        mean_size(bayes) < mean_size(bounce) and mean_time_s(bayes) < mean_time_s(bounce),
        "fewer robots with bayesian_search and radio replace those with random_bounce",
    )
    memory_gains_nothing(data)
    large_teams_differ_less(data)
    return wrapped(
        f"**In short.** With radio, `bayesian_search` is the fastest brain from "
        f"{word(fastest_from(data))} robots on, and {selected(bayes)} such robots replace "
        f"{selected(bounce)} that bounce at random. Memory without radio gains nothing. With many "
        "robots the choice of brain matters less."
    )


def memory_gains_nothing(data: Measurements) -> None:
    """Verify that frontier without radio is not sooner than random_bounce, nor later."""
    steps = data.steps["memory: frontier vs random_bounce"].values()
    verify(
        all(abs(step.sooner_s) <= Z95 * step.error_s for step in steps),
        "frontier without radio is as slow as random_bounce at every size",
    )


def large_teams_differ_less(data: Measurements) -> None:
    """Verify that the brains of the largest team differ less than those of a medium one."""
    largest_s = max(map(data.spread_s, data.sizes))
    verify(data.spread_s(data.sizes[-1]) < largest_s / 2, "brains matter less in large teams")


def helps(data: Measurements) -> str:
    """Return what helps."""
    items = (fastest_brains, radio_helps, rate_helps, few_collisions)
    return listed(best_with_radio(data), (item(data) for item in items))


def best_with_radio(data: Measurements) -> str:
    """Return that memory with radio is best."""
    for robots in data.sizes:
        best_s = min(data.time_s(brain, robots) for brain in data.teams)
        with_radio_s = min(data.time_s(brain, robots) for brain in (BAYES, FRONTIER))
        verify(with_radio_s == best_s, f"memory with radio is best with {robots} robots")
    return (
        "**What helps.** Robots that remember where they have observed **and share it by radio** "
        "search best at every team size."
    )


def fastest_brains(data: Measurements) -> str:
    """Return which brains are first and second."""
    first = fastest_from(data)
    second = from_size(
        data,
        lambda robots: data.place(FRONTIER, robots, set(data.teams) - {BAYES}) == 1,
        "frontier is second",
    )
    steps = data.steps["beliefs: bayesian_search vs lawnmower"]
    gains_s = [step.sooner_s for robots, step in steps.items() if robots >= first]
    failed = [
        data.teams[brain][robots].failed
        for brain in (BAYES, FRONTIER)
        for robots in data.sizes
        if robots >= RELIABLE_TEAM
    ]
    verify(max(failed) < RARE_FAILURES, "hardly any run fails from six robots on")
    return (
        f"* With radio, `bayesian_search` is the fastest of all from {word(first)} robots on, "
        f"{min(gains_s):.0f} to {max(gains_s):.0f} s faster than `lawnmower`. `frontier` is "
        f"second from {word(max(first, second))} robots on. From {word(RELIABLE_TEAM)} robots on, "
        f"at most {max(failed):.1%} of the runs of either fail."
    )


def radio_helps(data: Measurements) -> str:
    """Return how much radio helps."""
    steps = [data.steps[f"radio: {name}"] for name in ("frontier", "bayesian_search")]
    inside = [each[n].sooner_s for each in steps for n in RADIO_TEAMS]
    outside = [each[n].sooner_s for each in steps for n in data.sizes if n not in RADIO_TEAMS]
    sizes = f"{word(RADIO_TEAMS[0])} to {word(RADIO_TEAMS[-1])} robots"
    verify(min(inside) > max(outside), f"radio helps most with {sizes}")
    return f"* Radio helps most with {sizes}: {min(inside):.0f} to {max(inside):.0f} s."


def rate_helps(data: Measurements) -> str:
    """Return how much the expected rate of finds helps."""
    gains_s = {
        n: step.sooner_s for n, step in data.steps["rate: bayesian_search vs frontier"].items()
    }
    most = max(gains_s, key=lambda robots: gains_s[robots])
    largest = data.sizes[-1]
    verify(most <= SMALL_TEAM and gains_s[largest] > 0, "expected finds help most in small teams")
    return (
        "* Choosing places by expected finds per second (`bayesian_search`) instead of the nearest "
        "unobserved place (`frontier`) helps most in small teams: "
        f"{gains_s[most]:.0f} s with {word(most)} robots, {gains_s[largest]:.0f} s with {largest}."
    )


def few_collisions(data: Measurements) -> str:
    """Return how rarely both brains collide."""
    both = max(data.teams[brain][n].collisions for brain in (BAYES, FRONTIER) for n in data.sizes)
    others = max(data.teams["wanderers"][n].collisions for n in data.sizes)
    verify(both < others / 10, "both have hardly any collisions")
    return (
        f"* Both have hardly any collisions, at most {both:.2f} per run (wanderers {others:.2f}), "
        "because each robot has its own part of the field."
    )


def does_not_help(data: Measurements) -> str:
    """Return what does not help."""
    items = (single_robot, memory_alone, lawnmower_alone, bounce, large_teams)
    return listed("**What does not help.**", (item(data) for item in items))


def single_robot(data: Measurements) -> str:
    """Return how little a single robot gains."""
    verify(data.spread_s(1) < SINGLE_ROBOT_S, "a single robot gains little from any brain")
    return (
        "* A single robot gains little from any brain: the best and the worst are "
        f"{data.spread_s(1):.0f} s apart. 25 m by 25 m is too large for one robot in 120 s."
    )


def memory_alone(data: Measurements) -> str:
    """Return that memory alone has no effect."""
    memory_gains_nothing(data)
    return (
        "* Memory alone has no measurable effect: `frontier` without radio is as slow as "
        "`random_bounce` at every size. The nearest unobserved place is often a small remainder, "
        "and robots that share nothing search the same ground."
    )


def lawnmower_alone(data: Measurements) -> str:
    """Return when dividing the field is best, and that radio does not change it."""
    for alone, radio in zip(
        *(data.teams[name].values() for name in ("lawnmower", LAWNMOWER)), strict=True
    ):
        verify(alone.results == radio.results, "radio changes nothing for lawnmower")
    alone = [brain for brain in data.teams if not brain.endswith(", radio")]
    best = from_size(
        data,
        lambda robots: data.place("lawnmower", robots, alone) == 1,
        "lawnmower is best without radio",
    )
    return (
        "* Without radio, dividing the field beforehand (`lawnmower`) is best from "
        f"{word(best)} robots on. Radio changes nothing for it."
    )


def bounce(data: Measurements) -> str:
    """Return that random_bounce is not faster, but collides less often."""
    steps = data.steps["random_bounce vs wanderers"].values()
    verify(all(step.sooner_s <= Z95 * step.error_s for step in steps), "random_bounce is no faster")
    sizes = [robots for robots in data.sizes if robots > 1]
    own, others = (
        [data.teams[brain][robots].collisions for robots in sizes]
        for brain in ("random_bounce", "wanderers")
    )
    verify(
        all(few < many / 5 for few, many in zip(own, others, strict=True)),
        "random_bounce has far fewer collisions",
    )
    return (
        "* `random_bounce` is no faster than turning to the freer side, but has far fewer "
        f"collisions: {own[-1]:.2f} instead of {others[-1]:.2f} per run with {sizes[-1]} robots."
    )


def large_teams(data: Measurements) -> str:
    """Return how little the brains of the largest team differ."""
    large_teams_differ_less(data)
    largest = data.sizes[-1]
    return (
        f"* In large teams the brain matters less: with {largest} robots, the best and the worst "
        f"are {data.spread_s(largest):.0f} s apart."
    )


def needed(data: Measurements) -> str:
    """Return how many robots better brains need."""
    bayes, mower, bounce = (data.studies[name] for name in (BAYES, "lawnmower", "random_bounce"))
    merits = [sum(study.merit for study in each) / len(each) for each in (bayes, mower, bounce)]
    sizes = [mean_size(each) for each in (bayes, mower, bounce)]
    verify(
        merits == sorted(merits, reverse=True) and sizes == sorted(sizes),
        "better brains need fewer robots and use them better",
    )
    sooner_s = mean_time_s(bounce) - mean_time_s(bayes)
    verify(sooner_s > 0, "the teams with bayesian_search are done before those with random_bounce")
    return wrapped(
        f"Better brains need fewer robots and use them better: {selected(bayes)} with "
        f"`bayesian_search` and radio, {selected(mower)} with `lawnmower`, {selected(bounce)} with "
        f"`random_bounce`. The teams with `bayesian_search` are done {sooner_s:.0f} s before those "
        "with `random_bounce`."
    )
