"""The exact distance of two triangles, with the two points between which it lies.

Triangles are rows of nine numbers: three corners, one after the other [mm].
"""

from __future__ import annotations

import numpy as np

from .kernel import kernel

Array = np.ndarray


@kernel
def closest_on_triangle(px: float, py: float, pz: float, B: Array, j: int) -> tuple[float, float, float, float]:
    """Squared distance of a point from triangle j of B, and the nearest point of it.

    Source: Ericson, Real-Time Collision Detection, section 5.1.5. A triangle without area falls to its edges.
    """
    ax, ay, az = B[j, 0], B[j, 1], B[j, 2]
    abx, aby, abz = B[j, 3] - ax, B[j, 4] - ay, B[j, 5] - az
    acx, acy, acz = B[j, 6] - ax, B[j, 7] - ay, B[j, 8] - az
    apx, apy, apz = px - ax, py - ay, pz - az
    d1 = abx * apx + aby * apy + abz * apz
    d2 = acx * apx + acy * apy + acz * apz
    bpx, bpy, bpz = px - B[j, 3], py - B[j, 4], pz - B[j, 5]
    d3 = abx * bpx + aby * bpy + abz * bpz
    d4 = acx * bpx + acy * bpy + acz * bpz
    cpx, cpy, cpz = px - B[j, 6], py - B[j, 7], pz - B[j, 8]
    d5 = abx * cpx + aby * cpy + abz * cpz
    d6 = acx * cpx + acy * cpy + acz * cpz
    vc = d1 * d4 - d3 * d2
    vb = d5 * d2 - d1 * d6
    va = d3 * d6 - d5 * d4
    v, w = 0.0, 0.0
    if d1 <= 0.0 and d2 <= 0.0:
        pass
    elif d3 >= 0.0 and d4 <= d3:
        v = 1.0
    elif d6 >= 0.0 and d5 <= d6:
        w = 1.0
    elif vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v = d1 / (d1 - d3)
    elif vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        w = d2 / (d2 - d6)
    elif va <= 0.0 and d4 - d3 >= 0.0 and d5 - d6 >= 0.0:
        w = (d4 - d3) / ((d4 - d3) + (d5 - d6))
        v = 1.0 - w
    else:
        total = va + vb + vc
        if total > 0.0:
            v, w = vb / total, vc / total
    qx = ax + v * abx + w * acx
    qy = ay + v * aby + w * acy
    qz = az + v * abz + w * acz
    return (px - qx) ** 2 + (py - qy) ** 2 + (pz - qz) ** 2, qx, qy, qz


