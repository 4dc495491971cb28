"""Which poses a check visits: seeded, and as often on the border of the workspace as inside it."""

from __future__ import annotations

import itertools

import numpy as np

from linkwright.designs.language.errors import VacuousCheckError

Array = np.ndarray


def sample_box(lower: Array, upper: Array, n: int, seed: int) -> Array:
    """Poses of a box, n of them, the same for the same seed.

    The first half (rounded up) is uniform inside. The rest lies on the border, where mechanisms meet their limits:
    every corner once, as long as corners are at most half of the rest; then poses of which a number of coordinates,
    uniform from one to all, drawn without preference, sits at one of its two bounds, and the others are uniform. So
    faces, edges of every order and corners are equally often met. A coordinate whose bounds agree stays there.

    Args:
        lower, upper: corners of the box, shape (k,) each [mm, rad].
        n: how many poses.
        seed: of the generator.

    Returns:
        Poses, shape (n, k).

    Raises:
        VacuousCheckError: no poses are asked for, or the box is empty.
    """
    lower, upper = np.asarray(lower, dtype=float), np.asarray(upper, dtype=float)
    if n < 1:
        raise VacuousCheckError(f"sampling: {n} poses are asked for, so nothing would be looked at; ask for 1 or more")
    if lower.ndim != 1 or lower.shape != upper.shape or len(lower) == 0:
        raise VacuousCheckError(
            f"sampling: the box has bounds of shapes {lower.shape} and {upper.shape}; give one pair per coordinate"
        )
    wrong = np.flatnonzero(~(lower <= upper))
    if len(wrong):
        i = int(wrong[0])
        raise VacuousCheckError(
            f"sampling: the box is empty: coordinate {i} runs from {lower[i]:g} to {upper[i]:g}; exchange its bounds"
        )
    rng = np.random.default_rng(seed)
    unit = rng.random((n, len(lower)))
    border = unit[(n + 1) // 2 :]
    corners = _corners(len(lower), len(border) // 2)
    border[: len(corners)] = corners
    _press_to_bounds(border[len(corners) :], rng)
    return np.clip(lower * (1.0 - unit) + upper * unit, lower, upper)


def _corners(k: int, at_most: int) -> Array:
    """All corners of the unit box of k coordinates, or none if they are too many, shape (2**k or 0, k)."""
    if 2**k > at_most:
        return np.zeros((0, k))
    return np.array(list(itertools.product((0.0, 1.0), repeat=k)))


def _press_to_bounds(unit: Array, rng: np.random.Generator) -> None:
    """Sets one to all coordinates of each row to 0 or 1, in place."""
    k = unit.shape[1]
    how_many = rng.integers(1, k + 1, size=(len(unit), 1))
    rank = np.argsort(np.argsort(rng.random(unit.shape), axis=1), axis=1)
    sides = rng.integers(0, 2, size=unit.shape).astype(float)
    np.copyto(unit, sides, where=rank < how_many)
