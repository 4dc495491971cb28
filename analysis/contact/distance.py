"""The least distance of two bodies at a pose, and over many poses, exempting the pairs of faces that a joint mates.

Search: depth first over pairs of nodes, the nearer child first. One bound per pair: the distance to a convex set is
a convex function, so it lies above its tangent plane; with q the point of A's box nearest to the centre c of B's,
and n = (c - q) / |c - q|, no point of B's box is nearer to A's than |c - q| less the extent of B's box along n.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .kernel import kernel
from .tree import Arrays, ContactTree, group_bits
from .triangles import triangle_distance2

Array = np.ndarray

#: A node pair that promises less than this gain [mm] is not opened; so parallel faces end the search, and answers
#: are within this of the exact minimum.
TOLERANCE = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Distance:
    """How near two bodies are at one pose.

    Attributes:
        value: least distance over all pairs that are not exempt, 0 where surfaces cross; `cutoff` if not below [mm].
        point_a, point_b: where, in A's axes, shape (3,) [mm]; None if the cutoff was not undercut.
        witness: the pieces of A's and B's tree between which it lies, a good first guess at a neighbouring pose;
            (-1, -1) if none.
    """

    value: float
    point_a: Array | None
    point_b: Array | None
    witness: tuple[int, int]


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseScan:
    """How near two bodies come over n poses.

    Attributes:
        value: least distance over all poses, 0 where surfaces cross; inf if none is below the cutoff [mm].
        pose: number of the pose where it lies, -1 if none.
        point_a, point_b: where, in A's axes, shape (3,) [mm]; None if none.
        values: per pose its exact distance where that is below `need`, elsewhere a number that is not below `need`
            and not above the truth by more than `TOLERANCE`, shape (n,) [mm].
    """

    value: float
    pose: int
    point_a: Array | None
    point_b: Array | None
    values: Array


@kernel
def bound(A: Array, i: int, B: Array, j: int, T: Array, cutoff: float) -> float:
    """A lower bound of the distance of node j of B from node i of A, at pose T (rows of R and p, 12 numbers)."""
    bx, by, bz = B[j, 0], B[j, 1], B[j, 2]
    x = T[0] * bx + T[1] * by + T[2] * bz + T[3] - A[i, 0]
    y = T[4] * bx + T[5] * by + T[6] * bz + T[7] - A[i, 1]
    z = T[8] * bx + T[9] * by + T[10] * bz + T[11] - A[i, 2]
    d2 = x * x + y * y + z * z
    reach = cutoff + A[i, 3] + B[j, 3]
    if d2 >= reach * reach:
        return cutoff
    u = A[i, 7] * x + A[i, 8] * y + A[i, 9] * z
    v = A[i, 10] * x + A[i, 11] * y + A[i, 12] * z
    w = A[i, 13] * x + A[i, 14] * y + A[i, 15] * z
    u -= min(max(u, -A[i, 4]), A[i, 4])
    v -= min(max(v, -A[i, 5]), A[i, 5])
    w -= min(max(w, -A[i, 6]), A[i, 6])
    gap = np.sqrt(u * u + v * v + w * w)
    if gap == 0.0:
        return 0.0
    x = A[i, 7] * u + A[i, 10] * v + A[i, 13] * w
    y = A[i, 8] * u + A[i, 11] * v + A[i, 14] * w
    z = A[i, 9] * u + A[i, 12] * v + A[i, 15] * w
    u = T[0] * x + T[4] * y + T[8] * z
    v = T[1] * x + T[5] * y + T[9] * z
    w = T[2] * x + T[6] * y + T[10] * z
    extent = B[j, 4] * abs(B[j, 7] * u + B[j, 8] * v + B[j, 9] * w)
    extent += B[j, 5] * abs(B[j, 10] * u + B[j, 11] * v + B[j, 12] * w)
    extent += B[j, 6] * abs(B[j, 13] * u + B[j, 14] * v + B[j, 15] * w)
    low = gap - min(extent / gap, B[j, 3])
    if low >= cutoff:
        return cutoff
    # The same with the roles exchanged: tight where A's node is the flat one and B's the small one, and vice versa.
    x, y, z = A[i, 0] - T[3], A[i, 1] - T[7], A[i, 2] - T[11]
    u = T[0] * x + T[4] * y + T[8] * z - bx
    v = T[1] * x + T[5] * y + T[9] * z - by
    w = T[2] * x + T[6] * y + T[10] * z - bz
    x = B[j, 7] * u + B[j, 8] * v + B[j, 9] * w
    y = B[j, 10] * u + B[j, 11] * v + B[j, 12] * w
    z = B[j, 13] * u + B[j, 14] * v + B[j, 15] * w
    x -= min(max(x, -B[j, 4]), B[j, 4])
    y -= min(max(y, -B[j, 5]), B[j, 5])
    z -= min(max(z, -B[j, 6]), B[j, 6])
    gap = np.sqrt(x * x + y * y + z * z)
    if gap == 0.0:
        return max(0.0, low)
    u = B[j, 7] * x + B[j, 10] * y + B[j, 13] * z
    v = B[j, 8] * x + B[j, 11] * y + B[j, 14] * z
    w = B[j, 9] * x + B[j, 12] * y + B[j, 15] * z
    x = T[0] * u + T[1] * v + T[2] * w
    y = T[4] * u + T[5] * v + T[6] * w
    z = T[8] * u + T[9] * v + T[10] * w
    extent = A[i, 4] * abs(A[i, 7] * x + A[i, 8] * y + A[i, 9] * z)
    extent += A[i, 5] * abs(A[i, 10] * x + A[i, 11] * y + A[i, 12] * z)
    extent += A[i, 6] * abs(A[i, 13] * x + A[i, 14] * y + A[i, 15] * z)
    return max(0.0, low, gap - min(extent / gap, A[i, 3]))


@kernel
def move(T: Array, B: Array, j: int, out: Array, row: int) -> None:
    """Writes triangle j of B, seen from A, to a row of `out`."""
    for k in range(3):
        x, y, z = B[j, 3 * k], B[j, 3 * k + 1], B[j, 3 * k + 2]
        out[row, 3 * k] = T[0] * x + T[1] * y + T[2] * z + T[3]
        out[row, 3 * k + 1] = T[4] * x + T[5] * y + T[6] * z + T[7]
        out[row, 3 * k + 2] = T[8] * x + T[9] * y + T[10] * z + T[11]


@kernel
def _enough(best: float, exact_below: float, share: float) -> float:
    """The bound from which on a pair of nodes is not opened."""
    if best <= exact_below:
        return best - TOLERANCE
    return max(exact_below, best * (1.0 - share)) - TOLERANCE


@kernel
def _leaves(
    a: Arrays,
    bits_a: Array,
    i: int,
    b: Arrays,
    bits_b: Array,
    j: int,
    T: Array,
    best: float,
    witness: Array,
    points: Array,
    moved: Array,
    s: Array,
) -> float:
    """The least of `best` and the distances of the pieces of two leaves; keeps witness and points up to date."""
    first = b.links[j, 1]
    for q in range(b.links[j, 2]):
        move(T, b.pieces, first + q, moved, q)
    for p in range(a.links[i, 1], a.links[i, 1] + a.links[i, 2]):
        for q in range(b.links[j, 2]):
            if bits_a[p] & bits_b[first + q]:
                continue
            d2 = triangle_distance2(a.pieces, p, moved, q, best * best, points, s)
            if d2 < best * best:
                best = np.sqrt(d2)
                witness[0], witness[1] = p, first + q
    return best


@kernel
def _nearest(
    a: Arrays,
    nodes_a: Array,
    bits_a: Array,
    b: Arrays,
    nodes_b: Array,
    bits_b: Array,
    T: Array,
    best: float,
    exact_below: float,
    share: float,
    witness: Array,
    points: Array,
    stack: Array,
    bounds: Array,
    moved: Array,
    s: Array,
) -> float:
    """The least of `best` and the distance of two trees at pose T; see the module's docstring."""
    enough = _enough(best, exact_below, share)
    if nodes_a[0] & nodes_b[0] or bound(a.nodes, 0, b.nodes, 0, T, best) >= enough:
        return best
    stack[0, 0], stack[0, 1], bounds[0] = 0, 0, 0.0
    top = 1
    while top > 0:
        top -= 1
        if bounds[top] >= enough:
            continue
        i, j = stack[top, 0], stack[top, 1]
        right_a, right_b = a.links[i, 0], b.links[j, 0]
        if right_a == 0 and right_b == 0:
            best = _leaves(a, bits_a, i, b, bits_b, j, T, best, witness, points, moved, s)
            enough = _enough(best, exact_below, share)
            continue
        if right_b == 0 or (right_a != 0 and a.nodes[i, 3] > b.nodes[j, 3]):
            i1, i2, j1, j2 = i + 1, right_a, j, j
        else:
            i1, i2, j1, j2 = i, i, j + 1, right_b
        d1 = enough if nodes_a[i1] & nodes_b[j1] else bound(a.nodes, i1, b.nodes, j1, T, enough)
        d2 = enough if nodes_a[i2] & nodes_b[j2] else bound(a.nodes, i2, b.nodes, j2, T, enough)
        if d1 < d2:
            i1, i2, j1, j2, d1, d2 = i2, i1, j2, j1, d2, d1
        if d1 < enough:
            stack[top, 0], stack[top, 1], bounds[top] = i1, j1, d1
            top += 1
        if d2 < enough:
            stack[top, 0], stack[top, 1], bounds[top] = i2, j2, d2
            top += 1
    return best


