"""Paths of factors that are numbers of robots or controllers of a kind."""

from collections.abc import Mapping

ROBOTS, CONTROLLERS, COUNT = "robots.", "controllers.", ".count"
"""Prefixes and the suffix of the path of a factor that is such a number."""


def robot_kind(path: str) -> str | None:
    """Return the robot kind whose team size a path is, if it is one."""
    return kind_between(ROBOTS, path)


def counted_kind(path: str) -> str | None:
    """Return the kind of robots or controllers whose number a path is, if it is one."""
    return kind_between(ROBOTS, path) or kind_between(CONTROLLERS, path)


def is_of_controllers(path: str) -> bool:
    """Return whether a path is about controllers."""
    return path.startswith(CONTROLLERS)


def kind_between(start: str, path: str) -> str | None:
    """Return what is between a prefix and the suffix of a number."""
    is_count = path.startswith(start) and path.endswith(COUNT)
    return path[len(start) : -len(COUNT)] if is_count else None


def number_of(path: str) -> str | None:
    """Return the path of the number of robots or controllers of the kind that a path is about."""
    if not path.startswith((ROBOTS, CONTROLLERS)) or path.count(".") < len(("table", "kind")):
        return None
    table, kind, _ = path.split(".", 2)
    return f"{table}.{kind}{COUNT}"


def is_of_absent_kind(path: str, values: Mapping[str, object]) -> bool:
    """Return whether a path is about a kind of which values of factors have none, by its number."""
    number = number_of(path)
    return number not in {None, path} and values.get(number) == 0
