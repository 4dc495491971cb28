"""A body's surface as a tree of oriented boxes over small pieces of its triangles, built once and only re-posed.

A node is a row of 16 numbers: centre (3), radius of the ball about it, half extents (3), the box's axes as rows (9).
Nodes stand in preorder, so the left child of node i is i + 1 and `links[i, 0]` is the right one (0 at a leaf).
"""

from __future__ import annotations

import io
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from linkwright.designs.language.errors import BuildError

from .kernel import kernel

Array = np.ndarray

#: Longest edge of a piece [mm]: long thin triangles of planar faces make large boxes, small pieces many of them.
MAX_EDGE = 8.0
#: Pieces in a leaf at most.
LEAF_SIZE = 4


class Arrays(NamedTuple):
    """What the kernels see of a tree."""

    nodes: Array
    links: Array
    pieces: Array
    groups: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactTree:
    """The searchable surface of a body, in the body's own axes.

    Attributes:
        nodes: boxes, shape (n_nodes, 16) [mm].
        links: right child (0 at a leaf), first piece, number of pieces, shape (n_nodes, 3).
        pieces: triangles cut to `MAX_EDGE`, three corners each, shape (n_pieces, 9) [mm].
        groups: group of the triangle that each piece comes from, shape (n_pieces,).
        sources: that triangle, shape (n_pieces,).
    """

    nodes: Array
    links: Array
    pieces: Array
    groups: Array
    sources: Array
    arrays: Arrays = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        for array in (self.nodes, self.links, self.pieces, self.groups, self.sources):
            array.flags.writeable = False
        object.__setattr__(self, "arrays", Arrays(self.nodes, self.links, self.pieces, self.groups))

    @property
    def centre(self) -> Array:
        """Centre of the ball that holds the whole surface, shape (3,) [mm]."""
        return self.nodes[0, :3]

    @property
    def radius(self) -> float:
        """Its radius [mm]."""
        return float(self.nodes[0, 3])

    @property
    def n_groups(self) -> int:
        """One more than the largest group."""
        return int(self.groups.max()) + 1

    def to_bytes(self) -> bytes:
        """The tree as the bytes of an npz archive."""
        out = io.BytesIO()
        names = ("nodes", "links", "pieces", "groups", "sources")
        np.savez(out, **{name: getattr(self, name) for name in names})
        return out.getvalue()

    @classmethod
    def from_bytes(cls, data: bytes) -> ContactTree:
        """The tree that `to_bytes` wrote."""
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            return cls(**{name: archive[name] for name in ("nodes", "links", "pieces", "groups", "sources")})


def build_tree(
    triangles: Array,
    groups: Array | None = None,
    *,
    classes: Array | None = None,
    max_edge: float = MAX_EDGE,
    leaf_size: int = LEAF_SIZE,
) -> ContactTree:
    """The tree over a set of triangles.

    Args:
        triangles: corners, shape (m, 3, 3) [mm].
        groups: a number per triangle by which queries exempt it (the global number of its face), shape (m,).
        classes: a number per group, shape (n_groups,). Groups of different classes part at the top of the tree; where
            queries exempt whole classes, nodes near a joint are then exempt as a whole or not at all, which is a
            hundred times faster there. Answers do not depend on it.
        max_edge: longest edge of a piece [mm].
        leaf_size: most pieces in a leaf.

    Raises:
        BuildError: no triangles, or corners that are not finite.
    """
    flat = np.ascontiguousarray(triangles, dtype=np.float64).reshape(-1, 9)
    if len(flat) == 0:
        raise BuildError("contact tree", "the surface has no triangles; give a closed mesh")
    if not np.isfinite(flat).all():
        raise BuildError("contact tree", f"{int((~np.isfinite(flat)).any(axis=1).sum())} triangles are not finite")
    of_triangle = np.zeros(len(flat), np.int32) if groups is None else np.asarray(groups, dtype=np.int32)
    pieces, sources = _cut(flat, max_edge)
    of_piece = np.zeros(len(pieces), np.int64)
    if classes is not None:
        of_piece = np.asarray(classes, dtype=np.int64)[of_triangle[sources]]
    order = np.argsort(of_piece, kind="stable")
    nodes, links = _grow(pieces, order, of_piece, leaf_size)
    sources = sources[order]
    return ContactTree(
        nodes=nodes,
        links=links,
        pieces=np.ascontiguousarray(pieces[order]),
        sources=sources,
        groups=np.ascontiguousarray(of_triangle[sources]),
    )


