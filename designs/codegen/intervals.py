"""Numbers that stand for all values between two ends, in batches: what a formula yields over a whole box of poses.

Every operation rounds outwards. Guards and clamps of the vocabulary are part of the functions that are enclosed, so a
box may reach beyond the limits. What cannot be bounded (a divisor that may be 0, NaN) is everything: [-inf, inf].
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

Array = np.ndarray

#: A little more than the largest relative step between neighbouring floats.
ULP = 2.3e-16
#: How far an elementary function of numpy may lie from the true value, in such steps, and absolutely for sin and cos.
ELEMENTARY, SINE = 8.0, 1e-15
#: A number above pi.
_PI = 3.1415926535897936


def down(x: Array, ulps: float = 1.0) -> Array:
    """A number that lies below x by at least so many steps."""
    return x - (np.abs(x) * (ulps * ULP) + 5e-324)


def up(x: Array, ulps: float = 1.0) -> Array:
    """A number that lies above x by at least so many steps."""
    return x + (np.abs(x) * (ulps * ULP) + 5e-324)


class Maybe:
    """The answer of a comparison of enclosures: it may be yes for some values and no for others."""

    __slots__ = ("can_be_false", "can_be_true")

    def __init__(self, can_be_true: Array, can_be_false: Array) -> None:
        self.can_be_true, self.can_be_false = can_be_true, can_be_false

    def __and__(self, other: Maybe) -> Maybe:
        return Maybe(self.can_be_true & other.can_be_true, self.can_be_false | other.can_be_false)

    def __or__(self, other: Maybe) -> Maybe:
        return Maybe(self.can_be_true | other.can_be_true, self.can_be_false & other.can_be_false)

    def __invert__(self) -> Maybe:
        return Maybe(self.can_be_false, self.can_be_true)

    @staticmethod
    def __vocabulary__(name: str, args: Sequence[Any]) -> Any:
        kind = next((type(a) for a in args if not isinstance(a, Maybe) and hasattr(a, "where")), Interval)
        return kind.__vocabulary__(name, args)


class Interval:
    """All numbers from `lower` to `upper`, arrays of one shape (n,)."""

    __slots__ = ("lower", "upper")
    __array_ufunc__ = None

    def __init__(self, lower: Array, upper: Array) -> None:
        lost = np.isnan(lower) | np.isnan(upper)
        self.lower, self.upper = np.where(lost, -np.inf, lower), np.where(lost, np.inf, upper)

    @classmethod
    def lift(cls, value: Any) -> Interval:
        """An interval stays, an affine form leaves its slopes behind, a number becomes a point."""
        if isinstance(value, Interval):
            return value
        if hasattr(value, "interval"):
            return value.interval
        point = np.asarray(value, dtype=float)
        return cls(point, point)

    @staticmethod
    def __vocabulary__(name: str, args: Sequence[Any]) -> Interval:
        if name == "where":
            return Interval.where(args[0], Interval.lift(args[1]), Interval.lift(args[2]))
        return _FUNCTIONS[name](*(Interval.lift(a) for a in args))

    @staticmethod
    def where(condition: Maybe, a: Interval, b: Interval) -> Interval:
        """All values of the branches that can be taken."""
        yes, no = condition.can_be_true, condition.can_be_false
        lower = np.minimum(np.where(yes, a.lower, np.inf), np.where(no, b.lower, np.inf))
        upper = np.maximum(np.where(yes, a.upper, -np.inf), np.where(no, b.upper, -np.inf))
        return Interval(lower, upper)

    def __add__(self, other: Any) -> Interval:
        other = Interval.lift(other)
        return Interval(down(self.lower + other.lower), up(self.upper + other.upper))

    __radd__ = __add__

    def __neg__(self) -> Interval:
        return Interval(-self.upper, -self.lower)

    def __sub__(self, other: Any) -> Interval:
        other = Interval.lift(other)
        return Interval(down(self.lower - other.upper), up(self.upper - other.lower))

    def __rsub__(self, other: Any) -> Interval:
        return Interval.lift(other) - self

    def __mul__(self, other: Any) -> Interval:
        if other is self:
            near = np.where((self.lower < 0.0) & (self.upper > 0.0), 0.0, np.minimum(abs(self.lower), abs(self.upper)))
            far = np.maximum(abs(self.lower), abs(self.upper))
            return Interval(np.maximum(down(near * near), 0.0), up(far * far))
        other = Interval.lift(other)
        return _hull_of([a * b for a in (self.lower, self.upper) for b in (other.lower, other.upper)], 1.0)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Interval:
        other = Interval.lift(other)
        divides = (other.lower > 0.0) | (other.upper < 0.0)
        ends = [np.where(divides, end, np.nan) for end in (other.lower, other.upper)]
        return _hull_of([a / b for a in (self.lower, self.upper) for b in ends], 1.0)

    def __rtruediv__(self, other: Any) -> Interval:
        return Interval.lift(other) / self

    def __lt__(self, other: Any) -> Maybe:
        other = Interval.lift(other)
        return Maybe(self.lower < other.upper, self.upper >= other.lower)

    def __le__(self, other: Any) -> Maybe:
        other = Interval.lift(other)
        return Maybe(self.lower <= other.upper, self.upper > other.lower)

    def __gt__(self, other: Any) -> Maybe:
        return Interval.lift(other) < self

    def __ge__(self, other: Any) -> Maybe:
        return Interval.lift(other) <= self

    def intersected(self, lower: Array, upper: Array) -> Interval:
        """What is in both; both are known to hold the value, so a crossing by rounding leaves the first."""
        low, high = np.fmax(self.lower, lower), np.fmin(self.upper, upper)
        crossed = low > high
        return Interval(np.where(crossed, self.lower, low), np.where(crossed, self.upper, high))


def _hull_of(corners: list[Array], ulps: float) -> Interval:
    """From the least to the largest corner; NaN anywhere is everything."""
    stacked = np.stack(np.broadcast_arrays(*corners))
    return Interval(down(np.min(stacked, axis=0), ulps), up(np.max(stacked, axis=0), ulps))


def is_across_the_cut(y: Interval, x: Interval) -> Array:
    """The boxes hold points where atan2 jumps, or the origin."""
    return (y.lower <= 0.0) & (y.upper >= 0.0) & (x.lower <= 0.0)


def _atan2(y: Interval, x: Interval) -> Interval:
    corners = _hull_of([np.arctan2(a, b) for a in (y.lower, y.upper) for b in (x.lower, x.upper)], ELEMENTARY)
    wide = is_across_the_cut(y, x)
    return Interval(np.where(wide, -_PI, corners.lower), np.where(wide, _PI, corners.upper))


def _hypot(x: Interval, y: Interval) -> Interval:
    a, b = _fabs(x), _fabs(y)
    low, high = np.hypot(a.lower, b.lower), np.hypot(a.upper, b.upper)
    return Interval(np.maximum(down(low, ELEMENTARY), 0.0), up(high, ELEMENTARY))


def _fabs(x: Interval) -> Interval:
    near = np.where((x.lower <= 0.0) & (x.upper >= 0.0), 0.0, np.minimum(np.abs(x.lower), np.abs(x.upper)))
    return Interval(near, np.maximum(np.abs(x.lower), np.abs(x.upper)))


def _sqrt(x: Interval) -> Interval:
    low, high = np.sqrt(np.maximum(x.lower, 0.0)), np.sqrt(np.maximum(x.upper, 0.0))
    return Interval(np.maximum(down(low), 0.0), up(high))


def _acos(x: Interval) -> Interval:
    low, high = np.arccos(np.clip(x.upper, -1.0, 1.0)), np.arccos(np.clip(x.lower, -1.0, 1.0))
    return Interval(np.maximum(down(low, ELEMENTARY), 0.0), up(high, ELEMENTARY))


def _asin(x: Interval) -> Interval:
    low, high = np.arcsin(np.clip(x.lower, -1.0, 1.0)), np.arcsin(np.clip(x.upper, -1.0, 1.0))
    return Interval(down(low, ELEMENTARY), up(high, ELEMENTARY))


def _wave(function: Callable[[Array], Array], crest: float) -> Callable[[Interval], Interval]:
    """Make sin or cos, whose crests lie at `crest` plus whole turns; near a crest or trough counts as holding it."""
    turn, near = 2.0 * math.pi, 1e-9

    def holds(x: Interval, at: float) -> Array:
        last = np.floor((x.upper - at) / turn + near) * turn + at
        return ~(last < x.lower - near)

    def wave(x: Interval) -> Interval:
        ends = _hull_of([function(x.lower), function(x.upper)], ELEMENTARY)
        lower = np.where(holds(x, crest + math.pi), -1.0, np.maximum(ends.lower - SINE, -1.0))
        upper = np.where(holds(x, crest), 1.0, np.minimum(ends.upper + SINE, 1.0))
        is_far = ~((np.abs(x.lower) < 1e6) & (np.abs(x.upper) < 1e6))
        return Interval(np.where(is_far, -1.0, lower), np.where(is_far, 1.0, upper))

    return wave


_FUNCTIONS: dict[str, Callable[..., Interval]] = {
    "sin": _wave(np.sin, math.pi / 2.0),
    "cos": _wave(np.cos, 0.0),
    "atan2": _atan2,
    "hypot": _hypot,
    "fabs": _fabs,
    "sqrt": _sqrt,
    "acos": _acos,
    "asin": _asin,
    "fmin": lambda a, b: Interval(np.minimum(a.lower, b.lower), np.minimum(a.upper, b.upper)),
    "fmax": lambda a, b: Interval(np.maximum(a.lower, b.lower), np.maximum(a.upper, b.upper)),
}
