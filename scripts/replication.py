"""Recompute every table of docs/replication.md, and write them to the page.

Tables are between `<!-- NAME -->` and `<!-- end -->`. The outcomes of every possible start are in
docs/replication/starts.csv, which a test of the simulator writes and compares
(crates/classic/tests/starts.rs). Examples:

    python scripts/replication.py            regenerate the page
    python scripts/replication.py --check    exit with 1 if the page is out of date
"""

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from itertools import groupby
from pathlib import Path

import numpy as np
from measured import ROOT, Page, table
from numpy.typing import NDArray
from scipy import stats

import agent_economy as ae
from agent_economy import arrow
from agent_economy._core import CONTACTS
from agent_economy.study.answer import published as theirs
from agent_economy.study.answer.any_answer import expect_best
from agent_economy.study.answer.evidence import Evidence
from agent_economy.study.race import run_race

PAGE = Page("replication")
SCENARIO = ae.Scenario.load(ROOT / "scenarios" / "classic.toml")

Counted = tuple[NDArray[np.float64], NDArray[np.intp]]
"""Distinct paints to completion, and the number of runs with each."""

TIMED_TEAMS = (1, 2, 3, 4)
"""Teams with plausible data: those of the fifth repeat the first's, the rest are all 120 s."""

RUNS = 10_000
"""Number of runs per team of 1 to 8."""

HAND_TIMING_S = 1.0
"""Standard deviation of a time measured by hand and rounded to seconds."""

RATE_STEP = 0.5
RATES = tuple(float(rate) for rate in np.arange(5.0, 90.5, RATE_STEP))
"""Candidate values of paints per second."""

SHEET_MEANS = (-21.9, -28.76, -11.73, -12.02, -24.7, -42.2, -42.3, -43.6)
"""Figures of merit of 1 to 8 robots in the thesis's appendix."""


@dataclass(frozen=True)
class Starts:
    """Every possible start of a team, and the number of those that never complete."""

    contact: str
    robots: int
    starts: int
    never: int


def main() -> None:
    """Write the page, or check it."""
    PAGE.draw(lambda name: TABLES[name](), {})


def never() -> str:
    """Return the exact share of starts that never complete, for one and two robots."""

    def share(row: Starts) -> str:
        return f"{row.never:,} of {row.starts:,} ({row.never / row.starts:.2%})"

    groups = groupby(PAGE.read("starts", Starts), key=lambda row: row.contact)
    rows = ([contact, *map(share, group)] for contact, group in groups)
    return table(["contact", "1 robot", "2 robots"], rows)


def medians() -> str:
    """Return median decisions to completion and the share proven never to complete."""
    teams = (3, 4, 5, 6, 8)

    def cell(contact: str, robots: int) -> str:
        paints = paints_of(contact, robots, 10_000)
        decisions = np.maximum(0, np.floor((paints - 1) / 11))
        return f"{np.median(decisions):.0f} ({np.mean(np.isinf(paints)):.2%})"

    rows = ([contact, *(cell(contact, robots) for robots in teams)] for contact in CONTACTS)
    return table(["contact", *(f"{robots} robots" for robots in teams)], rows)


def fit() -> str:
    """Return, for each contact, the paints per second of the highest likelihood."""
    return table(
        [
            "contact",
            "most likely paints/s",
            "within 1.92",
            "log-likelihood",
            "mean s, 1 to 4",
            "failed, 1 to 4",
        ],
        map(fit_row, CONTACTS),
    )


def fit_row(contact: str) -> list[str]:
    """Return the best constant of a contact, and its results."""
    scores, good = fitted(contact)
    best = max(scores, key=scores.__getitem__)
    results = [capped(counted(contact, robots), best) for robots in TIMED_TEAMS]
    means, failed = zip(*results, strict=True)
    return [
        contact,
        f"{best:g}",
        pieces(good),
        f"{scores[best]:.1f}",
        ", ".join(f"{mean:.0f}" for mean in means),
        ", ".join(f"{share:.2f}" for share in failed),
    ]


