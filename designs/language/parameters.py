"""A number with its unit, its letter in the paper, its reason and its bounds: the one place where a default lives.

A section of a design is a frozen dataclass whose fields are made by `number`, `choice` or `count`. The design file,
its JSON Schema, its comments and its errors are all written from these fields.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from typing import Any

from .errors import ParameterError
from .units import file_from_inside

_KEY = "linkwright"


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Meta:
    """What is known about one field besides its value (bounds are in the unit inside)."""

    unit: str
    doc: str
    symbol: str
    above: float | None
    least: float | None
    most: float | None
    choices: tuple[str, ...]

    def allowed(self) -> str:
        """What would be right, in words, in the unit of the file."""
        if self.choices:
            return "one of " + ", ".join(self.choices)

        def show(bound: float) -> str:
            return f"{file_from_inside(bound, self.unit):g}{' ' + self.unit if self.unit else ''}"

        words = [f"above {show(self.above)}"] if self.above is not None else []
        words += [f"at least {show(self.least)}"] if self.least is not None else []
        words += [f"at most {show(self.most)}"] if self.most is not None else []
        return "must be " + " and ".join(words) if words else "must be a finite number"


def number(
    default: float,
    unit: str,
    doc: str,
    *,
    symbol: str = "",
    above: float | None = None,
    least: float | None = None,
    most: float | None = None,
) -> Any:
    """A field for a measured number; `default` and bounds in the unit inside (mm, rad, kg)."""
    meta = Meta(unit=unit, doc=doc, symbol=symbol, above=above, least=least, most=most, choices=())
    return dataclasses.field(default=float(default), metadata={_KEY: meta})


def length(
    default: float,
    doc: str,
    *,
    symbol: str = "",
    above: float | None = 0.0,
    least: float | None = None,
    most: float | None = None,
) -> Any:
    """A field for a length [mm], by default above zero."""
    return number(default, "mm", doc, symbol=symbol, above=None if least is not None else above, least=least, most=most)


def angle(default: float, doc: str, *, symbol: str = "", least: float | None = None, most: float | None = None) -> Any:
    """A field for an angle [rad inside, degrees in the file]."""
    return number(default, "deg", doc, symbol=symbol, least=least, most=most)


def count(default: int, doc: str, *, least: int = 0, most: int | None = None) -> Any:
    """A field for a whole number."""
    meta = Meta(unit="", doc=doc, symbol="", above=None, least=least, most=most, choices=())
    return dataclasses.field(default=int(default), metadata={_KEY: meta})


def choice(default: str, doc: str, choices: tuple[str, ...]) -> Any:
    """A field for one name out of a table."""
    meta = Meta(unit="", doc=doc, symbol="", above=None, least=None, most=None, choices=choices)
    return dataclasses.field(default=default, metadata={_KEY: meta})


def flag(default: bool, doc: str) -> Any:
    """A field that is true or false."""
    meta = Meta(unit="", doc=doc, symbol="", above=None, least=None, most=None, choices=())
    return dataclasses.field(default=default, metadata={_KEY: meta})


@dataclasses.dataclass(frozen=True, slots=True)
class Field:
    """One field of a section, with its key in the design file."""

    name: str
    key: str
    default: float | int | str | bool
    meta: Meta


def fields_of(section: Any) -> Iterator[Field]:
    """The fields of a section (class or instance) in their order; key = name plus unit suffix."""
    for f in dataclasses.fields(section):
        meta: Meta = f.metadata[_KEY]
        key = f"{f.name}_{meta.unit}" if meta.unit else f.name
        assert f.default is not dataclasses.MISSING
        yield Field(f.name, key, f.default, meta)


def check_section(section: Any) -> None:
    """Refuse values outside their bounds.

    Raises:
        ParameterError: names the key, the value and what is allowed.
    """
    for f in fields_of(section):
        value = getattr(section, f.name)
        if f.meta.choices:
            if value not in f.meta.choices:
                raise ParameterError(f.key, value, f.meta.allowed())
            continue
        if isinstance(value, bool):
            continue
        shown = file_from_inside(value, f.meta.unit)
        wrong = (
            not math.isfinite(value)
            or (f.meta.above is not None and value <= f.meta.above)
            or (f.meta.least is not None and value < f.meta.least)
            or (f.meta.most is not None and value > f.meta.most)
        )
        if wrong:
            raise ParameterError(f.key, shown, f.meta.allowed())