@kernel
def _scan(
    a: Arrays,
    nodes_a: Array,
    bits_a: Array,
    b: Arrays,
    nodes_b: Array,
    bits_b: Array,
    Ts: Array,
    order: Array,
    need: float,
    best: float,
    share: float,
    values: Array,
    witness: Array,
    points: Array,
) -> tuple[float, int]:
    """Visits poses in an order; writes `values`; returns the least distance and its pose (or the first best, -1)."""
    stack, bounds = np.empty((512, 2), np.int32), np.empty(512)
    moved, s, here, found, T = np.empty((64, 9)), np.empty(6), np.empty(6), np.empty(2, np.int64), np.empty(12)
    pose = -1
    for k in order:
        T[:] = Ts[k, :3].copy().reshape(12)
        cutoff = max(best, need)
        d, warm = cutoff, False
        found[0], found[1] = witness[0], witness[1]
        if witness[0] >= 0 and not bits_a[witness[0]] & bits_b[witness[1]]:
            move(T, b.pieces, witness[1], moved, 0)
            d2 = triangle_distance2(a.pieces, witness[0], moved, 0, cutoff * cutoff, here, s)
            if d2 < cutoff * cutoff:
                d, warm = np.sqrt(d2), True
        e = _nearest(a, nodes_a, bits_a, b, nodes_b, bits_b, T, d, need, share, found, here, stack, bounds, moved, s)
        values[k] = e
        if (warm or e < d) and e < best:
            best, pose = e, k
            witness[0], witness[1] = found[0], found[1]
            points[:] = here
    return best, pose


