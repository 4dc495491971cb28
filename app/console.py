"""What people read: a console, and tables in one style."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence

import click
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

#: Columns of a page when no terminal says how wide it is.
PAGE_WIDTH = 120


def page() -> Console:
    """A console on stdout that takes no markup from the words of a design."""
    width = None if sys.stdout.isatty() else PAGE_WIDTH
    return Console(markup=False, highlight=False, width=width)


def heading(console: Console, text: str) -> None:
    """A line that opens a part of the page."""
    console.print()
    console.print(Text(text, style="bold"))


def table_of(
    columns: Sequence[str], rows: Iterable[Sequence[str]], *, right: Sequence[int] = (), whole: Sequence[int] = ()
) -> Table:
    """A table of texts; the columns `right` (from 0) are aligned to the right, those in `whole` are not folded."""
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, collapse_padding=True)
    for i, name in enumerate(columns):
        longest = max((len(word) for word in name.split()), default=1)
        table.add_column(
            name, justify="right" if i in right else "left", overflow="fold", no_wrap=i in whole, min_width=longest
        )
    for row in rows:
        table.add_row(*(Text(cell) for cell in row))
    return table


def digits(value: float, n: int = 6) -> str:
    """A number for reading, `n` significant digits."""
    return f"{value + 0.0:.{n}g}"


def note(text: str) -> None:
    """A line on stderr, beside what stdout carries."""
    click.echo(text, err=True)
