"""Labels of configurations: "4 rovers, 1 base, allocation auction"."""

from collections.abc import Mapping, Sequence

from agent_economy.study.paths import (
    counted_kind,
    is_of_absent_kind,
    is_of_controllers,
    robot_kind,
)

Values = Mapping[str, float | str]


def label(values: Values) -> str:
    """Return the label of a configuration from its values of the varied factors.

    Controllers come after the robots, their number first. Factors of a kind whose number is 0 are
    left out.
    """
    values = dict(sorted(present(values).items(), key=place))
    lasts = [path.rsplit(".", 1)[-1] for path in values]
    parts = [
        # Paths with the same last key are written in full.
        part(path, value, is_short=lasts.count(last) == 1)
        for (path, value), last in zip(values.items(), lasts, strict=True)
    ]
    return ", ".join(parts) or "the scenario"


def present(values: Values) -> Values:
    """Return the values without those of kinds whose number is 0."""
    return {path: value for path, value in values.items() if not is_of_absent_kind(path, values)}


def place(item: tuple[str, float | str]) -> int:
    """Return the place of a factor in a label: 0 unless it is about controllers."""
    path, _ = item
    if not is_of_controllers(path):
        return 0
    return 2 if counted_kind(path) is None else 1


def part(path: str, value: float | str, *, is_short: bool = True) -> str:
    """Return one value in words: "4 rovers" for robots.rover.count, else "time_limit_s 120"."""
    kind = counted_kind(path)
    if kind is not None:
        return f"{value} {kind}" if value == 1 else f"{value} {kind}s"
    written = f"{value:.10g}" if is_number(value) else word(value)
    return f"{path.rsplit('.', 1)[-1] if is_short else path} {written}"


def is_number(value: float | str) -> bool:
    """Return whether a factor's value is a number, not a name, true or false."""
    return not isinstance(value, str | bool)


def word(value: float | str) -> str:
    """Return a name, true or false as scenarios write it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def recommendation(values: Values) -> str:
    """Return the recommendation: "Send 4 rovers", "Choose contact touch", or both.

    Kinds whose number is 0 are left out, unless all are.
    """
    values = present(values)
    teams = {path: value for path, value in values.items() if robot_kind(path) is not None}
    others = {path: value for path, value in values.items() if path not in teams}
    sent = {path: value for path, value in teams.items() if counted_kind(path) is None or value}
    teams = sent or teams
    if not values:
        return "One configuration, the scenario"
    if not teams:
        return f"Choose {label(others)}"
    return f"Send {label(teams)}" + (f" with {label(others)}" if others else "")


def varied(configurations: Sequence[Values]) -> tuple[str, ...]:
    """Return the paths that have more than one value among configurations."""
    paths = configurations[0]
    return tuple(path for path in paths if len({each[path] for each in configurations}) > 1)


def first(labels: list[str], count: int, others: str) -> list[str]:
    """Return the first of some labels, and how many `others` there are."""
    more = len(labels) - count
    return [*labels[:count], f"{more} {others}"] if more > 0 else labels


def listed(words: list[str]) -> str:
    """Return "a", "a and b", "a, b and c"."""
    *others, last = words
    return f"{', '.join(others)} and {last}" if others else last


def alternatives(words: list[str]) -> str:
    """Return "a", "a or b", "a, b or c"; with semicolons if a word contains a comma."""
    *others, last = words
    separator = "; " if any("," in word for word in words) else ", "
    return f"{separator.join(others)} or {last}" if others else last
