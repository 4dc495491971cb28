"""Enclosures that remember how a value depends on the box's sides, so that dependencies cancel as in the formula.

A value is c + sum g_k e_k + r [-1, 1], with one symbol e_k in [-1, 1] for each side of the box, and lies in an
interval that is carried along. Nonlinear functions are expanded to first order at c; the remainder is bounded over
the hull of c and the interval, since c itself may lie outside what the value can be.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from .intervals import ELEMENTARY, SINE, ULP, Array, Interval, Maybe, is_across_the_cut


class Affine:
    """A batch of n affine forms in k symbols.

    Attributes:
        centre: c, shape (n,).
        slopes: g, shape (n, k).
        rest: r >= 0, shape (n,); inf where only the interval is known.
        interval: holds the value as well.
    """

    __slots__ = ("centre", "interval", "reach", "rest", "slopes")
    __array_ufunc__ = None

    def __init__(self, centre: Array, slopes: Array, rest: Array, interval: Interval) -> None:
        lost = ~(np.isfinite(centre) & np.isfinite(rest) & np.all(np.isfinite(slopes), axis=-1))
        self.centre = np.where(lost, 0.0, centre)
        self.slopes = np.where(lost[..., None], 0.0, slopes)
        self.rest = np.where(lost, np.inf, rest)
        #: How far the form goes from its centre.
        self.reach = (np.sum(np.abs(self.slopes), axis=-1) + self.rest) * (1.0 + 1e-14)
        slack = ULP * np.abs(self.centre) + 5e-324
        self.interval = interval.intersected(self.centre - self.reach - slack, self.centre + self.reach + slack)

    @classmethod
    def box(cls, lower: Array, upper: Array) -> list[Affine]:
        """The coordinates of boxes with these corners, shape (n, k)."""
        n, k = lower.shape
        numbers = []
        for i in range(k):
            low, high = lower[:, i], upper[:, i]
            middle = 0.5 * low + 0.5 * high
            slopes = np.zeros((n, k))
            slopes[:, i] = np.maximum(high - middle, middle - low) * (1.0 + 4.0 * ULP)
            numbers.append(cls(middle, slopes, np.full(n, 5e-324), Interval(low, high)))
        return numbers

    def lift(self, value: Any) -> Affine:
        """An affine form stays, a number becomes one without slopes, an interval one that knows nothing else."""
        if isinstance(value, Affine):
            return value
        if isinstance(value, Interval):
            zero = np.zeros_like(self.centre)
            return Affine(zero, np.zeros_like(self.slopes), np.full_like(zero, np.inf), value)
        point = np.broadcast_to(np.asarray(value, dtype=float), self.centre.shape)
        return Affine(point, np.zeros_like(self.slopes), np.zeros_like(self.centre), Interval(point, point))

    @staticmethod
    def __vocabulary__(name: str, args: Sequence[Any]) -> Affine:
        form = next(a for a in args if isinstance(a, Affine))
        if name == "where":
            return _chosen(args[0], form.lift(args[1]), form.lift(args[2]))
        numbers = [form.lift(a) for a in args]
        enclosed = Interval.__vocabulary__(name, [x.interval for x in numbers])
        return _FUNCTIONS[name](enclosed, *numbers)

    where: Any = None  # tells `Maybe` that this kind of number answers `where`

    def __neg__(self) -> Affine:
        return Affine(-self.centre, -self.slopes, self.rest, -self.interval)

    def __add__(self, other: Any) -> Affine:
        other = self.lift(other)
        rest = self.rest + other.rest + 4.0 * ULP * (_size(self) + _size(other))
        return Affine(self.centre + other.centre, self.slopes + other.slopes, rest, self.interval + other.interval)

    __radd__ = __add__

    def __sub__(self, other: Any) -> Affine:
        return self + (-self.lift(other))

    def __rsub__(self, other: Any) -> Affine:
        return self.lift(other) + (-self)

    def __mul__(self, other: Any) -> Affine:
        if other is self:
            u, curve = self, self.reach * self.reach
            # The square of what was left out lies between 0 and the square of the reach: half of it goes to the centre.
            half = 0.5 * curve
            rest = 2.0 * np.abs(u.centre) * u.rest + half + 8.0 * ULP * _size(u) * _size(u)
            return Affine(u.centre * u.centre + half, 2.0 * u.centre[:, None] * u.slopes, rest, u.interval * u.interval)
        u, v = self, self.lift(other)
        rest = np.abs(u.centre) * v.rest + np.abs(v.centre) * u.rest + u.reach * v.reach
        slopes = u.centre[:, None] * v.slopes + v.centre[:, None] * u.slopes
        return Affine(u.centre * v.centre, slopes, rest + 8.0 * ULP * _size(u) * _size(v), u.interval * v.interval)

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> Affine:
        v = self.lift(other)
        return _with_interval(self * _inverse(v), self.interval / v.interval)

    def __rtruediv__(self, other: Any) -> Affine:
        return self.lift(other) / self

    def __lt__(self, other: Any) -> Maybe:
        return (self - other).interval < 0.0

    def __le__(self, other: Any) -> Maybe:
        return (self - other).interval <= 0.0

    def __gt__(self, other: Any) -> Maybe:
        return (self - other).interval > 0.0

    def __ge__(self, other: Any) -> Maybe:
        return (self - other).interval >= 0.0


def _size(x: Affine) -> Array:
    return np.abs(x.centre) + x.reach


def _with_interval(x: Affine, interval: Interval) -> Affine:
    return Affine(x.centre, x.slopes, x.rest, interval.intersected(x.interval.lower, x.interval.upper))


def _hull(x: Affine) -> Interval:
    """All points on the way from the centre to a value."""
    return Interval(np.minimum(x.interval.lower, x.centre), np.maximum(x.interval.upper, x.centre))


def _expanded(enclosed: Interval, value: Array, parts: Sequence[tuple[Affine, Array]], remainder: Array) -> Affine:
    """Make value + sum slope (x - centre of x), give or take the remainder and rounding."""
    slopes = np.zeros_like(parts[0][0].slopes)
    rest = np.where(np.isnan(remainder), np.inf, remainder) + 2.0 * ELEMENTARY * ULP * np.abs(value) + SINE
    for x, slope in parts:
        slopes = slopes + slope[:, None] * x.slopes
        rest = rest + np.abs(slope) * (x.rest + 2.0 * ELEMENTARY * ULP * _size(x))
    return Affine(value, slopes, rest, enclosed)


def _inverse(v: Affine) -> Affine:
    hull = _hull(v)
    divides = (hull.lower > 0.0) | (hull.upper < 0.0)
    near = np.minimum(np.abs(hull.lower), np.abs(hull.upper))
    value = 1.0 / v.centre
    # Rounding is relative here: an inverse may be far smaller than SINE.
    rest = np.where(divides, v.reach * v.reach / near**3, np.inf) * (1.0 + 1e-14)
    slope = -value * value
    rest = rest + np.abs(slope) * v.rest + 8.0 * ULP * (np.abs(value) + np.abs(slope) * v.reach)
    return Affine(value, slope[:, None] * v.slopes, rest, 1.0 / v.interval)


def _sqrt(enclosed: Interval, x: Affine) -> Affine:
    low = _hull(x).lower
    value = np.sqrt(np.maximum(x.centre, 0.0))
    curve = np.where(low > 0.0, 0.125 * x.reach * x.reach / (low * np.sqrt(np.maximum(low, 0.0))), np.inf)
    return _expanded(enclosed, value, [(x, 0.5 / value)], curve * (1.0 + 1e-14))


def _atan2(enclosed: Interval, y: Affine, x: Affine) -> Affine:
    box_y, box_x = _hull(y), _hull(x)
    rho2 = _nearest2(box_y, box_x)
    curve = np.where(is_across_the_cut(box_y, box_x), np.inf, 0.5 * (x.reach**2 + y.reach**2) / rho2)
    at = x.centre * x.centre + y.centre * y.centre
    parts = [(y, x.centre / at), (x, -y.centre / at)]
    return _expanded(enclosed, np.arctan2(y.centre, x.centre), parts, curve * (1.0 + 1e-14))


def _hypot(enclosed: Interval, x: Affine, y: Affine) -> Affine:
    rho2 = _nearest2(_hull(y), _hull(x))
    curve = np.where(rho2 > 0.0, 0.5 * (x.reach**2 + y.reach**2) / np.sqrt(rho2), np.inf)
    at = np.hypot(x.centre, y.centre)
    return _expanded(enclosed, at, [(x, x.centre / at), (y, y.centre / at)], curve * (1.0 + 1e-14))


def _nearest2(y: Interval, x: Interval) -> Array:
    """Square of the least distance of a box from the origin, from below."""
    a, b = (Interval.__vocabulary__("fabs", (i,)).lower for i in (y, x))
    return (a * a + b * b) * (1.0 - 1e-15)


def _arc(function: Callable[[Array], Array], sign: float) -> Callable[[Interval, Affine], Affine]:
    def arc(enclosed: Interval, x: Affine) -> Affine:
        hull = _hull(x)
        far = np.maximum(np.abs(hull.lower), np.abs(hull.upper))
        left = (1.0 - far) * (1.0 + far)
        curve = np.where(far < 1.0, 0.5 * far * x.reach * x.reach / (left * np.sqrt(np.maximum(left, 0.0))), np.inf)
        slope = sign / np.sqrt((1.0 - x.centre) * (1.0 + x.centre))
        return _expanded(enclosed, function(np.clip(x.centre, -1.0, 1.0)), [(x, slope)], curve * (1.0 + 1e-14))

    return arc


def _sin(enclosed: Interval, x: Affine) -> Affine:
    return _expanded(enclosed, np.sin(x.centre), [(x, np.cos(x.centre))], 0.5 * x.reach * x.reach * (1.0 + 1e-14))


def _cos(enclosed: Interval, x: Affine) -> Affine:
    return _expanded(enclosed, np.cos(x.centre), [(x, -np.sin(x.centre))], 0.5 * x.reach * x.reach * (1.0 + 1e-14))


def _chosen(condition: Maybe, a: Affine, b: Affine) -> Affine:
    """The branch that is certain; where both can be, their interval alone."""
    enclosed = Interval.where(condition, a.interval, b.interval)
    yes = condition.can_be_true
    rest = np.where(yes & condition.can_be_false, np.inf, np.where(yes, a.rest, b.rest))
    slopes = np.where(np.broadcast_to(yes, a.centre.shape)[:, None], a.slopes, b.slopes)
    return Affine(np.where(yes, a.centre, b.centre), slopes, rest, enclosed)


def _fabs(enclosed: Interval, x: Affine) -> Affine:
    return _with_interval(_chosen(x.interval < 0.0, -x, x), enclosed)


def _fmin(enclosed: Interval, a: Affine, b: Affine) -> Affine:
    return _with_interval(_chosen(a < b, a, b), enclosed)


def _fmax(enclosed: Interval, a: Affine, b: Affine) -> Affine:
    return _with_interval(_chosen(a < b, b, a), enclosed)


_FUNCTIONS: dict[str, Callable[..., Affine]] = {
    "sin": _sin,
    "cos": _cos,
    "atan2": _atan2,
    "hypot": _hypot,
    "fabs": _fabs,
    "sqrt": _sqrt,
    "acos": _arc(np.arccos, -1.0),
    "asin": _arc(np.arcsin, 1.0),
    "fmin": _fmin,
    "fmax": _fmax,
}
