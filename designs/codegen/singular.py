"""Extreme singular values of small matrices as straight-line formulas, so that they fuse with the Jacobian's kernel.

The squares of the singular values are the eigenvalues of the Gram matrix. That is brought to tridiagonal form by
Householder reflections; Laguerre's iteration then runs from outside to either end of the spectrum, where it converges
cubically and cannot overshoot. The Gram matrix squares the condition number: the smaller value's relative error
grows with it (see `singular_values`).
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

from ..language.vocabulary import Number, fabs, fmax, sqrt, where
from .graph import Node
from .loops import repeat_while
from .program import Output, Program

Rows = Sequence[Sequence[Number]]

#: Laguerre steps on the coefficients of the characteristic polynomial, before those on the matrix itself.
COARSE_STEPS = 4
#: Steps at most on the matrix; a sixfold eigenvalue needs about 40.
MOST_STEPS = 60
#: Fine steps are cut by this: before a cluster of all eigenvalues, rounding makes a step 1e-7 of itself too long.
SHORTER = 1.0 - 2e-7
#: Error of an eigenvalue that cannot be improved, in parts of the largest.
ROUNDING = 4e-15
_TINY, _HUGE = 1e-300, 1e300


class Tridiagonal(NamedTuple):
    """Diagonal and squares of the off-diagonal of a symmetric tridiagonal matrix."""

    diagonal: list[Number]
    squares: list[Number]


def gram(rows: Rows) -> list[list[Number]]:
    """A A^T or A^T A, whichever is smaller; only entries [i][j] with j <= i are given."""
    vectors = list(rows) if len(rows) <= len(rows[0]) else list(zip(*rows, strict=True))
    return [[_dot(u, v) for v in vectors[: i + 1]] for i, u in enumerate(vectors)]


def tridiagonal(matrix: list[list[Number]]) -> Tridiagonal:
    """The symmetric matrix (lower half given) in tridiagonal form, by Householder reflections."""
    n = len(matrix)
    a = [list(row) for row in matrix]
    squares: list[Number] = []
    for k in range(n - 3):
        x = [a[i][k] for i in range(k + 1, n)]
        rest = _dot(x[1:], x[1:])
        length2 = x[0] * x[0] + rest
        squares.append(length2)
        length = sqrt(length2)
        # v = x + sign(x0) |x| e1; half |v|^2 = |x| (|x| + |x0|) has no cancellation and is 0 only for x = 0.
        v0 = x[0] + where(x[0] < 0.0, -length, length)
        v = [v0, *x[1:]]
        beta = 1.0 / fmax(length2 + (v0 - x[0]) * x[0], _TINY)
        m = len(v)

        def entry(i: int, j: int, k: int = k) -> Number:
            return a[k + 1 + max(i, j)][k + 1 + min(i, j)]

        p = [beta * _dot([entry(i, j) for j in range(m)], v) for i in range(m)]
        half = 0.5 * beta * _dot(p, v)
        w = [pi - half * vi for pi, vi in zip(p, v, strict=True)]
        for i in range(m):
            for j in range(i + 1):
                a[k + 1 + i][k + 1 + j] = a[k + 1 + i][k + 1 + j] - v[i] * w[j] - w[i] * v[j]
    if n > 2:
        _turn_last(a, squares)
    if n > 1:
        squares.append(a[n - 1][n - 2] * a[n - 1][n - 2])
    return Tridiagonal([a[i][i] for i in range(n)], squares)


def _turn_last(a: list[list[Number]], squares: list[Number]) -> None:
    """The last reflection turns two axes, and only squares of what is beside the diagonal are wanted: no root."""
    *_, (*_, x, first), (*_, y, beside, last) = a
    length2 = x * x + y * y
    squares.append(length2)
    across, apart = 2.0 * beside, last - first
    part = y / fmax(length2, _TINY)
    moved = part * (across * x + apart * y)
    a[-2][-1], a[-1][-2:] = first + moved, [beside + part * (apart * x - across * y), last - moved]


def extreme_eigenvalues(matrix: list[list[Number]]) -> tuple[Number, Number]:
    """Smallest and largest eigenvalue of a positive semi-definite matrix (lower half given)."""
    n = len(matrix)
    if n == 1:
        return matrix[0][0], matrix[0][0]
    t = tridiagonal(matrix)
    trace = _dot(t.diagonal, [1.0] * n)
    low: Number = 0.0
    if n == 2:
        half = 0.5 * (t.diagonal[0] - t.diagonal[1])
        root = sqrt(half * half + t.squares[0])
        high: Number = 0.5 * trace + root
        return fmax((t.diagonal[0] * t.diagonal[1] - t.squares[0]) / fmax(high, _TINY), 0.0), high
    coefficients = characteristic(t)
    high = _upper_bound(n, trace, coefficients[2])
    for _ in range(COARSE_STEPS):
        low = low - _step(n, _horner(coefficients, low))
    for _ in range(COARSE_STEPS - 1):
        high = high - _step(n, _horner(coefficients, high))
    fixed = [*t.diagonal, *t.squares]
    first = _returned(t, low, high, trace)
    # Simple eigenvalues are there after the first step; clusters, where the steps shrink slowly, go on.
    low, _, high, _ = repeat_while(
        _fine_step(first, fixed),
        fixed,
        lambda carried, fixed: (_is_unsettled(carried), _fine_step(carried, fixed)),
        MOST_STEPS,
    )
    return fmax(low, 0.0), high


def _upper_bound(n: int, trace: Number, second: Number) -> Number:
    """Where Laguerre's step from infinity ends: n real roots of this sum and sum of products lie below."""
    return (trace + sqrt((n - 1.0) * ((n - 1.0) * (trace * trace) - (2.0 * n) * second))) * (1.0 / n)


