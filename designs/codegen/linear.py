"""Linear equations of fixed size as a straight-line formula: elimination with the largest pivot."""

from __future__ import annotations

from collections.abc import Sequence

from ..language.vocabulary import Number, fabs, where


def solve_linear(matrix: Sequence[Sequence[Number]], right: Sequence[Number]) -> list[Number]:
    """The x with matrix x = right; not finite where the matrix is singular.

    Rows are compared and exchanged without a branch, so that eight poses may pivot differently; without pivots the
    error grows by a factor of 500.
    """
    n = len(right)
    rows = [[*row, b] for row, b in zip(matrix, right, strict=True)]
    for k in range(n):
        for i in range(k + 1, n):
            is_larger = fabs(rows[k][k]) < fabs(rows[i][k])
            pairs = list(zip(rows[k], rows[i], strict=True))
            rows[k] = [where(is_larger, b, a) if j >= k else a for j, (a, b) in enumerate(pairs)]
            rows[i] = [where(is_larger, a, b) if j >= k else b for j, (a, b) in enumerate(pairs)]
        inverse = 1.0 / rows[k][k]
        for i in range(k + 1, n):
            factor = rows[i][k] * inverse
            for j in range(k + 1, n + 1):
                rows[i][j] = rows[i][j] - factor * rows[k][j]
    x: list[Number] = [0.0] * n
    for k in reversed(range(n)):
        rest = rows[k][n]
        for j in range(k + 1, n):
            rest = rest - rows[k][j] * x[j]
        x[k] = rest / rows[k][k]
    return x
