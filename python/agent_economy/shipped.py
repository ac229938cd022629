"""The scenarios that come with the program."""

from difflib import get_close_matches
from importlib.resources import files
from pathlib import Path


def scenarios() -> dict[str, Path]:
    """Return the files of all, by name; they are files, since our package is never zipped."""
    folder = Path(str(files("agent_economy") / "scenarios"))
    return {file.stem: file for file in sorted(folder.glob("*.toml"))}


def find(given: str | Path) -> Path:
    """Return the file of a scenario: what is given if it is a file, else the one so named.

    Returns:
        What is given where it is neither.
    """
    file = Path(given)
    return file if file.is_file() else scenarios().get(str(given), file)


def meant(file: Path) -> str:
    """Return which one was perhaps meant by a file that is not there, as the end of a sentence."""
    near = get_close_matches(file.name, scenarios(), 1)
    return f"; did you mean {near[0]}?" if near else ""