def _returned(t: Tridiagonal, low: Number, high: Number, trace: Number) -> list[Number]:
    """First fine step, from points that are outside for certain.

    Where eigenvalues cluster, rounding of the coefficients (its sixth root, for six) has carried the coarse steps in
    among them, from where a step may go to any. So start a little outside; if the signs of the leading minors say that
    an eigenvalue lies even farther out, start again from the first bounds.
    """
    low, high = low - (1e-9 * low + ROUNDING * high), high + 1e-9 * high
    n = len(t.diagonal)
    at_low, at_high = _minors(t, low), _minors(t, high)
    is_below, is_above = at_low[0][0] < 0.0, at_high[0][0] > 0.0
    for k in range(1, n):
        is_below = is_below & ((at_low[k][0] < 0.0) if k % 2 == 0 else (at_low[k][0] > 0.0))
        is_above = is_above & (at_high[k][0] > 0.0)
    carried: list[Number] = []
    for x, at, is_outside, bound in ((low, at_low, is_below, 0.0), (high, at_high, is_above, trace)):
        nearer, doubt = _nearer(n, x, at[-1])
        carried += [where(is_outside, nearer, bound), where(is_outside, doubt, trace)]
    return carried


def _fine_step(carried: list[Number], fixed: list[Number]) -> list[Number]:
    """One step at either end: root, and how far it may still be."""
    n = (len(fixed) + 1) // 2
    t = Tridiagonal(fixed[:n], fixed[n:])
    following: list[Number] = []
    for x in carried[::2]:
        following += _nearer(n, x, _minors(t, x)[-1])
    return following


def _nearer(n: int, x: Number, at: tuple[Number, Number, Number]) -> tuple[Number, Number]:
    """The next point, and a bound for what is left.

    With s1, s2 the sums of 1/(root - x) and of its square over all roots, the nearest root is within s1/s2, a mean
    of their distances with weights; of that the step is gone. It is within n steps too, which serves where the
    squares vanish.
    """
    p, d, h = at
    step = SHORTER * _step(n, at)
    squares = d * d - 2.0 * (p * h)
    left = fabs(fabs(p * d) / where(squares > _TINY, squares, 1.0) - fabs(step))
    most = n * fabs(step)
    return x - step, where((squares > _TINY) & (left < most), left, most)


def _is_unsettled(carried: list[Number]) -> Number:
    """An end may be farther off than rounding."""
    low, low_doubt, high, high_doubt = carried
    return (low_doubt > 1e-14 * low + ROUNDING * high) | (high_doubt > ROUNDING * high)


def characteristic(t: Tridiagonal) -> list[Number]:
    """Coefficients of det(x I - T), highest power (which is 1) first."""
    before: list[Number] = [1.0]
    now: list[Number] = [1.0, -t.diagonal[0]]
    for d, e2 in zip(t.diagonal[1:], t.squares, strict=True):
        shifted = [*now, 0.0]
        for k, c in enumerate(now):
            shifted[k + 1] = shifted[k + 1] - d * c
        for k, c in enumerate(before):
            shifted[k + 2] = shifted[k + 2] - e2 * c
        before, now = now, shifted
    return now


def _horner(coefficients: list[Number], x: Number) -> tuple[Number, Number, Number]:
    """p, p' and p''/2 at x from the coefficients."""
    p: Number = coefficients[0]
    d: Number = 0.0
    h: Number = 0.0
    for c in coefficients[1:]:
        h = h * x + d
        d = d * x + p
        p = p * x + c
    return p, d, h


def _minors(t: Tridiagonal, x: Number) -> list[tuple[Number, Number, Number]]:
    """p, p' and p''/2 of all leading minors of x I - T, by size."""
    p0: Number = 1.0
    d0: Number = 0.0
    h0: Number = 0.0
    p1: Number = x - t.diagonal[0]
    d1: Number = 1.0
    h1: Number = 0.0
    minors = [(p1, d1, h1)]
    for d, e2 in zip(t.diagonal[1:], t.squares, strict=True):
        s = x - d
        p0, p1, d0, d1, h0, h1 = p1, s * p1 - e2 * p0, d1, s * d1 + p1 - e2 * d0, h1, s * h1 + d1 - e2 * h0
        minors.append((p1, d1, h1))
    return minors


