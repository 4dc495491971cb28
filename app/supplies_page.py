"""The tables of what can be bought and of materials, as their files hold them."""

from __future__ import annotations

import csv
from importlib.resources import files

Cell = float | str
Rows = list[dict[str, Cell]]

#: A table with at most so many rows is printed on its side: a column per row.
_FEW_ROWS = 4


def read_supplies() -> dict[str, Rows]:
    """Table name -> its rows, column -> cell; column names carry their units (`bore_mm`)."""
    designs = files("linkwright.designs")
    places = [p for folder in ("supplies", "language") for p in (designs / folder).iterdir() if p.name.endswith(".csv")]
    tables = {p.name.removesuffix(".csv"): p.read_text(encoding="utf-8") for p in places}
    return {name: [_cells(row) for row in csv.DictReader(text.splitlines())] for name, text in sorted(tables.items())}


def print_supplies(tables: dict[str, Rows]) -> None:
    """All tables; sources are left to `--json`."""
    from .console import digits, heading, page, table_of

    console = page()
    for name, rows in tables.items():
        heading(console, name)
        columns = [column for column in rows[0] if column != "source"]
        cells = [[c if isinstance(c, str) else digits(c) for c in map(row.__getitem__, columns)] for row in rows]
        # Blanks let a long column name fold at a word.
        titles = [column.replace("_", " ") for column in columns]
        if len(rows) <= _FEW_ROWS:
            titles, *cells = [list(line) for line in zip(titles, *cells, strict=True)]
        right = [i for i in range(1, len(titles)) if all(_is_number(line[i]) for line in cells)]
        console.print(table_of(titles, cells, right=right))


def _cells(row: dict[str, str]) -> dict[str, Cell]:
    return {column: float(text) if _is_number(text) else text for column, text in row.items()}


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
