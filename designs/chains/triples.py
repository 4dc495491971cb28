"""Three numbers of any kind (floats, nodes of a trace) for what is fixed about a chain, and the floats of a joint."""

from __future__ import annotations

from ..language.joints import Point
from ..language.vocabulary import Number

Triple = tuple[Number, Number, Number]


def point(numbers: Triple) -> Point:
    """Plain floats for a joint."""
    x, y, z = numbers
    return float(x), float(y), float(z)
