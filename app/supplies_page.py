"""The tables of what can be bought and of materials, as their files hold them."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from importlib.resources import files

Cell = float | str
Rows = list[dict[str, Cell]]

#: A table with at most so many rows is printed on its side: a column per row.
_FEW_ROWS = 4

#: A table with more columns after the name is printed in several, each with the name in front.
_FEW_COLUMNS = 7


def read_supplies() -> dict[str, Rows]:
    """Table name -> its rows, column -> cell; column names carry their units (`bore_mm`)."""
    designs = files("linkwright.designs")
    places = [p for folder in ("supplies", "language") for p in (designs / folder).iterdir() if p.name.endswith(".csv")]
    tables = {p.name.removesuffix(".csv"): p.read_text(encoding="utf-8") for p in places}
    return {name: [_cells(row) for row in csv.DictReader(text.splitlines())] for name, text in sorted(tables.items())}


def print_supplies(tables: dict[str, Rows]) -> None:
    """All tables; sources are left to `--json`."""
    from .console import heading, page, table_of

    console = page()
    for name, rows in tables.items():
        heading(console, name)
        columns = [column for column in rows[0] if column != "source"]
        if len(rows) <= _FEW_ROWS:
            lines = [[column.replace("_", " "), *(_shown(row[column]) for row in rows)] for column in columns]
            console.print(table_of(lines[0], lines[1:], whole=(0,)))
            continue
        first, *others = columns
        for some in _batched(others, _FEW_COLUMNS):
            # Blanks let a long column name fold at a word.
            titles = [column.replace("_", " ") for column in (first, *some)]
            cells = [[_shown(row[column]) for column in (first, *some)] for row in rows]
            right = [i for i in range(1, len(titles)) if all(_is_number(line[i]) for line in cells)]
            console.print(table_of(titles, cells, right=right, whole=(0,)))


def _cells(row: dict[str, str]) -> dict[str, Cell]:
    return {column: float(text) if _is_number(text) else text for column, text in row.items()}


def _batched(words: Sequence[str], n: int) -> list[Sequence[str]]:
    """The words in groups of n; the last may be shorter."""
    return [words[i : i + n] for i in range(0, len(words), n)]


def _shown(cell: Cell) -> str:
    return cell if isinstance(cell, str) else f"{cell:g}"


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
