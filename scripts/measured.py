"""Pages of docs with tables and charts that are generated from measurements.

A table is between `<!-- NAME -->` and `<!-- end -->`. The measurements and the charts are in the
folder next to the page that has its name.
"""

import csv
import io
import re
import sys
import time
from collections.abc import Callable, Iterable
from dataclasses import astuple, dataclass, fields
from pathlib import Path
from typing import Any, TypeVar

import msgspec
from plots import Spec, picture

from agent_economy.whole_file import replacing, write_whole

ROOT = Path(__file__).resolve().parent.parent

Kind = TypeVar("Kind")


@dataclass(frozen=True)
class Page:
    """A page of docs."""

    name: str

    @property
    def folder(self) -> Path:
        """Return the folder of its measurements and charts."""
        return ROOT / "docs" / self.name

    def write(self, name: str, kind: type, rows: Iterable[Any]) -> None:
        """Write rows of a dataclass to a CSV with six digits, and print them as they come."""
        began_s = time.monotonic()
        with replacing(self.folder / f"{name}.csv") as stream:
            file = io.TextIOWrapper(stream, encoding="utf-8", newline="", write_through=True)
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(field.name for field in fields(kind))
            for row in rows:
                short = [float(f"{x:.6g}") if isinstance(x, float) else x for x in astuple(row)]
                writer.writerow(short)
                print(f"{time.monotonic() - began_s:.0f} s:", *short, flush=True)

    def read(self, name: str, kind: type[Kind]) -> list[Kind]:
        """Return the rows of a CSV; an empty cell is None."""
        with (self.folder / f"{name}.csv").open(encoding="utf-8", newline="") as file:
            return [
                msgspec.convert({key: x or None for key, x in row.items()}, kind, strict=False)
                for row in csv.DictReader(file)
            ]

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
            write_whole(file, text.encode())
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
