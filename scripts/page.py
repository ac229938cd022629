"""Pages of docs with tables and charts that are generated from measurements.

A table is between `<!-- NAME -->` and `<!-- end -->`. The measurements and the charts are in the
folder next to the page that has its name.
"""

import re
import sys
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from plots import Spec, picture

ROOT = Path(__file__).resolve().parent.parent


@dataclass(frozen=True)
class Page:
    """A page of docs, which `make NAME` measures and generates."""

    name: str

    @property
    def folder(self) -> Path:
        """Return the folder of its measurements and charts."""
        return ROOT / "docs" / self.name

    def draw(self, table: Callable[[str], str], pictures: dict[str, Spec]) -> None:
        """Write the stale tables and charts, which are identified by their names.

        With the program's argument `--check`, exit with 1 instead if there are any.
        """
        stale = {file: text for file, text in self.made(table, pictures) if is_stale(file, text)}
        if "--check" in sys.argv[1:]:
            if stale:
                names = ", ".join(str(file.relative_to(ROOT)) for file in stale)
                sys.exit(f"not what `make {self.name}` writes: {names}")
            return
        for file, text in stale.items():
            file.write_text(text, encoding="utf-8")
            print(file.relative_to(ROOT))

    def made(
        self, table: Callable[[str], str], pictures: dict[str, Spec]
    ) -> Iterable[tuple[Path, str]]:
        """Yield each chart and the page, with their current content."""

        def block(found: re.Match[str]) -> str:
            return f"<!-- {found[1]} -->\n{table(found[1])}\n<!-- end -->"

        for name, spec in pictures.items():
            yield self.folder / f"{name}.svg", picture(spec)
        page = self.folder.with_suffix(".md")
        old = page.read_text(encoding="utf-8")
        yield page, re.sub(r"<!-- (\w+) -->\n.*?<!-- end -->", block, old, flags=re.DOTALL)


def is_stale(file: Path, text: str) -> bool:
    """Return whether a file differs from its current content; charts are compared by their data.

    The widths of letters, and thus the layout of a chart, can differ among machines.
    """
    if not file.exists():
        return True
    old = file.read_text(encoding="utf-8")
    if file.suffix == ".svg":
        return old.splitlines()[-1] != text.splitlines()[-1]
    return old != text


def table(header: list[str], lines: Iterable[list[str]]) -> str:
    """Return a Markdown table."""
    lines = [header, ["---"] * len(header), *lines]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
