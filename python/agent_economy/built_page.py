"""The built page of this package, and what to do if it is missing."""

from importlib.resources import files
from pathlib import Path
from shlex import quote

PAGE = Path(str(files("agent_economy") / "web"))
"""The folder of the page, which `packaging/backend.py` builds."""


def missing_page(page: Path = PAGE) -> str | None:
    """Return that the page has not been built, and the command that builds it; None if it has."""
    if (page / "index.html").is_file():
        return None
    clone = page.parent.parent.parent
    missing = f"the page has not been built: {page / 'index.html'} is missing"
    if not (clone / "web" / "package.json").is_file():
        return f"{missing}; install the package again: pip install --force-reinstall agent-economy"
    return f"{missing}; build it with Node 20 or newer: make -C {quote(str(clone))} web"
