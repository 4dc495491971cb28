"""How a paper's number enters the house, and how a number leaves it.

Inside: millimetre, radian, kilogram, newton, second. A key in a file says its unit by its suffix.
"""

from __future__ import annotations

import math

MM = 1.0
CM = 10.0
M = 1000.0
DEG = math.pi / 180.0
RAD = 1.0
KG = 1.0
GRAM = 1e-3

GRAVITY_M_S2 = 9.80665

#: Factor from the unit of a file key (its suffix) to the unit inside.
SUFFIXES: dict[str, float] = {"mm": MM, "deg": DEG, "kg": KG, "g": GRAM, "m": M, "rad": RAD, "nm": 1000.0, "n": 1.0}


def inside_from_file(value: float, suffix: str) -> float:
    """The inside value of a number written under a key with this suffix (empty: no unit)."""
    return value * SUFFIXES[suffix] if suffix else value


def file_from_inside(value: float, suffix: str) -> float:
    """The number to write under a key with this suffix; 15 digits are kept, so that 30 degrees stay 30."""
    return float(f"{value / SUFFIXES[suffix]:.15g}") if suffix else value
