"""What the parts are made of: density, colour and where the number comes from, one row of `materials.csv` each."""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from .errors import ParameterError, UnknownNameError

_MM3_PER_M3 = 1e9


@dataclass(frozen=True, slots=True, kw_only=True)
class Material:
    """One row of the table.

    Attributes:
        name: as parts and design files call it.
        density_kg_m3: as the table has it [kg/m3].
        colour: red, green, blue from 0 to 1, for pictures and CAD files.
        source: standard or reason of the number.
    """

    name: str
    density_kg_m3: float
    colour: tuple[float, float, float]
    source: str

    @property
    def density(self) -> float:
        """Density in the units inside [kg/mm3]."""
        return self.density_kg_m3 / _MM3_PER_M3


@cache
def _table() -> dict[str, Material]:
    text = files(__package__).joinpath("materials.csv").read_text(encoding="utf-8")
    return read_materials(text.splitlines())


def read_materials(lines: Iterable[str]) -> dict[str, Material]:
    """Materials by name from the lines of a table with the columns of `materials.csv`.

    Raises:
        ParameterError: a density that is not positive, a colour outside 0..1, or a name given twice.
    """
    table: dict[str, Material] = {}
    for row in csv.DictReader(lines):
        name, density = row["name"], float(row["density_kg_m3"])
        red, green, blue = (float(row[channel]) for channel in ("red", "green", "blue"))
        if not 0.0 < density < 25000.0:
            raise ParameterError(f"materials.{name}.density_kg_m3", density, "must lie between 0 and 25000 kg/m3")
        if not all(0.0 <= channel <= 1.0 for channel in (red, green, blue)):
            raise ParameterError(f"materials.{name}.colour", (red, green, blue), "each channel must lie in 0..1")
        if name in table:
            raise ParameterError(f"materials.{name}", density, "is in the table twice")
        table[name] = Material(name=name, density_kg_m3=density, colour=(red, green, blue), source=row["source"])
    return table


def material(name: str) -> Material:
    """The material of this name.

    Raises:
        UnknownNameError: the table has no such row; the error lists those it has.
    """
    try:
        return _table()[name]
    except KeyError:
        raise UnknownNameError("material", name, material_names()) from None


def material_names() -> tuple[str, ...]:
    """All names of the table, in its order."""
    return tuple(_table())