def compute_distance(
    tree_a: ContactTree,
    tree_b: ContactTree,
    T_ab: Array,
    *,
    cutoff: float = np.inf,
    exempt_a: Array | None = None,
    exempt_b: Array | None = None,
    warm: tuple[int, int] | None = None,
) -> Distance:
    """The least distance of two surfaces at one pose.

    Args:
        tree_a, tree_b: the surfaces.
        T_ab: pose of B seen from A, shape (4, 4) [mm].
        cutoff: distances from here on are not looked for [mm].
        exempt_a, exempt_b: uint8 (or bool) per group of A and of B; a pair of triangles is left out exactly if the
            two share a bit, so a face may be exempt against its partner and against nothing else.
        warm: witness of a neighbouring pose.

    Returns:
        The distance, within `TOLERANCE` of the exact one. Containment is not distance: see `containment`.
    """
    scan = _run(tree_a, tree_b, np.asarray(T_ab, dtype=float)[None], 0.0, 0.0, cutoff, exempt_a, exempt_b, warm)
    return Distance(value=min(scan[0].value, cutoff), point_a=scan[0].point_a, point_b=scan[0].point_b, witness=scan[1])


def scan_poses(
    tree_a: ContactTree,
    tree_b: ContactTree,
    Ts_ab: Array,
    *,
    need: float = 0.0,
    share: float = 0.0,
    cutoff: float = np.inf,
    exempt_a: Array | None = None,
    exempt_b: Array | None = None,
    warm: tuple[int, int] | None = None,
) -> PoseScan:
    """The least distance of two surfaces over n poses, and exactly how near they are wherever below `need`.

    Args:
        tree_a, tree_b, exempt_a, exempt_b, warm: see `compute_distance`.
        Ts_ab: poses of B seen from A, shape (n, 4, 4) [mm].
        need: distances below this are wanted for every pose, not for the nearest alone, and exactly [mm].
        share: a least distance that is not below `need` may exceed the exact one by this share. Bodies that stay far
            apart with parallel faces cost a hundred times more to the last digit than to a thousandth.
        cutoff: least distances from here on are of no interest [mm].
    """
    return _run(tree_a, tree_b, np.asarray(Ts_ab, dtype=float), need, share, cutoff, exempt_a, exempt_b, warm)[0]


def _run(
    tree_a: ContactTree,
    tree_b: ContactTree,
    Ts: Array,
    need: float,
    share: float,
    cutoff: float,
    exempt_a: Array | None,
    exempt_b: Array | None,
    warm: tuple[int, int] | None,
) -> tuple[PoseScan, tuple[int, int]]:
    nodes_a, bits_a = group_bits(tree_a, exempt_a)
    nodes_b, bits_b = group_bits(tree_b, exempt_b)
    centres = Ts[:, :3, :3] @ tree_b.centre + Ts[:, :3, 3] - tree_a.centre
    gaps = np.linalg.norm(centres, axis=1) - tree_a.radius - tree_b.radius
    order = np.argsort(gaps, kind="stable")
    values, points = np.empty(len(Ts)), np.empty(6)
    witness = np.array(warm if warm is not None else (-1, -1), dtype=np.int64)
    best, pose = _scan(
        tree_a.arrays,
        nodes_a,
        bits_a,
        tree_b.arrays,
        nodes_b,
        bits_b,
        np.ascontiguousarray(Ts),
        order,
        float(need),
        float(cutoff),
        float(share),
        values,
        witness,
        points,
    )
    if pose < 0:
        return PoseScan(value=np.inf, pose=-1, point_a=None, point_b=None, values=values), (-1, -1)
    points.flags.writeable = False
    scan = PoseScan(value=float(best), pose=int(pose), point_a=points[:3], point_b=points[3:], values=values)
    return scan, (int(witness[0]), int(witness[1]))