@cache
def fitted(contact: str) -> tuple[dict[float, float], list[float]]:
    """Return the log-likelihood of each constant, and the constants close to the best."""
    paints = {robots: counted(contact, robots) for robots in TIMED_TEAMS}
    scores = {rate: log_likelihood(paints, rate) for rate in RATES}
    least = max(scores.values()) - float(stats.chi2.ppf(0.95, 1)) / 2
    return scores, [rate for rate, score in scores.items() if score > least]


@cache
def counted(contact: str, robots: int) -> Counted:
    """Return the distinct paints to completion of 100,000 runs, with their frequencies."""
    return np.unique(paints_of(contact, robots, 100_000), return_counts=True)


def pieces(rates: list[float]) -> str:
    """Return constants as ranges of consecutive values."""
    starts = [rate for rate in rates if rate - RATE_STEP not in rates]
    ends = [rate for rate in rates if rate + RATE_STEP not in rates]
    ranges = zip(starts, ends, strict=True)
    return ", ".join(f"{low:g}" if low == high else f"{low:g} to {high:g}" for low, high in ranges)


def log_likelihood(paints: dict[int, Counted], rate: float) -> float:
    """Return the log-likelihood of the published times of one to four robots."""
    total = 0.0
    for robots, (values, counts) in paints.items():
        shares = counts / counts.sum()
        observed = np.array(published()[robots])
        at_time_limit = observed >= SCENARIO.time_limit_s
        gaps = observed[~at_time_limit, np.newaxis] - values / rate
        density = stats.norm.pdf(gaps, scale=HAND_TIMING_S) @ shares
        beyond = shares[values / rate >= SCENARIO.time_limit_s].sum()
        # A time that no run took counts as half a run, so that it is not impossible.
        least = 0.5 / counts.sum()
        total += float(np.sum(np.log(np.maximum(density, least))))
        total += float(np.sum(at_time_limit) * np.log(max(beyond, least)))
    return total


def capped(paints: Counted, rate: float) -> tuple[float, float]:
    """Return the mean capped time and the share of failed searches."""
    values, counts = paints
    times = np.minimum(values / rate, SCENARIO.time_limit_s)
    return (
        float(np.average(times, weights=counts)),
        float(np.average(times >= SCENARIO.time_limit_s, weights=counts)),
    )


def teams() -> str:
    """Return our times and failures with the published ones, at the constant of the scenario."""
    published_by_size = {team.robots: team for team in theirs.results(SCENARIO)}

    def row(team: ae.study.Result) -> list[str]:
        published = published_by_size[size(team)]
        return [
            str(size(team)),
            f"{team.time_s.value:.1f}",
            f"{published.time_s:.1f}",
            f"{team.failed.value:.2%}",
            f"{published.failed} of {len(published.times_s)}",
            f"{team.merit.value:.2f}",
            f"{published.merit.value:.2f}",
        ]

    header = ["robots", "mean s", "thesis", "failed", "thesis", "merit", "thesis"]
    return table(header, map(row, studied(SCENARIO)[0].results))


def claims() -> str:
    """Return the evidence of the published data and our runs on the three claims of the thesis."""
    one, two = (np.array(published()[robots]) for robots in (1, 2))
    student = stats.ttest_ind(one, two).pvalue
    rank = stats.mannwhitneyu(one, two).pvalue
    by_size = {size(team): team for team in studied(SCENARIO)[0].results}
    behind = by_size[3].standing.behind
    assert behind is not None  # noqa: S101  (the study's answer is 4)
    times = ", ".join(f"{by_size[robots].time_s.value:.1f}" for robots in (5, 6, 7, 8))
    failed = ", ".join(f"{round(by_size[robots].failed.value * RUNS)}" for robots in (5, 6, 7, 8))
    rows = [
        [
            "p-value, two robots slower than one in the published data (Student's t, two-sided)",
            f"{student:.2f}",
        ],
        ["the same with the Mann-Whitney U test", f"{rank:.2f}"],
        ["difference of merit between 4 and 3 robots", f"{behind.value:.3f}"],
        ["its 95% interval", f"{behind.low:.3f} to {behind.high:.3f}"],
        [
            "probability that 3 robots seem best in ten runs per team, equation 5.2",
            three_look_best("equation-5.2"),
        ],
        ["the same with the appendix's figure of merit", three_look_best("appendix")],
        ["mean time of 5, 6, 7, 8 robots, s", times],
        ["failed searches of 5, 6, 7, 8 robots, in 10,000", failed],
    ]
    return table(["figure", "value"], rows)


