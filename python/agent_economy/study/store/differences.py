"""How a study.toml differs from the one in a folder with other runs.

What determines the runs is named, by its path in the scenario; the questions may differ.
"""

import difflib
import tomllib
from collections.abc import Iterator, Mapping
from typing import Any

MAX_SHOWN = 6
"""Maximum number of differing lines in an error."""

QUESTION = ("merit", "require", "summary", "published", "study.minimize", "study.delta")
"""Keys of a scenario that are of its question, or are descriptions."""


def differences(existing: str, requested: str) -> str:
    """Return the first values that differ, those that determine the runs; else the first lines."""
    try:
        one, other = run_keys(existing), run_keys(requested)
    except (LookupError, TypeError, ValueError, AttributeError):  # not written by a plan
        one, other = {}, {}
    lines = list(differing(one, other)) or differing_lines(existing, requested)
    more = [f"  and {len(lines) - MAX_SHOWN} more lines"] if len(lines) > MAX_SHOWN else []
    return "\n".join([*lines[:MAX_SHOWN], *more]) or "  they differ in line endings"


def differing(one: Mapping[str, Any], other: Mapping[str, Any]) -> Iterator[str]:
    """Yield each value that is not the same in both, by its path."""
    for key in dict.fromkeys((*one, *other)):
        if one.get(key) != other.get(key):
            yield f"  existing: {written(key, one)}"
            yield f"  requested: {written(key, other)}"


def written(key: str, values: Mapping[str, Any]) -> str:
    """Return a value with its path."""
    return f"no {key}" if values.get(key) is None else f"{key} = {values[key]!r}"


def differing_lines(existing: str, requested: str) -> list[str]:
    """Return the lines that are not the same in both."""
    diff = difflib.ndiff(existing.splitlines(), requested.splitlines())
    words = {"- ": "existing", "+ ": "requested"}
    return [f"  {words[line[:2]]}: {line[2:]}" for line in diff if line[:2] in words]


def run_keys(text: str) -> dict[str, Any]:
    """Return what determines the runs of a study.toml, by path."""
    data = tomllib.loads(text)["data"]
    scenario = dict(flat(tomllib.loads(data["scenario"])))
    for change in data["changes"]:
        path = ".".join(change["path"])
        scenario = {key: old for key, old in scenario.items() if not is_within(key, path)}
        scenario |= dict(flat({path: change["value"]}))
    of_runs = {
        key: value
        for key, value in scenario.items()
        if not any(is_within(key, path) for path in QUESTION)
    }
    own = {key: data.get(key) for key in ("program", "seed", "runs")}
    parts = {name: data.get(name, {}) for name in ("files", "brains", "controllers")}
    return own | of_runs | dict(flat(parts))


def flat(table: Mapping[str, Any], prefix: str = "") -> Iterator[tuple[str, Any]]:
    """Yield the values of a table and of those in it, by path."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from flat(value, f"{prefix}{key}.")
        else:
            yield f"{prefix}{key}", value


def is_within(key: str, path: str) -> bool:
    """Return whether a path is another one, or inside of it."""
    return key == path or key.startswith(f"{path}.")
