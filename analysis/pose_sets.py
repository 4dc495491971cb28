"""Which poses the papers visit: axis-angle rings of orientations, Cartesian grids of positions, rays through a volume.

A set is a product, every orientation at every position, and is handed out in blocks: the papers' sets have millions of
poses, which need not lie in memory at once.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.poses import pose_from_task, rotation_about, task_from_pose

Array = np.ndarray


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseSet:
    """Every one of the turns at every one of the positions.

    Attributes:
        positions: the first coordinates of the task, shape (n_positions, k) [mm].
        turns: the coordinates after them, shape (n_turns, n_task - k) [rad, or mm for a grip]; one empty row for a
            task without any.
    """

    positions: Array
    turns: Array

    def __post_init__(self) -> None:
        for name in ("positions", "turns"):
            rows = np.array(getattr(self, name), dtype=float)
            if rows.ndim != 2 or len(rows) == 0:
                raise VacuousCheckError(f"pose set: {name} have shape {rows.shape}, so nothing is visited; give rows")
            rows.setflags(write=False)
            object.__setattr__(self, name, rows)

    def __len__(self) -> int:
        return len(self.positions) * len(self.turns)

    def poses(self, first: int = 0, last: int | None = None) -> Array:
        """Poses at the positions from `first` to before `last`, turns running fastest, shape (n, n_task)."""
        here = self.positions[first:last]
        k, n = here.shape[1], len(self.turns)
        out = np.empty((len(here), n, k + self.turns.shape[1]))
        out[..., :k], out[..., k:] = here[:, None], self.turns[None]
        return out.reshape(len(here) * n, -1)

    def blocks(self, n_poses: int) -> Iterator[tuple[int, int]]:
        """Ranges of positions that hold about so many poses each."""
        step = max(1, n_poses // len(self.turns))
        for first in range(0, len(self.positions), step):
            yield first, min(first + step, len(self.positions))

    def pose(self, index: int) -> Array:
        """The pose of this number, turns counted fastest, shape (n_task,)."""
        at, turn = divmod(index, len(self.turns))
        return np.concatenate([self.positions[at], self.turns[turn]])


def count_ring(bound: float, n_rings: int, ring: int) -> int:
    """How many directions the ring of this number (from 1) of a cone of half angle `bound` [rad] holds.

    Source: Stocco, Salcudean, Sassani, eq. (16), in double precision with a plain floor, as the printed counts need:
    exact arithmetic would give 35 and 169 where the paper has 34 and 168. Shown by: tests/papers/test_stocco_gii.py.
    """
    return math.floor(2.0 * math.pi * n_rings / bound * math.sin(ring * bound / n_rings))


def count_tilts(bound: float, n_rings: int) -> int:
    """Directions of all rings and the centre: K_r of eqs. (14) and (16)."""
    return 1 + sum(count_ring(bound, n_rings, ring) for ring in range(1, n_rings + 1))


def count_rings(bound: float, n_wanted: float) -> int:
    """The least number of rings that hold at least so many directions (eq. 15: as dense as the positions)."""
    n_rings = 1
    while count_tilts(bound, n_rings) < n_wanted:
        n_rings += 1
    return n_rings


def ring_tilts(bound: float, n_rings: int) -> Array:
    """Tilts (theta_1, theta_2) [rad]: the centre, then ring by ring evenly from theta_2 = 0, shape (K_r, 2).

    Args:
        bound: half angle of the cone [rad].
        n_rings: N, equally far apart.

    Source: Stocco, Salcudean, Sassani, eqs. (14)-(16).
    """
    if n_rings < 1 or not 0.0 < bound <= math.pi:
        raise VacuousCheckError(f"pose set: {n_rings} rings to {bound:g} rad; needed: 1 or more, in a cone up to pi")
    tilts = [(0.0, 0.0)]
    for ring in range(1, n_rings + 1):
        n = count_ring(bound, n_rings, ring)
        tilts += [(ring * bound / n_rings, 2.0 * math.pi * m / n) for m in range(n)]
    return np.array(tilts)


def pen_turns(tilts: Array, rolls: Sequence[float] = (0.0,)) -> Array:
    """Turns rx, ry, rz [rad] of a tool along its own y, tilted and then rolled about itself, shape (K * n_rolls, 3).

    At zero roll the tool's x stays normal to the base's z, so ry is 0; rolls run fastest.

    Args:
        tilts: angle, and direction of the tilt axis in the plane z, x, from x [rad], shape (K, 2).
        rolls: about the tool [rad].

    Source: Stocco, Salcudean, Sassani, section VI. Printed: no frame. Used: Rz Rx Ry. Shown by:
    tests/papers/test_stocco_haptic_pen.py.
    """
    t1, t2 = np.asarray(tilts, dtype=float).T
    rx, rz = np.arcsin(np.sin(t1) * np.cos(t2)), np.arctan2(np.sin(t1) * np.sin(t2), np.cos(t1))
    level = np.stack([rx, np.zeros_like(rx), rz], axis=-1)
    return _rolled(level, (0.0, 1.0, 0.0), rolls)


def plate_turns(tilts: Array, rolls: Sequence[float] = (0.0,)) -> Array:
    """Turns rx, ry, rz [rad] of a plate with its own z tilted about an axis in the plane x, y, then turned about z.

    Args:
        tilts: angle, and direction of the tilt axis from x [rad], shape (K, 2).
        rolls: about the plate's own z [rad]; they run fastest.
    """
    tilts = np.asarray(tilts, dtype=float)
    turned = []
    for t1, t2 in tilts:
        T = np.eye(4)
        T[:3, :3] = rotation_about(np.array([math.cos(t2), math.sin(t2), 0.0]), t1)
        turned.append(task_from_pose(T)[3:])
    return _rolled(np.array(turned), (0.0, 0.0, 1.0), rolls)


def _rolled(turns: Array, axis: tuple[float, float, float], rolls: Sequence[float]) -> Array:
    angles = np.asarray(rolls, dtype=float)
    if len(angles) == 1 and angles[0] == 0.0:
        return turns
    Ts = pose_from_task(np.concatenate([np.zeros_like(turns), turns], axis=-1))
    Ts = np.repeat(Ts[:, None], len(angles), axis=1)
    Ts[..., :3, :3] = Ts[..., :3, :3] @ rotation_about(np.array(axis), angles)
    return task_from_pose(Ts.reshape(-1, 4, 4))[:, 3:]


def grid_positions(lower: Sequence[float], upper: Sequence[float], counts: Sequence[int]) -> Array:
    """A Cartesian grid with its ends on a box, last coordinate fastest, shape (product of counts, k) [mm].

    A coordinate with one place is put in the middle.
    """
    axes = [
        np.linspace(low, high, n) if n > 1 else np.array([0.5 * (low + high)])
        for low, high, n in zip(lower, upper, counts, strict=True)
    ]
    return np.stack([a.ravel() for a in np.meshgrid(*axes, indexing="ij")], axis=-1)


def sphere_directions(n_rings: int) -> Array:
    """Unit vectors all around, about as far apart in every direction, shape (n, 3): rings from pole to pole."""
    t1, t2 = np.concatenate([ring_tilts(math.pi, n_rings), [(math.pi, 0.0)]]).T
    return np.stack([np.sin(t1) * np.cos(t2), np.sin(t1) * np.sin(t2), np.cos(t1)], axis=-1)


def ray_positions(centre: Sequence[float], directions: Array, step: float, n_steps: int) -> Array:
    """Positions along rays from a centre, ray by ray outwards, shape (n_rays * n_steps, k) [mm]; without the centre."""
    along = step * np.arange(1, n_steps + 1)
    rays = np.asarray(directions)[:, None, :] * along[None, :, None]
    return (np.asarray(centre, dtype=float) + rays).reshape(-1, np.shape(directions)[1])