def group_bits(tree: ContactTree, bits: Array | None) -> tuple[Array, Array]:
    """What a query exempts, per node and per piece.

    Args:
        tree: the surface.
        bits: uint8 per group; a pair of pieces is exempt if they share a bit. None exempts nothing.

    Returns:
        The bits that all pieces of a node share, shape (n_nodes,), and the bits of each piece, shape (n_pieces,).
    """
    if bits is None:
        return np.zeros(len(tree.nodes), np.uint8), np.zeros(len(tree.pieces), np.uint8)
    of_piece = np.asarray(bits, dtype=np.uint8)[tree.groups]
    return _shared_bits(tree.links, of_piece), of_piece


@kernel
def _shared_bits(links: Array, of_piece: Array) -> Array:
    out = np.empty(len(links), np.uint8)
    for i in range(len(links) - 1, -1, -1):
        if links[i, 0]:
            out[i] = out[i + 1] & out[links[i, 0]]
        else:
            bits = np.uint8(255)
            for k in range(links[i, 1], links[i, 1] + links[i, 2]):
                bits &= of_piece[k]
            out[i] = bits
    return out


@kernel
def _longest(t: Array) -> tuple[int, float]:
    """The longest edge of a triangle (its number) and its squared length."""
    best, at = -1.0, 0
    for k in range(3):
        m = (k + 1) % 3
        d = (t[3 * k] - t[3 * m]) ** 2 + (t[3 * k + 1] - t[3 * m + 1]) ** 2 + (t[3 * k + 2] - t[3 * m + 2]) ** 2
        if d > best:
            best, at = d, k
    return at, best


@kernel
def _cut(triangles: Array, max_edge: float) -> tuple[Array, Array]:
    """Triangles cut at the middle of their longest edge until none is longer; and where each piece comes from."""
    capacity = 2 * len(triangles) + 16
    pieces = np.empty((capacity, 9))
    sources = np.empty(capacity, np.int32)
    stack = np.empty((128, 9))
    n = 0
    for i in range(len(triangles)):
        stack[0] = triangles[i]
        top = 1
        while top > 0:
            top -= 1
            t = stack[top].copy()
            k, d2 = _longest(t)
            if d2 > max_edge * max_edge and top < 126:
                m, o = (k + 1) % 3, (k + 2) % 3
                for c in range(3):
                    middle = 0.5 * (t[3 * k + c] + t[3 * m + c])
                    stack[top, c], stack[top + 1, c] = t[3 * k + c], middle
                    stack[top, 3 + c], stack[top + 1, 3 + c] = middle, t[3 * m + c]
                    stack[top, 6 + c], stack[top + 1, 6 + c] = t[3 * o + c], t[3 * o + c]
                top += 2
                continue
            if n == capacity:
                capacity *= 2
                more, from_ = np.empty((capacity, 9)), np.empty(capacity, np.int32)
                more[:n], from_[:n] = pieces, sources
                pieces, sources = more, from_
            pieces[n] = t
            sources[n] = i
            n += 1
    return pieces[:n].copy(), sources[:n].copy()


@kernel
def _principal_axes(C: Array, U: Array) -> None:
    """Writes the eigenvectors of the symmetric 3x3 matrix C as rows of U (Jacobi); C is spent."""
    U[:] = 0.0
    for k in range(3):
        U[k, k] = 1.0
    for _ in range(12):
        off = abs(C[0, 1]) + abs(C[0, 2]) + abs(C[1, 2])
        if off <= 1e-14 * (abs(C[0, 0]) + abs(C[1, 1]) + abs(C[2, 2])):
            return
        for p in range(2):
            for q in range(p + 1, 3):
                if C[p, q] == 0.0:
                    continue
                theta = (C[q, q] - C[p, p]) / (2.0 * C[p, q])
                t = 1.0 / (abs(theta) + np.sqrt(theta * theta + 1.0))
                if theta < 0.0:
                    t = -t
                c = 1.0 / np.sqrt(t * t + 1.0)
                s = t * c
                for k in range(3):
                    a, b = C[k, p], C[k, q]
                    C[k, p], C[k, q] = c * a - s * b, s * a + c * b
                for k in range(3):
                    a, b = C[p, k], C[q, k]
                    C[p, k], C[q, k] = c * a - s * b, s * a + c * b
                    a, b = U[p, k], U[q, k]
                    U[p, k], U[q, k] = c * a - s * b, s * a + c * b


@kernel
def _extent(pieces: Array, order: Array, lo: int, hi: int, U: Array, low: Array, high: Array) -> None:
    """Writes the bounds of the pieces order[lo:hi] along the rows of U."""
    low[:], high[:] = np.inf, -np.inf
    for i in range(lo, hi):
        t = pieces[order[i]]
        for v in range(3):
            for k in range(3):
                x = U[k, 0] * t[3 * v] + U[k, 1] * t[3 * v + 1] + U[k, 2] * t[3 * v + 2]
                low[k], high[k] = min(low[k], x), max(high[k], x)