@kernel
def _sides(A: Array, i: int, B: Array, j: int, s: Array) -> float:
    """Writes to s how far B's corners lie beyond A's plane, times the length of A's normal; returns that squared.

    A's own corners do not all lie exactly in the plane of a computed normal (slivers), so s is what is left after
    the one of A that is farthest out on B's side. s is of one sign exactly if the normal separates the two.
    """
    ux, uy, uz = A[i, 3] - A[i, 0], A[i, 4] - A[i, 1], A[i, 5] - A[i, 2]
    vx, vy, vz = A[i, 6] - A[i, 0], A[i, 7] - A[i, 1], A[i, 8] - A[i, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    e1 = nx * ux + ny * uy + nz * uz
    e2 = nx * vx + ny * vy + nz * vz
    high, low = max(0.0, e1, e2), min(0.0, e1, e2)
    for k in range(3):
        x, y, z = B[j, 3 * k] - A[i, 0], B[j, 3 * k + 1] - A[i, 1], B[j, 3 * k + 2] - A[i, 2]
        d = nx * x + ny * y + nz * z
        s[k] = d - high if d > high else (d - low if d < low else 0.0)
    return nx * nx + ny * ny + nz * nz


@kernel
def _is_apart(s: Array, nn: float, limit2: float) -> bool:
    """The signed sides s prove a distance of at least sqrt(limit2)."""
    low, high = min(s[0], s[1], s[2]), max(s[0], s[1], s[2])
    gap = low if low > 0.0 else (-high if high < 0.0 else 0.0)
    return gap > 0.0 and gap * gap >= limit2 * nn


@kernel
def _pierces(A: Array, i: int, B: Array, j: int, s: Array, out: Array) -> bool:
    """An edge of triangle j of B goes through triangle i of A; s are the sides of B's corners; writes the point."""
    ux, uy, uz = A[i, 3] - A[i, 0], A[i, 4] - A[i, 1], A[i, 5] - A[i, 2]
    vx, vy, vz = A[i, 6] - A[i, 0], A[i, 7] - A[i, 1], A[i, 8] - A[i, 2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    for k in range(3):
        m = (k + 1) % 3
        if s[k] * s[m] > 0.0 or s[k] == s[m]:
            continue
        t = s[k] / (s[k] - s[m])
        x = B[j, 3 * k] + t * (B[j, 3 * m] - B[j, 3 * k])
        y = B[j, 3 * k + 1] + t * (B[j, 3 * m + 1] - B[j, 3 * k + 1])
        z = B[j, 3 * k + 2] + t * (B[j, 3 * m + 2] - B[j, 3 * k + 2])
        inside = True
        for p in range(3):
            q = (p + 1) % 3
            ex, ey, ez = A[i, 3 * q] - A[i, 3 * p], A[i, 3 * q + 1] - A[i, 3 * p + 1], A[i, 3 * q + 2] - A[i, 3 * p + 2]
            dx, dy, dz = x - A[i, 3 * p], y - A[i, 3 * p + 1], z - A[i, 3 * p + 2]
            c = nx * (ey * dz - ez * dy) + ny * (ez * dx - ex * dz) + nz * (ex * dy - ey * dx)
            inside = inside and c >= 0.0
        if inside:
            out[0], out[1], out[2], out[3], out[4], out[5] = x, y, z, x, y, z
            return True
    return False


@kernel
def _edges(A: Array, i: int, B: Array, j: int, best: float, out: Array) -> float:
    """Least of `best` and the squared distances of edge interiors; ends are left to the point-triangle tests.

    Only pairs of inner points count, so that nearly parallel edges, whose solution is ill conditioned, can never
    return less than the truth, and their ends return the truth.
    """
    for k in range(3):
        m = (k + 1) % 3
        ax, ay, az = A[i, 3 * k], A[i, 3 * k + 1], A[i, 3 * k + 2]
        ux, uy, uz = A[i, 3 * m] - ax, A[i, 3 * m + 1] - ay, A[i, 3 * m + 2] - az
        a = ux * ux + uy * uy + uz * uz
        for p in range(3):
            q = (p + 1) % 3
            bx, by, bz = B[j, 3 * p], B[j, 3 * p + 1], B[j, 3 * p + 2]
            vx, vy, vz = B[j, 3 * q] - bx, B[j, 3 * q + 1] - by, B[j, 3 * q + 2] - bz
            rx, ry, rz = ax - bx, ay - by, az - bz
            e = vx * vx + vy * vy + vz * vz
            b = ux * vx + uy * vy + uz * vz
            c = ux * rx + uy * ry + uz * rz
            f = vx * rx + vy * ry + vz * rz
            den = a * e - b * b
            s_den, t_den = b * f - c * e, a * f - b * c
            if s_den <= 0.0 or s_den >= den or t_den <= 0.0 or t_den >= den:
                continue
            s, t = s_den / den, t_den / den
            dx, dy, dz = rx + s * ux - t * vx, ry + s * uy - t * vy, rz + s * uz - t * vz
            d2 = dx * dx + dy * dy + dz * dz
            if d2 < best:
                best = d2
                out[0], out[1], out[2] = ax + s * ux, ay + s * uy, az + s * uz
                out[3], out[4], out[5] = bx + t * vx, by + t * vy, bz + t * vz
    return best


@kernel
def triangle_distance2(A: Array, i: int, B: Array, j: int, limit2: float, out: Array, s: Array) -> float:
    """Squared distance [mm2] of triangle i of A from triangle j of B, or `limit2` if it is not below that.

    Args:
        A, B: triangles, shape (n, 9) each [mm].
        limit2: what is not below this is not looked for.
        out: receives the nearest point of A's triangle and of B's, shape (6,), if the answer is below `limit2`.
        s: scratch, shape (6,).

    Returns:
        0 exactly where the triangles cross. Never less than the truth; above it by rounding alone (5e-11 mm for
        nearly parallel edges of slivers).
    """
    nn = _sides(A, i, B, j, s[:3])
    if _is_apart(s[:3], nn, limit2):
        return limit2
    mm = _sides(B, j, A, i, s[3:])
    if _is_apart(s[3:], mm, limit2):
        return limit2
    may_cross = min(s[0], s[1], s[2]) <= 0.0 <= max(s[0], s[1], s[2])
    may_cross = may_cross and min(s[3], s[4], s[5]) <= 0.0 <= max(s[3], s[4], s[5])
    if may_cross and (_pierces(A, i, B, j, s[:3], out) or _pierces(B, j, A, i, s[3:], out)):
        return 0.0
    best = limit2
    for k in range(3):
        x, y, z = A[i, 3 * k], A[i, 3 * k + 1], A[i, 3 * k + 2]
        d2, qx, qy, qz = closest_on_triangle(x, y, z, B, j)
        if d2 < best:
            best = d2
            out[0], out[1], out[2], out[3], out[4], out[5] = x, y, z, qx, qy, qz
        x, y, z = B[j, 3 * k], B[j, 3 * k + 1], B[j, 3 * k + 2]
        d2, qx, qy, qz = closest_on_triangle(x, y, z, A, i)
        if d2 < best:
            best = d2
            out[0], out[1], out[2], out[3], out[4], out[5] = qx, qy, qz, x, y, z
    return _edges(A, i, B, j, best, out)
