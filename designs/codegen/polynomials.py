"""sin, cos, atan2, acos and asin as straight-line arithmetic, so that eight poses take them at once.

Sources: coefficients of sin, cos and atan from Cephes (S. Moshier), of acos and asin from fdlibm (Sun Microsystems,
"freely granted provided this notice is preserved"). Shown by: tests/designs/test_codegen_polynomials.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from ..language.vocabulary import fabs, where
from .graph import Node

_SIN = (
    1.58962301576546568060e-10,
    -2.50507477628578072866e-8,
    2.75573136213857245213e-6,
    -1.98412698295895385996e-4,
    8.33333333332211858878e-3,
    -1.66666666666666307295e-1,
)
_COS = (
    -1.13585365213876817300e-11,
    2.08757008419747316778e-9,
    -2.75573141792967388112e-7,
    2.48015872888517045348e-5,
    -1.38888888888730564116e-3,
    4.16666666666665929218e-2,
)
_ATAN_P = (
    -8.750608600031904122785e-1,
    -1.615753718733365076637e1,
    -7.500855792314704667340e1,
    -1.228866684490136173410e2,
    -6.485021904942025371773e1,
)
_ATAN_Q = (
    1.0,
    2.485846490142306297962e1,
    1.650270098316988542046e2,
    4.328810604912902668951e2,
    4.853903996359136964868e2,
    1.945506571482613964425e2,
)
_ASIN_P = (
    3.47933107596021167570e-05,
    7.91534994289814532176e-04,
    -4.00555345006794114027e-02,
    2.01212532134862925881e-01,
    -3.25565818622400915405e-01,
    1.66666666666666657415e-01,
)
_ASIN_Q = (
    7.70381505559019352791e-02,
    -6.88283971605453293030e-01,
    2.02094576023350569471e00,
    -2.40339491173441421878e00,
    1.0,
)
#: pi/2 in three parts; the first two have short mantissas, so that their products with a turn count are exact.
_HALF_PI = (1.57079625129699707031, 7.54978941586159635336e-8, 5.39030285815811905290e-15)
_PI_2, _PI_2_REST = 1.57079632679489661923, 6.123233995736765886130e-17
_TAN_PI_8 = 0.41421356237309504880
_TINY = 1e-300


def horner(x: Node, coefficients: Sequence[float]) -> Node:
    """The polynomial with these coefficients, the highest power first."""
    value: Node | float = coefficients[0]
    for c in coefficients[1:]:
        value = value * x + c
    assert isinstance(value, Node)
    return value


def _quarter(x: Node) -> tuple[Node, Node, Node]:
    """Quarter turn nearest to an angle [0, 1, 2, 3], and sine and cosine of the rest; for |x| below 1e5 rad."""
    floor = x.graph.make
    n = floor("floor", x * (1.0 / _PI_2) + 0.5)
    rest = ((x - n * _HALF_PI[0]) - n * _HALF_PI[1]) - n * _HALF_PI[2]
    z = rest * rest
    sine = rest + rest * (z * horner(z, _SIN))
    cosine = (1.0 - 0.5 * z) + z * z * horner(z, _COS)
    return n - 4.0 * floor("floor", n * 0.25), sine, cosine


def lowered_sin(x: Node) -> Node:
    """Sine, within 2.2e-16 of the true value."""
    quarter, sine, cosine = _quarter(x)
    is_odd = x.graph.make("eq", quarter, x.graph.const(1.0)) | x.graph.make("eq", quarter, x.graph.const(3.0))
    size = where(is_odd, cosine, sine)
    return where(quarter < 2.0, size, -size)


def lowered_cos(x: Node) -> Node:
    """Cosine, within 2.2e-16 of the true value."""
    quarter, sine, cosine = _quarter(x)
    is_one, is_three = (x.graph.make("eq", quarter, x.graph.const(k)) for k in (1.0, 3.0))
    size = where(is_one | is_three, sine, cosine)
    return where(is_one | x.graph.make("eq", quarter, x.graph.const(2.0)), -size, size)


def lowered_atan2(y: Node, x: Node) -> Node:
    """Angle of (x, y); 0 at the origin, and a zero y counts as +0."""
    ax, ay = fabs(x), fabs(y)
    is_steep = ax < ay
    low, high = where(is_steep, ax, ay), where(is_steep, ay, ax)
    is_wide = high * _TAN_PI_8 < low
    t = where(is_wide, low - high, low) / where(high < _TINY, 1.0, where(is_wide, low + high, high))
    z = t * t
    angle = t + t * (z * (horner(z, _ATAN_P) / horner(z, _ATAN_Q)))
    angle = where(is_wide, (angle + 0.5 * _PI_2_REST) + 0.5 * _PI_2, angle)
    angle = where(is_steep, _PI_2 - (angle - _PI_2_REST), angle)
    angle = where(x < 0.0, 2.0 * _PI_2 - (angle - 2.0 * _PI_2_REST), angle)
    return where(y < 0.0, -angle, angle)


def _asin_parts(u: Node) -> tuple[Node, Node, Node]:
    """|u| > 1/2, and the arcsine of |u| (small) or of sqrt((1 - |u|) / 2) (large)."""
    size = fabs(u)
    is_large = size > 0.5
    z = where(is_large, 0.5 * (1.0 - size), u * u)
    s = where(is_large, u.graph.make("root", z), size)
    z_ratio = z * (horner(z, _ASIN_P) / horner(z, _ASIN_Q))
    return is_large, s, s + s * z_ratio


def lowered_acos(u: Node) -> Node:
    """Arccosine of a number in [-1, 1], within 4.4e-16 relative."""
    is_large, _, part = _asin_parts(u)
    signed = where(u < 0.0, -part, part)
    small = _PI_2 - (signed - _PI_2_REST)
    large = where(u < 0.0, 2.0 * _PI_2 - 2.0 * (part - _PI_2_REST), 2.0 * part)
    return where(is_large, large, small)


def lowered_asin(u: Node) -> Node:
    """Arcsine of a number in [-1, 1]."""
    is_large, _, part = _asin_parts(u)
    size = where(is_large, _PI_2 - (2.0 * part - _PI_2_REST), part)
    return where(u < 0.0, -size, size)
