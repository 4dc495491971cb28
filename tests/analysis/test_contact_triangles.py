"""The distance of two triangles: against exact rational arithmetic, slivers and crossings included."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

from linkwright.analysis.contact.triangles import triangle_distance2


def _distance(a, b, limit=np.inf):
    points = np.full(6, np.nan)
    d2 = triangle_distance2(a.reshape(1, 9), 0, b.reshape(1, 9), 0, float(limit) ** 2, points, np.empty(6))
    return np.sqrt(d2), points[:3], points[3:]


def _dot(u, v):
    return sum(x * y for x, y in zip(u, v, strict=True))


def _minus(u, v):
    return [x - y for x, y in zip(u, v, strict=True)]


def _cross(u, v):
    return [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]


def _along(p, u, t):
    return [x + t * y for x, y in zip(p, u, strict=True)]


def _exact_segments2(p, u, q, v):
    """Exact squared distance of two segments: inner solution, or an end of one against the other."""
    r, a, e, b = _minus(p, q), _dot(u, u), _dot(v, v), _dot(u, v)
    c, f, den = _dot(u, r), _dot(v, r), a * e - b * b
    pairs = [(s, min(max((b * s + f) / e, Fraction(0)), Fraction(1))) for s in (Fraction(0), Fraction(1))]
    pairs += [(min(max((b * t - c) / a, Fraction(0)), Fraction(1)), t) for t in (Fraction(0), Fraction(1))]
    if den > 0:
        s, t = (b * f - c * e) / den, (a * f - b * c) / den
        if 0 <= s <= 1 and 0 <= t <= 1:
            pairs.append((s, t))
    gaps = [_minus(_along(p, u, s), _along(q, v, t)) for s, t in pairs]
    return min(_dot(g, g) for g in gaps)


def _exact_to_face2(p, corners):
    """Exact squared distance of a point from a triangle's plane if its foot lies in the triangle, else None."""
    n = _cross(_minus(corners[1], corners[0]), _minus(corners[2], corners[0]))
    h = _dot(n, _minus(p, corners[0]))
    foot = _along(p, n, -h / _dot(n, n))
    sides = [_dot(n, _cross(_minus(corners[(k + 1) % 3], corners[k]), _minus(foot, corners[k]))) for k in range(3)]
    return h * h / _dot(n, n) if min(sides) >= 0 else None


def _exact_pierces(p, q, corners):
    n = _cross(_minus(corners[1], corners[0]), _minus(corners[2], corners[0]))
    hp, hq = _dot(n, _minus(p, corners[0])), _dot(n, _minus(q, corners[0]))
    return hp * hq <= 0 and hp != hq and _exact_to_face2(_along(p, _minus(q, p), hp / (hp - hq)), corners) == 0


def _exact(a, b):
    A, B = ([[Fraction(float(x)) for x in corner] for corner in t] for t in (a, b))
    edges = [((A[k], A[(k + 1) % 3]), (B[m], B[(m + 1) % 3])) for k in range(3) for m in range(3)]
    if any(_exact_pierces(*e, B) or _exact_pierces(*f, A) for e, f in edges):
        return 0.0
    found = [_exact_segments2(p, _minus(q, p), r, _minus(s, r)) for (p, q), (r, s) in edges]
    found += [d for d in [_exact_to_face2(p, B) for p in A] + [_exact_to_face2(p, A) for p in B] if d is not None]
    return float(min(found)) ** 0.5


def _triangles(rng, kind):
    a, b = rng.uniform(-10.0, 10.0, (2, 3, 3))
    if kind == "slivers":
        for t in (a, b):
            t[2] = t[0] + rng.uniform(0.1, 0.9) * (t[1] - t[0]) + 3e-4 * rng.normal(size=3)
    elif kind == "nearly parallel":
        b = a + rng.normal(size=3) + 1e-7 * rng.normal(size=(3, 3))
    elif kind == "shared corner":
        b[rng.integers(3)] = a[rng.integers(3)]
    elif kind == "in one plane":
        a[:, 2], b[:, 2] = 0.0, 0.0
    return a, b


@pytest.mark.parametrize("kind", ["generic", "slivers", "nearly parallel", "shared corner", "in one plane"])
def test_triangle_distance_equals_rational_arithmetic(rng, kind):
    n_apart = 0
    for _ in range(60):
        a, b = _triangles(rng, kind)
        exact = _exact(a, b)
        d, p, q = _distance(a, b)
        assert d == pytest.approx(exact, abs=1e-9)
        assert np.linalg.norm(p - q) == pytest.approx(d, abs=1e-9)
        n_apart += exact > 0.0
    assert n_apart > 0 or kind == "shared corner"


def test_triangles_that_cross_are_at_distance_zero(rng):
    crossing = 0
    for _ in range(200):
        a, b = _triangles(rng, "generic")
        d, exact = _distance(a, b)[0], _exact(a, b)
        assert (d == 0.0) == (exact == 0.0)
        crossing += exact == 0.0
    assert 20 < crossing < 180


def test_a_large_triangle_pierced_in_its_middle_is_not_missed():
    large = np.array([[-100.0, -100.0, 0.0], [100.0, -100.0, 0.0], [0.0, 100.0, 0.0]])
    needle = np.array([[0.0, 0.0, -50.0], [1.0, 0.0, 50.0], [0.0, 1.0, 50.0]])
    assert _distance(large, needle)[0] == 0.0
    assert _distance(needle, large)[0] == 0.0


def test_a_limit_below_the_distance_is_returned_and_no_point_is_written():
    a = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    d, p, _ = _distance(a, a + np.array([0.0, 0.0, 2.0]), limit=1.5)
    assert d == 1.5
    assert np.isnan(p).all()


def test_triangles_without_area_are_measured_by_their_edges():
    point = np.zeros((3, 3))
    line = np.array([[3.0, -1.0, 0.0], [3.0, 1.0, 0.0], [3.0, 0.0, 0.0]])
    assert _distance(point, line)[0] == pytest.approx(3.0)