@kernel
def _covariance(pieces: Array, order: Array, lo: int, hi: int, C: Array) -> None:
    """Writes the scatter of the corners of the pieces order[lo:hi] about their mean."""
    mean = np.zeros(3)
    for i in range(lo, hi):
        for v in range(3):
            for k in range(3):
                mean[k] += pieces[order[i], 3 * v + k]
    mean /= 3.0 * (hi - lo)
    C[:] = 0.0
    for i in range(lo, hi):
        for v in range(3):
            for k in range(3):
                for m in range(3):
                    C[k, m] += (pieces[order[i], 3 * v + k] - mean[k]) * (pieces[order[i], 3 * v + m] - mean[m])


@kernel
def _fit(pieces: Array, order: Array, lo: int, hi: int, node: Array) -> None:
    """Writes the better of the upright and the principal box of the pieces order[lo:hi], and its ball, to a node.

    Better is the one with less surface: how often a box is visited grows with its surface.
    """
    U, C, low, high = np.eye(3), np.empty((3, 3)), np.empty(3), np.empty(3)
    least = np.inf
    for attempt in range(2):
        if attempt == 1:
            _covariance(pieces, order, lo, hi, C)
            _principal_axes(C, U)
        _extent(pieces, order, lo, hi, U, low, high)
        e = high - low
        surface = e[0] * e[1] + e[1] * e[2] + e[2] * e[0]
        if surface < least * (1.0 - 1e-9):
            least = surface
            for k in range(3):
                node[k] = 0.0
                for m in range(3):
                    node[k] += 0.5 * (low[m] + high[m]) * U[m, k]
                    node[7 + 3 * k + m] = U[k, m]
                # Rounding of the rotated corners; far below every length that matters.
                node[4 + k] = 0.5 * e[k] + 1e-12 * (abs(low[k]) + abs(high[k]))
    r2 = 0.0
    for i in range(lo, hi):
        for v in range(3):
            d2 = 0.0
            for k in range(3):
                d2 += (pieces[order[i], 3 * v + k] - node[k]) ** 2
            r2 = max(r2, d2)
    node[3] = np.sqrt(r2) * (1.0 + 1e-12)


@kernel
def _halve(pieces: Array, order: Array, lo: int, hi: int, axis: Array) -> int:
    """Reorders order[lo:hi] about the median of the centroids along an axis; returns the middle."""
    keys = np.empty(hi - lo)
    for i in range(lo, hi):
        t = pieces[order[i]]
        keys[i - lo] = axis[0] * (t[0] + t[3] + t[6]) + axis[1] * (t[1] + t[4] + t[7]) + axis[2] * (t[2] + t[5] + t[8])
    mid = (hi - lo) // 2
    left, right = 0, hi - lo - 1
    while left < right:
        pivot, i, j = keys[(left + right) // 2], left, right
        while i <= j:
            while keys[i] < pivot:
                i += 1
            while keys[j] > pivot:
                j -= 1
            if i <= j:
                keys[i], keys[j] = keys[j], keys[i]
                order[lo + i], order[lo + j] = order[lo + j], order[lo + i]
                i, j = i + 1, j - 1
        if mid <= j:
            right = j
        elif mid >= i:
            left = i
        else:
            break
    return lo + mid


@kernel
def _grow(pieces: Array, order: Array, classes: Array, leaf_size: int) -> tuple[Array, Array]:
    """Nodes and links over the pieces; reorders `order` (sorted by class) so that a node's pieces are consecutive."""
    nodes = np.empty((2 * len(pieces), 16))
    links = np.zeros((2 * len(pieces), 3), np.int32)
    stack = np.empty((128, 3), np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2] = 0, len(pieces), -1
    top, n = 1, 0
    while top > 0:
        top -= 1
        lo, hi, parent = stack[top, 0], stack[top, 1], stack[top, 2]
        if parent >= 0:
            links[parent, 0] = n
        _fit(pieces, order, lo, hi, nodes[n])
        links[n, 1], links[n, 2] = lo, hi - lo
        if hi - lo > leaf_size or classes[order[lo]] != classes[order[hi - 1]]:
            if classes[order[lo]] != classes[order[hi - 1]]:
                mid = lo + 1
                while classes[order[mid]] == classes[order[lo]]:
                    mid += 1
            else:
                k = np.argmax(nodes[n, 4:7])
                mid = _halve(pieces, order, lo, hi, nodes[n, 7 + 3 * k : 10 + 3 * k])
            stack[top, 0], stack[top, 1], stack[top, 2] = mid, hi, n
            stack[top + 1, 0], stack[top + 1, 1], stack[top + 1, 2] = lo, mid, -1
            top += 2
        n += 1
    return nodes[:n].copy(), links[:n].copy()
