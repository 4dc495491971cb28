"""Whether points lie inside a closed surface: what distance cannot see, since a part that is swallowed touches nothing.

A ray from the point leaves the solid once more than it enters it exactly if the point is inside. The ray counts
only if it meets every triangle well inside or well outside; otherwise another direction is taken, and after some
the winding number, summed over all triangles, decides.
"""

from __future__ import annotations

import itertools
import math

import numpy as np

from .kernel import kernel
from .tree import Arrays, ContactTree
from .triangles import closest_on_triangle

Array = np.ndarray

#: Directions of no symmetry, so that a ray seldom runs along a face or through an edge of a machined part.
DIRECTIONS = np.array(
    [
        [0.4143, 0.5631, 0.7150],
        [-0.6174, 0.2719, 0.7381],
        [0.3307, -0.8513, -0.4074],
        [-0.2251, -0.3499, 0.9093],
    ]
)
#: A ray within this share of a triangle's border, or this near to its start [mm], does not count.
DOUBT = 1e-7


@kernel
def _misses(nodes: Array, i: int, o: Array, u: Array) -> bool:
    """The ray from o along u misses the box of node i."""
    near, far = 0.0, np.inf
    x, y, z = o[0] - nodes[i, 0], o[1] - nodes[i, 1], o[2] - nodes[i, 2]
    for k in range(3):
        a, b, c = nodes[i, 7 + 3 * k], nodes[i, 8 + 3 * k], nodes[i, 9 + 3 * k]
        start = a * x + b * y + c * z
        speed = a * u[0] + b * u[1] + c * u[2]
        half = nodes[i, 4 + k] + 1e-6
        if abs(speed) < 1e-12:
            if abs(start) > half:
                return True
            continue
        t1, t2 = (-half - start) / speed, (half - start) / speed
        near, far = max(near, min(t1, t2)), min(far, max(t1, t2))
    return near > far


@kernel
def _crossing(t: Array, o: Array, u: Array) -> tuple[int, bool, float]:
    """How the ray from o along u crosses a triangle: +1 out, -1 in, 0 not at all; whether that is sure; and where."""
    ax, ay, az = t[3] - t[0], t[4] - t[1], t[5] - t[2]
    bx, by, bz = t[6] - t[0], t[7] - t[1], t[8] - t[2]
    px, py, pz = u[1] * bz - u[2] * by, u[2] * bx - u[0] * bz, u[0] * by - u[1] * bx
    det = ax * px + ay * py + az * pz
    sx, sy, sz = o[0] - t[0], o[1] - t[1], o[2] - t[2]
    qx, qy, qz = sy * az - sz * ay, sz * ax - sx * az, sx * ay - sy * ax
    size = math.sqrt((ax * ax + ay * ay + az * az) * (bx * bx + by * by + bz * bz))
    if abs(det) <= 1e-13 * size:
        # The ray runs along the plane: sure only if it stays clear of it.
        nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
        off = abs(nx * sx + ny * sy + nz * sz)
        return 0, off > DOUBT * math.sqrt(nx * nx + ny * ny + nz * nz), 0.0
    v = (sx * px + sy * py + sz * pz) / det
    w = (u[0] * qx + u[1] * qy + u[2] * qz) / det
    d = (bx * qx + by * qy + bz * qz) / det
    least = min(v, w, 1.0 - v - w)
    if least < -DOUBT or d < -DOUBT:
        return 0, True, d
    if least < DOUBT or d < DOUBT:
        return 0, False, d
    return (1 if det < 0.0 else -1), True, d


@kernel
def _ray(tree: Arrays, o: Array, u: Array, stack: Array) -> tuple[int, bool, float]:
    """Exits less entries of a ray, whether the count is sure, and the way to the first crossing (inf if none)."""
    total, first = 0, np.inf
    stack[0], top = 0, 1
    while top > 0:
        top -= 1
        i = stack[top]
        if _misses(tree.nodes, i, o, u):
            continue
        if tree.links[i, 0] != 0:
            stack[top], stack[top + 1] = tree.links[i, 0], i + 1
            top += 2
            continue
        for k in range(tree.links[i, 1], tree.links[i, 1] + tree.links[i, 2]):
            crossing, is_sure, d = _crossing(tree.pieces[k], o, u)
            if not is_sure:
                return 0, False, 0.0
            if crossing != 0:
                total += crossing
                first = min(first, d)
    return total, True, first


@kernel
def _winding(pieces: Array, o: Array) -> float:
    """The winding number of a closed surface about o: the solid angle that it covers, over 4 pi.

    Source: van Oosterom and Strackee 1983, the solid angle of a plane triangle.
    """
    total = 0.0
    for k in range(len(pieces)):
        t = pieces[k]
        ax, ay, az = t[0] - o[0], t[1] - o[1], t[2] - o[2]
        bx, by, bz = t[3] - o[0], t[4] - o[1], t[5] - o[2]
        cx, cy, cz = t[6] - o[0], t[7] - o[1], t[8] - o[2]
        a = math.sqrt(ax * ax + ay * ay + az * az)
        b = math.sqrt(bx * bx + by * by + bz * bz)
        c = math.sqrt(cx * cx + cy * cy + cz * cz)
        det = ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
        ab, bc, ca = ax * bx + ay * by + az * bz, bx * cx + by * cy + bz * cz, cx * ax + cy * ay + cz * az
        total += 2.0 * math.atan2(det, a * b * c + ab * c + bc * a + ca * b)
    return total / (4.0 * math.pi)


