"""Where a value of a scenario comes from, as errors name it."""

from agent_economy import _core
from agent_economy.scenario.source import Source


def with_origin(source: Source, *path: str | int) -> str:
    """Return a path for an error message, after the option, or the file and line, of its value."""
    written = "".join(f"[{key}]" if isinstance(key, int) else f".{key}" for key in path)[1:]
    for override in reversed(source.overrides):
        if override.path == path[: len(override.path)]:
            return f"{override.origin}: {written}"
    line = _core.Document(source.file, source.text).error(path, "", [])["line"]
    return f"{source.file}:{line}: {written}" if line else written
