"""Pages of docs whose tables and pictures are drawn from what was measured.

A table stands between `<!-- NAME -->` and `<!-- end -->`; the numbers and the pictures stand in the
folder beside the page that has its name.
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
    """A page of docs; `make NAME` measures and draws it."""

    name: str

    @property
    def folder(self) -> Path:
        """Return where its numbers and pictures are."""
        return ROOT / "docs" / self.name

    def draw(self, table: Callable[[str], str], pictures: dict[str, Spec]) -> None:
        """Write what is stale of its tables and pictures, each found by its name.

        With `--check` among the program's arguments it only exits with 1 if there is any.
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
        """Yield each picture and the page, with what should be in them."""

        def block(found: re.Match[str]) -> str:
            return f"<!-- {found[1]} -->\n{table(found[1])}\n<!-- end -->"

        for name, spec in pictures.items():
            yield self.folder / f"{name}.svg", picture(spec)
        page = self.folder.with_suffix(".md")
        old = page.read_text(encoding="utf-8")
        yield page, re.sub(r"<!-- (\w+) -->\n.*?<!-- end -->", block, old, flags=re.DOTALL)


def is_stale(file: Path, text: str) -> bool:
    """Return whether a file says another thing; pictures are compared by what they were drawn from.

    How wide letters are, and so where a picture has its parts, can differ from machine to machine.
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
