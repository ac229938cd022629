"""A section of a report."""

from dataclasses import dataclass

from agent_economy.study.report.tables import Table


@dataclass(frozen=True)
class Picture:
    """A chart by name, with its caption."""

    name: str
    shows: str


@dataclass(frozen=True)
class Section:
    """A section of the page.

    Attributes:
        heading: Its heading.
        notes: Explanations, a paragraph each.
        pictures: Its charts.
        tables: Its tables.
        is_folded: Whether its tables are initially closed.
    """

    heading: str
    notes: tuple[str, ...]
    pictures: tuple[Picture, ...] = ()
    tables: tuple[Table, ...] = ()
    is_folded: bool = True
