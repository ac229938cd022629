"""What people call a configuration: "4 rovers, 1 scout, contact touch"."""

from collections.abc import Mapping, Sequence

Values = Mapping[str, float | str]

TEAM = ("robots.", ".count")
"""How the path of a factor that is a team size begins and ends."""


def label(values: Values) -> str:
    """Return what people call a configuration that differs from others in these values."""
    lasts = [path.rsplit(".", 1)[-1] for path in values]
    parts = [
        # Two paths that end alike are told apart by all of them.
        part(path, value, is_short=lasts.count(last) == 1)
        for (path, value), last in zip(values.items(), lasts, strict=True)
    ]
    return ", ".join(parts) or "the scenario as it is"


def part(path: str, value: float | str, *, is_short: bool = True) -> str:
    """Return one value in words: "4 rovers" for robots.rover.count, else "time_limit_s 120"."""
    kind = robot_kind(path)
    if kind is not None:
        return f"{value} {kind}" if value == 1 else f"{value} {kind}s"
    written = f"{value:.10g}" if is_number(value) else word(value)
    return f"{path.rsplit('.', 1)[-1] if is_short else path} {written}"


def is_number(value: float | str) -> bool:
    """Return whether a factor's value is a number: no name, and neither true nor false."""
    return not isinstance(value, str | bool)


def word(value: float | str) -> str:
    """Return a name, true or false as scenarios write it."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def robot_kind(path: str) -> str | None:
    """Return the robot kind whose team size a path is, if it is one."""
    start, end = TEAM
    return path[len(start) : -len(end)] if path.startswith(start) and path.endswith(end) else None


def order(values: Values) -> str:
    """Return what to do: "Send 4 rovers", "Choose time_limit_s 120", "Send 4 rovers with time_limit_s 120"."""
    teams = {path: value for path, value in values.items() if robot_kind(path) is not None}
    others = {path: value for path, value in values.items() if path not in teams}
    if not values:
        return "The scenario as it is"
    if not teams:
        return f"Choose {label(others)}"
    return f"Send {label(teams)}" + (f" with {label(others)}" if others else "")


def varied(configurations: Sequence[Values]) -> tuple[str, ...]:
    """Return the paths that have more than one value among configurations."""
    paths = configurations[0]
    return tuple(path for path in paths if len({each[path] for each in configurations}) > 1)


def listed(words: list[str]) -> str:
    """Return "a", "a and b", "a, b and c"."""
    *most, last = words
    return f"{', '.join(most)} and {last}" if most else last
