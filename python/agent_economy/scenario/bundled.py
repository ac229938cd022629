"""The scenarios that ship with the package."""

from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path


def scenarios() -> dict[str, Path]:
    """Return the file of each bundled scenario, by name, in alphabetical order."""
    # They are real files: the package is never installed as a zip archive.
    folder = Path(str(files("agent_economy") / "scenarios"))
    return {file.stem: file for file in sorted(folder.glob("*.toml"))}


def find(name: str | Path) -> Path:
    """Return `name` if it is a file, else the bundled scenario of that name.

    Returns:
        `name` as a path if it is neither.
    """
    file = Path(name)
    return file if file.is_file() else scenarios().get(str(name), file)


def suggestion(file: Path) -> str:
    """Return the end of an error about a missing file: a bundled scenario with a similar name."""
    near = get_close_matches(file.name, scenarios(), 1)
    return f"; did you mean {near[0]}?" if near else ""
