"""Which faces of two bodies cross at a pose: all of them, not the nearest alone."""

from __future__ import annotations

import numpy as np

from .distance import bound, move
from .kernel import kernel
from .tree import Arrays, ContactTree, group_bits
from .triangles import triangle_distance2

Array = np.ndarray

#: Squared distance below which triangles count as crossing [mm2]; crossings that are found give 0 exactly.
_NEXT_TO_NOTHING = 1e-24


@kernel
def _mark(
    a: Arrays, nodes_a: Array, bits_a: Array, b: Arrays, nodes_b: Array, bits_b: Array, T: Array, marks: Array
) -> None:
    """Sets marks[group of A, group of B] wherever pieces of the two cross."""
    stack, moved, points, s = np.empty((512, 2), np.int32), np.empty((64, 9)), np.empty(6), np.empty(6)
    stack[0, 0], stack[0, 1] = 0, 0
    top = 1
    while top > 0:
        top -= 1
        i, j = stack[top, 0], stack[top, 1]
        if nodes_a[i] & nodes_b[j] or bound(a.nodes, i, b.nodes, j, T, 1e-9) > 0.0:
            continue
        right_a, right_b = a.links[i, 0], b.links[j, 0]
        if right_a != 0 and (right_b == 0 or a.nodes[i, 3] > b.nodes[j, 3]):
            stack[top, 0], stack[top, 1] = i + 1, j
            stack[top + 1, 0], stack[top + 1, 1] = right_a, j
            top += 2
            continue
        if right_b != 0:
            stack[top, 0], stack[top, 1] = i, j + 1
            stack[top + 1, 0], stack[top + 1, 1] = i, right_b
            top += 2
            continue
        for q in range(b.links[j, 1], b.links[j, 1] + b.links[j, 2]):
            move(T, b.pieces, q, moved, 0)
            for p in range(a.links[i, 1], a.links[i, 1] + a.links[i, 2]):
                if bits_a[p] & bits_b[q] or marks[a.groups[p], b.groups[q]]:
                    continue
                if triangle_distance2(a.pieces, p, moved, 0, _NEXT_TO_NOTHING, points, s) < _NEXT_TO_NOTHING:
                    marks[a.groups[p], b.groups[q]] = True


def find_crossings(
    tree_a: ContactTree,
    tree_b: ContactTree,
    T_ab: Array,
    *,
    exempt_a: Array | None = None,
    exempt_b: Array | None = None,
) -> Array:
    """Groups of A and B whose triangles cross at a pose, exempt pairs left out, shape (k, 2).

    Args:
        tree_a, tree_b, exempt_a, exempt_b: see `distance.compute_distance`.
        T_ab: pose of B seen from A, shape (4, 4) [mm].
    """
    marks = np.zeros((tree_a.n_groups, tree_b.n_groups), dtype=np.bool_)
    T = np.ascontiguousarray(T_ab[:3], dtype=float).reshape(12)
    _mark(tree_a.arrays, *group_bits(tree_a, exempt_a), tree_b.arrays, *group_bits(tree_b, exempt_b), T, marks)
    return np.argwhere(marks)
