"""Parts of panels: sections, paragraphs and tables; and numbers in words."""

from collections.abc import Iterable, Sequence

from agent_economy.types.brain import Point
from agent_economy.types.page import Cell, Choose, Colour, Column, Paragraph, Row, Section, Table

MAX_ROWS = 200
"""Longer tables take long to lay out."""


def section(heading: str | None = None) -> Section:
    """Return an empty section."""
    return {
        "heading": heading,
        "choice": None,
        "switch": None,
        "paragraphs": [],
        "button": None,
        "filter": None,
        "table": None,
        "legend": None,
    }


def plain(text: str) -> Paragraph:
    """Return a paragraph."""
    return {"text": text, "emphasis": "plain"}


def strong(text: str) -> Paragraph:
    """Return the statement that counts."""
    return {"text": text, "emphasis": "strong"}


def muted(text: str) -> Paragraph:
    """Return an explanation."""
    return {"text": text, "emphasis": "muted"}


def table(columns: Sequence[str], rows: Sequence[Row], *, total: int | None = None) -> Table:
    """Return a table; the label of a column of numbers begins with "#"."""
    heads: list[Column] = [
        {"label": label.removeprefix("#"), "is_number": label.startswith("#")} for label in columns
    ]
    return {
        "columns": heads,
        "rows": list(rows[:MAX_ROWS]),
        "total": len(rows) if total is None else total,
    }


def row(
    cells: Iterable[str | Cell],
    note: str | None = None,
    signals: Sequence[str] = (),
    *,
    at: Point | None = None,
) -> Row:
    """Return a row; `signals` are the ids of those that it displays, `at` the place it is about."""
    return {
        "cells": [cell(each) if isinstance(each, str) else each for each in cells],
        "note": note,
        "signals": signals,
        "at": at,
    }


def cell(
    text: str,
    note: str = "",
    colour: Colour | None = None,
    choice: Choose | None = None,
    *,
    is_chosen: bool = False,
) -> Cell:
    """Return a cell."""
    return {
        "text": text,
        "note": note,
        "colour": colour,
        "chooses": choice,
        "is_chosen": is_chosen,
    }


def percent(probability: float) -> str:
    """Return a probability in words: "3.1%", "63%", "over 99.9%" or "0.02%"."""
    value = 100 * probability
    if 99.9 < value < 100.001:  # noqa: PLR2004  (rounded to 100%, it would be a certainty)
        return "over 99.9%"
    if value >= 10:  # noqa: PLR2004  (two figures)
        return f"{value:.0f}%"
    if value < 0.01:  # noqa: PLR2004  (two decimals)
        return "under 0.01%" if value > 0 else "0%"
    return f"{float(f'{value:.2g}'):g}%"


def plural(count: int, word: str) -> str:
    """Return a number of things: "1 mine", "2 mines"."""
    return f"{count:,} {word}{'' if count == 1 else 's'}"