@kernel
def _is_in(tree: Arrays, o: Array, directions: Array, stack: Array) -> bool:
    for k in range(len(directions)):
        total, is_sure, _ = _ray(tree, o, directions[k], stack)
        if is_sure:
            return total > 0
    return _winding(tree.pieces, o) > 0.5


@kernel
def _find_inside(tree: Arrays, points: Array, Ts: Array, directions: Array, out: Array) -> None:
    """Writes to out[i] the first of the points that is inside at pose i, or -1."""
    stack = np.empty(256, np.int64)
    o = np.empty(3)
    for i in range(len(Ts)):
        out[i] = -1
        for k in range(len(points)):
            r2 = 0.0
            for m in range(3):
                o[m] = Ts[i, m, 3]
                for n in range(3):
                    o[m] += Ts[i, m, n] * points[k, n]
                r2 += (o[m] - tree.nodes[0, m]) ** 2
            if r2 <= tree.nodes[0, 3] ** 2 and _is_in(tree, o, directions, stack):
                out[i] = k
                break


@kernel
def _depth(pieces: Array, x: float, y: float, z: float) -> float:
    best = np.inf
    for k in range(len(pieces)):
        best = min(best, closest_on_triangle(x, y, z, pieces, k)[0])
    return math.sqrt(best)


@kernel
def _inward(tree: Arrays, starts: Array, inward: Array) -> tuple[Array, float]:
    """The middle of that inward chord, of several, which lies deepest under the surface, and how deep."""
    stack = np.empty(256, np.int64)
    best, deepest = np.zeros(3), -1.0
    for k in range(len(starts)):
        o = starts[k] + 1e-6 * inward[k]
        total, is_sure, d = _ray(tree, o, inward[k], stack)
        if not is_sure or total <= 0 or not np.isfinite(d):
            continue
        o += 0.5 * d * inward[k]
        depth = _depth(tree.pieces, o[0], o[1], o[2])
        if depth > deepest:
            deepest = depth
            best[:] = o
    return best, deepest


def is_inside(tree: ContactTree, points: Array) -> Array:
    """Which points lie inside the solid that a closed, outward surface bounds, shape (n,).

    Args:
        tree: the surface; several shells may overlap.
        points: shape (n, 3), in the tree's axes [mm].
    """
    points = np.ascontiguousarray(points, dtype=float).reshape(-1, 3)
    out = np.empty(1, np.int64)
    inside = np.zeros(len(points), bool)
    for i, point in enumerate(points):
        _find_inside(tree.arrays, point[None], np.eye(4)[None], DIRECTIONS, out)
        inside[i] = out[0] >= 0
    return inside


def find_inside(tree: ContactTree, points: Array, Ts: Array) -> Array:
    """At each of n poses the first of the points that lies inside the solid, or -1, shape (n,).

    Args:
        tree: the surface of the solid.
        points: points of another body in its own axes, shape (m, 3) [mm].
        Ts: poses of that body seen from the solid, shape (n, 4, 4) [mm].
    """
    out = np.full(len(Ts), -1, np.int64)
    _find_inside(
        tree.arrays,
        np.ascontiguousarray(points, dtype=float).reshape(-1, 3),
        np.ascontiguousarray(Ts, dtype=float),
        DIRECTIONS,
        out,
    )
    return out


def compute_winding_numbers(tree: ContactTree, points: Array) -> Array:
    """How often the surface wraps around each point: 1 inside one shell, 0 outside, shape (n,)."""
    points = np.ascontiguousarray(points, dtype=float).reshape(-1, 3)
    return np.array([_winding(tree.pieces, point) for point in points])


def compute_anchor(tree: ContactTree, n_tries: int = 12) -> tuple[Array, float]:
    """A point well inside a closed solid, and its depth under the surface [mm].

    If another body holds this point, the two overlap, whatever faces they mate with; and where no surfaces cross,
    a connected part lies in the other body exactly if this point does.

    Args:
        tree: one part's surface.
        n_tries: chords tried, from its largest pieces inward.

    Returns:
        The point, shape (3,), and its depth; the depth is negative if no chord was found (an open or inverted mesh).
    """
    p = tree.pieces.reshape(-1, 3, 3)
    normals = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    areas = np.linalg.norm(normals, axis=1)
    # One piece out of each of n_tries regions of the tree, its largest, so that they lie all over the surface.
    edges = np.linspace(0, len(p), min(n_tries, len(p)) + 1).astype(int)
    chosen = np.array([lo + int(np.argmax(areas[lo:hi])) for lo, hi in itertools.pairwise(edges)])
    # Not the centroid: the middle of a symmetric face looks at the middle, an edge or a hole of the opposite one.
    starts = np.einsum("j,ijk->ik", np.array([0.41, 0.35, 0.24]), p[chosen])
    point, depth = _inward(tree.arrays, starts, -normals[chosen] / areas[chosen, None])
    return point, float(depth)
