"""Rows of numbers by named columns, as CSV or JSON lines: how poses and joint values come in and go out."""

from __future__ import annotations

import csv
import io
import json
import math
from collections.abc import Collection, Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.file.keys import did_you_mean
from linkwright.designs.language.errors import LinkwrightError
from linkwright.designs.language.joints import Joint
from linkwright.designs.language.mechanism import Coordinate
from linkwright.designs.language.units import SUFFIXES

#: Columns that ik and fk add to their answers; both accept them back, so that one reads what the other writes.
VERDICT = ("reachable", "reason")

FORMATS = ("csv", "jsonl")


class RowError(LinkwrightError):
    """Rows that cannot be read: names source, line, column and what is allowed."""

    def __init__(self, source: str, line: int, what: str) -> None:
        super().__init__(f"{source}:{line}: {what}")
        self.source, self.line, self.what = source, line, what


@dataclass(frozen=True, slots=True, kw_only=True)
class Rows:
    """Rows as read.

    Attributes:
        source: name of the file for errors.
        form: "csv" or "jsonl".
        rows: column -> cell, one mapping per row; None for an empty cell.
        lines: line of each row in the source.
    """

    source: str
    form: str
    rows: tuple[dict[str, Any], ...]
    lines: tuple[int, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Numbers:
    """The wanted columns as numbers in inside units.

    Attributes:
        values: shape (n, n_columns) [mm, rad]; zero where a row is without values.
        blanks: for each row why it has no values, empty if it has them.
    """

    values: np.ndarray
    blanks: tuple[str, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Column:
    """A column of a file and the factor from its unit to the one inside."""

    key: str
    factor: float


def task_columns(task: Sequence[Coordinate]) -> tuple[Column, ...]:
    """Columns of a pose: `<coordinate>_<unit>`."""
    return tuple(Column(key=c.key, factor=SUFFIXES[c.unit] if c.unit else 1.0) for c in task)


def joint_columns(joints: Sequence[Joint]) -> tuple[Column, ...]:
    """Columns of joint values: `<joint name>_deg` or `_mm`."""
    return tuple(Column(key=f"{j.name}_{j.unit}", factor=SUFFIXES[j.unit]) for j in joints)


def read_rows(text: str, source: str, form: str | None = None) -> Rows:
    """Rows of a text; without a form, a text that begins with `{` is JSON lines.

    Raises:
        RowError: a line is not a row, or there is none.
    """
    form = form or ("jsonl" if text.lstrip().startswith("{") else "csv")
    found = list(_json_rows(text, source) if form == "jsonl" else _csv_rows(text, source))
    if not found:
        raise RowError(source, 1, "there is no row: the input is empty")
    lines, rows = zip(*found, strict=True)
    return Rows(source=source, form=form, rows=rows, lines=lines)


def numbers_of(rows: Rows, wanted: Sequence[Column], ignored: Collection[str] = ()) -> Numbers:
    """The wanted columns of all rows; other columns than these and the ignored ones are refused.

    A row without any value is kept as a blank, with the reason that the row gives; a row with some values missing is
    an error.

    Raises:
        RowError: a column is unknown or missing, or a cell is no finite number.
    """
    keys = [column.key for column in wanted]
    values, blanks = np.zeros((len(rows.rows), len(keys))), []
    for i, (row, line) in enumerate(zip(rows.rows, rows.lines, strict=True)):
        _check_columns(row, keys, ignored, rows.source, line)
        empty = [key for key in keys if row[key] is None]
        if len(empty) == len(keys):
            blanks.append(f"no values given: {row.get('reason') or 'the row is empty'}")
            continue
        if empty:
            raise RowError(rows.source, line, f"column {empty[0]} is empty")
        values[i] = [_number(row[key], key, rows.source, line) for key in keys]
        blanks.append("")
    return Numbers(values=values * [column.factor for column in wanted], blanks=tuple(blanks))


def numbers_from_text(text: str, wanted: Sequence[Column], option: str) -> np.ndarray:
    """Comma separated numbers of one option, shape (n_columns,), in inside units.

    Raises:
        RowError: not as many finite numbers as columns.
    """
    cells = [cell.strip() for cell in text.split(",")]
    keys = [column.key for column in wanted]
    if len(cells) != len(keys):
        raise RowError(option, 1, f"{len(cells)} numbers where {len(keys)} belong: {','.join(keys)}")
    found = [_number(cell, key, option, 1) for cell, key in zip(cells, keys, strict=True)]
    return np.array(found) * [column.factor for column in wanted]


def text_of_rows(
    columns: Sequence[Column], values: np.ndarray, is_reachable: np.ndarray, reasons: Sequence[str], form: str
) -> str:
    """The answers as text: numbers with 15 significant digits, empty (null) where there is none, then the verdict."""
    shown = values / [column.factor for column in columns] + 0.0
    keys = [column.key for column in columns]
    if form == "jsonl":
        answers = [
            {**_json_cells(keys, row, ok), "reachable": bool(ok), "reason": reason}
            for row, ok, reason in zip(shown, is_reachable, reasons, strict=True)
        ]
        return "".join(json.dumps(answer, ensure_ascii=False) + "\n" for answer in answers)
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow([*keys, *VERDICT])
    for row, ok, reason in zip(shown, is_reachable, reasons, strict=True):
        cells = [_digits(v) for v in row] if ok else [""] * len(keys)
        writer.writerow([*cells, "true" if ok else "false", reason])
    return out.getvalue()


def _json_cells(keys: Sequence[str], row: np.ndarray, is_given: bool) -> dict[str, float | None]:
    return {key: float(_digits(v)) if is_given else None for key, v in zip(keys, row, strict=True)}


def _digits(value: float) -> str:
    if not math.isfinite(value):
        raise ValueError(f"a value that counts as reachable is {value}")
    return f"{value:.15g}"


def _csv_rows(text: str, source: str) -> Iterable[tuple[int, dict[str, Any]]]:
    reader = csv.reader(io.StringIO(text.removeprefix("\ufeff")), skipinitialspace=True)
    header: list[str] | None = None
    for cells in reader:
        cells = [cell.strip() for cell in cells]
        # Fewer cells than columns is a mistake; a line of nothing is a blank line, one with # a comment.
        if (not any(cells) and len(cells) <= 1) or (cells and cells[0].startswith("#")):
            continue
        if header is None:
            header = _checked_header(cells, source, reader.line_num)
            continue
        if len(cells) != len(header):
            raise RowError(source, reader.line_num, f"{len(cells)} cells where the header names {len(header)} columns")
        yield reader.line_num, {key: cell or None for key, cell in zip(header, cells, strict=True)}


def _checked_header(cells: list[str], source: str, line: int) -> list[str]:
    if all(_is_numeric(cell) for cell in cells):
        raise RowError(source, line, "the first line must name the columns")
    twice = next((cell for cell in cells if cells.count(cell) > 1), None)
    if twice is not None:
        raise RowError(source, line, f"column {twice!r} is named twice")
    return cells


def _is_numeric(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _json_rows(text: str, source: str) -> Iterable[tuple[int, dict[str, Any]]]:
    for line, row_text in enumerate(text.splitlines(), start=1):
        if not row_text.strip():
            continue
        try:
            row = json.loads(row_text)
        except json.JSONDecodeError as error:
            raise RowError(source, line, f"not a JSON object on one line: {error.msg}") from error
        if not isinstance(row, dict):
            raise RowError(source, line, "must be a JSON object of columns")
        yield line, row


def _check_columns(row: dict[str, Any], keys: Sequence[str], ignored: Collection[str], source: str, line: int) -> None:
    unknown = [key for key in row if key not in keys and key not in ignored and key not in VERDICT]
    if unknown:
        hint = did_you_mean(unknown[0], keys)
        raise RowError(source, line, f"there is no column called {unknown[0]!r}{hint}; columns: {','.join(keys)}")
    missing = [key for key in keys if key not in row]
    if missing:
        raise RowError(source, line, f"column {', '.join(missing)} is missing; columns: {','.join(keys)}")


def _number(cell: Any, key: str, source: str, line: int) -> float:
    is_number = isinstance(cell, int | float) and not isinstance(cell, bool)
    is_text = isinstance(cell, str) and "_" not in cell and _is_numeric(cell)
    from_file = float(cell) if is_number or is_text else math.nan
    if not math.isfinite(from_file):
        raise RowError(source, line, f"column {key} = {cell!r}: must be a finite number")
    return from_file
