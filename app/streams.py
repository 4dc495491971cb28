"""Where ik and fk read from and write to: options, files, pipes."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

import click
import numpy as np

from .rows import Column, Numbers, Rows, numbers_from_text, numbers_of, read_rows

input_option = click.option(
    "-i",
    "--input",
    "source",
    type=click.Path(dir_okay=False, allow_dash=True),
    help="File of rows to read; - or nothing reads a pipe. Without pipe or file the home pose is taken.",
)

format_option = click.option(
    "--format",
    "form",
    type=click.Choice(["csv", "jsonl"]),
    help="Form of input and output; by default the input is recognised and the output follows it.",
)


def rows_given(source: str | None, form: str | None) -> Rows | None:
    """The rows that the user hands over, or None if there are none (a terminal, /dev/null).

    Raises:
        RowError: rows that cannot be read, or an input without any.
        OSError: the file cannot be opened.
    """
    if source not in (None, "-"):
        return read_rows(Path(str(source)).read_text(encoding="utf-8-sig"), str(source), form)
    if source is None and not _is_fed():
        return None
    return read_rows(sys.stdin.read(), "stdin", form)


def numbers_given(
    texts: tuple[str, ...],
    option: str,
    rows: Rows | None,
    columns: tuple[Column, ...],
    ignored: tuple[str, ...],
    home: np.ndarray,
) -> Numbers:
    """Numbers from the option, else from the rows, else the home values, shape (n, n_columns) [mm, rad]."""
    if texts:
        values = np.stack([numbers_from_text(text, columns, option) for text in texts])
        return Numbers(values=values, blanks=("",) * len(texts))
    if rows is None:
        return Numbers(values=home[None, :], blanks=("",))
    return numbers_of(rows, columns, ignored)


def write_text(text: str, output: Path | None) -> None:
    """To the file, or to stdout without one."""
    if output is None:
        click.echo(text, nl=False)
    else:
        output.write_text(text, encoding="utf-8")


def tell_unreachable(n_unreachable: int, n: int, what: str) -> None:
    """How many rows have no answer, on stderr, where it cannot disturb the rows."""
    if n_unreachable:
        click.echo(f"{n_unreachable} of {n} {what} have no answer, see the column reason", err=True)


def _is_fed() -> bool:
    """Something is piped or redirected in: terminals and /dev/null are character devices and feed nothing."""
    try:
        return not stat.S_ISCHR(os.fstat(sys.stdin.fileno()).st_mode)
    except (OSError, ValueError, AttributeError):
        return sys.stdin is not None
