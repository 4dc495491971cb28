"""How a table of purchased parts is read: one frozen row per line, refused where a number is missing or impossible.

A column is a field's name plus its unit in the file ("bore_mm"); several numbers in one cell are parted by blanks.
"""

from __future__ import annotations

import csv
import itertools
import math
from collections.abc import Iterable
from dataclasses import fields
from typing import Any, ClassVar, Protocol, TypeVar, get_type_hints

from .errors import DesignFileError
from .units import SUFFIXES, inside_from_file

#: Names of fields whose numbers must not fall in this order.
Chain = tuple[str, ...]


class Row(Protocol):
    """What the reader asks of a row's dataclass besides its fields.

    Attributes:
        name: unique in the table.
        grows: chains of fields.
        may_be_zero: fields for which 0 means "none"; all others must be above 0.
    """

    __dataclass_fields__: ClassVar[dict[str, Any]]
    grows: ClassVar[tuple[Chain, ...]]
    may_be_zero: ClassVar[tuple[str, ...]]

    @property
    def name(self) -> str:
        """Designation."""


AnyRow = TypeVar("AnyRow", bound=Row)


def read_table(path: str, lines: Iterable[str], kind: type[AnyRow]) -> dict[str, AnyRow]:
    """Rows by name from the lines of a table; `path` is what errors call it.

    Raises:
        DesignFileError: a column or number is missing or wrong, or the dimensions contradict each other.
    """
    reader = csv.DictReader(lines)
    wanted, columns = {f.name for f in fields(kind)}, {}
    for column in reader.fieldnames or ():
        field, _, suffix = column.rpartition("_")
        columns[column] = (field, suffix) if suffix in SUFFIXES and field in wanted else (column, "")
    present = {field for field, _ in columns.values()}
    for field in sorted(wanted ^ present):
        what = "is no column of this table" if field in present else "column is missing"
        raise DesignFileError(path, 1, field, None, what)
    table: dict[str, AnyRow] = {}
    for record in reader:
        if None in record:
            what = "has more cells than the table has columns"
            raise DesignFileError(path, reader.line_num, "row", record[None], what)
        values = {
            field: _parsed(path, reader.line_num, kind, field, suffix, record[column])
            for column, (field, suffix) in columns.items()
        }
        row = kind(**values)
        if row.name in table:
            raise DesignFileError(path, reader.line_num, "name", row.name, "stands in the table twice")
        _check_row(path, reader.line_num, row)
        table[row.name] = row
    return table


def _parsed(path: str, line: int, kind: type, field: str, suffix: str, text: str | None) -> Any:
    wanted = get_type_hints(kind)[field]
    try:
        if text is None:
            raise ValueError("the row ends before this column")
        if wanted in (float, tuple[float, ...]) and not suffix:
            raise ValueError(f"the column must name its unit, such as {field}_mm")
        if wanted is float:
            return inside_from_file(float(text), suffix)
        if wanted == tuple[float, ...]:
            return tuple(inside_from_file(float(word), suffix) for word in text.split())
        return wanted(text)
    except ValueError as error:
        raise DesignFileError(path, line, field, text, str(error)) from error


def _check_row(path: str, line: int, row: Any) -> None:
    for f in fields(row):
        value = getattr(row, f.name)
        for number in value if isinstance(value, tuple) else (value,):
            if isinstance(number, int | float) and not (
                math.isfinite(number) and (number > 0.0 or (number == 0.0 and f.name in row.may_be_zero))
            ):
                raise DesignFileError(path, line, f.name, number, "must be above 0")
        if isinstance(value, tuple) and (not value or any(a >= b for a, b in itertools.pairwise(value))):
            raise DesignFileError(path, line, f.name, value, "must be numbers that grow")
    for chain in row.grows:
        for small, large in itertools.pairwise(chain):
            if getattr(row, small) > getattr(row, large):
                raise DesignFileError(
                    path, line, small, getattr(row, small), f"must not exceed {large} = {getattr(row, large):g}"
                )