def three_look_best(merit: str) -> str:
    """Return how often 3 robots are best when each team of 1 to 8 has ten runs."""
    rng = np.random.default_rng(2003)
    _, evidence = studied(SCENARIO.replace("merit", merit))
    merits = [team.columns["merit"] for team in evidence.samples]
    means = [rng.choice(each, (20_000, 10)).mean(axis=1) for each in merits]
    return f"{np.mean(np.argmax(means, axis=0) + 1 == 3):.0%}"  # noqa: PLR2004


def rates() -> str:
    """Return the best team, and its ties, at each constant that agrees with the times."""
    best_scores = {contact: max(fitted(contact)[0].values()) for contact in CONTACTS}
    likely = [each for each in CONTACTS if best_scores[each] > max(best_scores.values()) - 2]
    answers = [(contact, rate) for contact in likely for rate in fitted(contact)[1]]
    rows = [(*best_and_ties(contact, rate), contact, rate) for contact, rate in answers]
    groups = groupby(rows, key=lambda row: (row[2], row[0], row[1]))
    return table(
        ["contact", "paints/s", "best team", "tied or undecided"],
        ([each[0], pieces([row[3] for row in group]), *each[1:]] for each, group in groups),
    )


def best_and_ties(contact: str, rate: float) -> tuple[str, str]:
    """Return the answer of the study with another contact and constant."""
    other = SCENARIO.replace("contact", contact).replace("clock.paints_per_s", rate)
    answer, _ = studied(other)
    open_ = [
        size(team) for team in answer.results if team.standing.verdict not in {"best", "worse"}
    ]
    return str(size(answer.results[answer.best])), ", ".join(map(str, open_)) or "none"


def studied(scenario: ae.Scenario) -> tuple[ae.study.Answer, Evidence]:
    """Return the answer from a number of runs per team."""
    with tempfile.TemporaryDirectory() as folder:
        answer, evidence = run_race(ae.study.make_plan(scenario, runs=RUNS), Path(folder))
        return expect_best(answer), evidence


def size(team: ae.study.Result) -> int:
    """Return a team's size."""
    (robots,) = team.values.values()
    return int(robots)


def slips() -> str:
    """Return both figures of merit from the published times, and those of the thesis."""
    merits = {name: scored(name) for name in ("equation-5.2", "appendix")}

    def row(index: int, sheet: float) -> list[str]:
        equation, appendix = (merits[name][index] for name in ("equation-5.2", "appendix"))
        return [
            str(index + 1),
            f"{equation:.2f}",
            f"{appendix:.2f}",
            f"{sheet:.2f}",
            f"{sheet - appendix:+.2f}",
        ]

    header = ["robots", "equation 5.2", "with T instead of T/10", "spreadsheet", "difference"]
    return table(header, (row(index, sheet) for index, sheet in enumerate(SHEET_MEANS)))


def scored(merit: str) -> list[float]:
    """Return the figures of merit of the published teams, by the name of a definition."""
    return [team.merit.value for team in theirs.results(SCENARIO.replace("merit", merit))]


def published() -> dict[int, list[float]]:
    """Return the published times by team size."""
    assert SCENARIO.published is not None  # noqa: S101  (the bundled scenario has them)
    return SCENARIO.published.times_s


def paints_of(contact: str, robots: int, runs: int) -> NDArray[np.float64]:
    """Return paints to completion, infinite if it never completes."""
    team = SCENARIO.replace("contact", contact).replace("robots.wanderer.count", robots)
    return arrow.floats(ae.replicate(team, runs)["paints"], np.inf)


TABLES: dict[str, Callable[[], str]] = {
    "never": never,
    "medians": medians,
    "fit": fit,
    "rates": rates,
    "teams": teams,
    "claims": claims,
    "slips": slips,
}

if __name__ == "__main__":
    main()