def _step(n: int, at: tuple[Number, Number, Number]) -> Number:
    """Laguerre's step x_old - x_new of a polynomial of degree n whose roots are real."""
    p, d, h = at
    root = sqrt((n - 1.0) * ((n - 1.0) * (d * d) - (2.0 * n) * (p * h)))
    slope = where(d < 0.0, d - root, d + root)
    return n * p / where(fabs(slope) < _TINY, 1.0, slope)


def _dot(u: Sequence[Number], v: Sequence[Number]) -> Number:
    total = u[0] * v[0]
    for a, b in zip(u[1:], v[1:], strict=True):
        total = total + a * b
    return total


def singular_values(rows: Rows) -> tuple[Number, Number]:
    """Smallest and largest singular value of a matrix with at most six rows or columns.

    The smaller one's relative error is at most 2e-16 times the squared condition number: 1e-9 up to a condition
    number of 2000, 2e-8 at 1e4.
    """
    low, high = extreme_eigenvalues(gram(rows))
    return sqrt(low), sqrt(high)


def exceeds(rows: Rows, threshold: Number, shares: Sequence[Number] | None = None) -> Number:
    """+1 where the smallest singular value is above the threshold, else -1; no root is taken.

    It is so where all pivots of L D L^T of the Gram matrix less threshold^2 on its diagonal are positive. A factor
    of a whole row may be left out, since it changes no pivot's sign; it divides the threshold instead.

    Args:
        rows: the matrix.
        threshold: to compare with.
        shares: row i of the matrix is `rows[i]` / shares[i]; only for a matrix with no more rows than columns.
    """
    a = gram(rows)
    n = len(a)
    trace = _dot([a[k][k] for k in range(n)], [1.0] * n)
    above: Any = True
    for k in range(n):
        shift = threshold if shares is None else threshold * shares[k]
        a[k][k] = a[k][k] - shift * shift
    for k in range(n):
        is_positive = a[k][k] > 0.0
        above = is_positive if k == 0 else above & is_positive
        # Behind a pivot that is not positive nothing matters any more.
        inverse = 1.0 / where(is_positive, a[k][k], 1.0) if k < n - 1 else 1.0
        for i in range(k + 1, n):
            factor = a[i][k] * inverse
            for j in range(k + 1, i + 1):
                a[i][j] = a[i][j] - factor * a[j][k]
    # What is not finite must not pass for a decision.
    return where(trace < _HUGE, where(above, 1.0, -1.0), trace)


def with_singular_values(
    program: Program, column_scale: Sequence[float] | None = None, row_scale: Sequence[float] | None = None
) -> Program:
    """The program with output "sigma": smallest and largest singular value of its scaled "jacobian"."""
    sigma = singular_values(_scaled(program, column_scale, row_scale))
    graph = program.graph
    return program.add(Output(name="sigma", shape=(2,), nodes=tuple(graph.lift(s) for s in sigma)))


def with_threshold(
    program: Program, column_scale: Sequence[float] | None = None, row_scale: Sequence[float] | None = None
) -> Program:
    """The program with a parameter "threshold" and an output "above": +1 where the least singular value exceeds it."""
    graph = program.graph
    threshold = graph.parameter(len(program.parameters))
    rows = _scaled(program, column_scale, row_scale)
    if len(rows) <= len(rows[0]):
        parted = [_parted(row) for row in rows]
        above = exceeds([row for row, _ in parted], threshold, [share for _, share in parted])
    else:
        above = exceeds(rows, threshold)
    return program.add(Output(name="above", shape=(), nodes=(graph.lift(above),)), parameters=("threshold",))


def _parted(row: Sequence[Node]) -> tuple[list[Node], Node]:
    """A row without a factor that all its entries have, and the inverse of that factor (1 if there is none)."""
    graph = row[0].graph
    split = [_factors(node) for node in row if not node.is_const(0.0)]
    common = [f for f in (split[0] if split else ()) if not f.is_const() and all(f in other for other in split)]
    if not common:
        return list(row), graph.const(1.0)
    factor = common[0]
    is_inverse = factor.op == "div" and factor.args[0].is_const()
    share = factor.args[1] * (1.0 / factor.args[0].value) if is_inverse else 1.0 / factor
    return [_without(node, factor) for node in row], share


def _factors(node: Node) -> tuple[Node, ...]:
    if node.op == "mul":
        return _factors(node.args[0]) + _factors(node.args[1])
    return _factors(node.args[0]) if node.op == "neg" else (node,)


def _without(node: Node, factor: Node) -> Node:
    """The product without this factor of it."""
    if node is factor:
        return node.graph.const(1.0)
    if node.op == "neg":
        return -_without(node.args[0], factor)
    if node.op == "mul":
        left, right = node.args
        return _without(left, factor) * right if factor in _factors(left) else left * _without(right, factor)
    return node


def _scaled(program: Program, column_scale: Sequence[float] | None, row_scale: Sequence[float] | None) -> Rows:
    jacobian = program.output("jacobian")
    m, n = jacobian.shape
    columns, lines = column_scale or [1.0] * n, row_scale or [1.0] * m
    return [[jacobian.nodes[i * n + j] * (columns[j] * lines[i]) for j in range(n)] for i in range(m)]
