"""Where the nearest singular poses of both kinds are, seen from a pose.

Rays leave the pose in all directions of the task. On each the determinant of the motors' lines is watched: where it
changes its sign the parallel singularity, and with it the border of the assembly mode, has been crossed. Where a lever
runs out the serial singularity is met, which is the end of a motor's reach (a toggle).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from linkwright.designs.language.mechanism import Mechanism

from .measures import split_singularities
from .scaling import compute_hand_jacobian, with_length

Array = np.ndarray

#: A lever below this [mm/rad] is none: beyond its reach a leg's formulas keep it at rounding of zero.
_NO_LEVER = 1e-4
_N_STEPS, _N_RAYS, _N_HALVINGS, _N_ROUNDS = 60, 500, 40, 12


class Kind(StrEnum):
    """Which matrix loses its rank."""

    PARALLEL = "parallel"
    SERIAL = "serial"


@dataclass(frozen=True, slots=True, kw_only=True)
class NearestSingularity:
    """A singular pose, and how far it is.

    Attributes:
        kind: see `Kind`.
        pose: task coordinates there, shape (n_task,) [mm, rad].
        distance: from the pose asked about, turns times the length [mm]. No singular pose was found nearer, but rays
            have gaps: it is an upper bound of the true distance.
    """

    kind: Kind
    pose: Array
    distance: float


def find_nearest_singularities(
    mechanism: Mechanism, pose: Array, length: float, *, within: float, seed: int = 20041
) -> tuple[NearestSingularity, ...]:
    """The nearest singular pose of each kind, if there is any within a distance.

    Joint limits and safety margins are not asked: they are there to keep clear of these poses.

    Args:
        mechanism: measured.
        pose: from where, shape (n_task,) [mm, rad].
        length: millimetres per radian, for distance and Jacobian.
        within: how far to look, turns times the length [mm].
        seed: of the rays.
    """
    look = _Rays(mechanism, np.asarray(pose, dtype=float), length)
    rng = np.random.default_rng(seed)
    directions = _directions(len(look.pose), rng)
    found = []
    for kind in Kind:
        distances = look.first_events(directions, kind, within)
        best = int(np.argmin(distances))
        if not np.isfinite(distances[best]):
            continue
        direction, distance = directions[best], float(distances[best])
        for k in range(_N_ROUNDS if len(look.pose) > 1 else 0):
            near = direction + rng.normal(size=(40, len(direction))) * 0.3 * 0.6**k
            near /= np.linalg.norm(near, axis=1, keepdims=True)
            closer = look.first_events(near, kind, distance)
            i = int(np.argmin(closer))
            if closer[i] < distance:
                direction, distance = near[i], float(closer[i])
        found.append(NearestSingularity(kind=kind, pose=look.at(direction[None], distance)[0], distance=distance))
    return tuple(found)


def _directions(n: int, rng: np.random.Generator) -> Array:
    """Unit vectors: both ways along every coordinate, and evenly (in a plane) or at random around."""
    axes = np.concatenate([np.eye(n), -np.eye(n)])
    if n == 2:
        angle = 2.0 * np.pi * np.arange(_N_RAYS) / _N_RAYS
        return np.concatenate([axes, np.stack([np.cos(angle), np.sin(angle)], axis=-1)])
    around = rng.normal(size=(_N_RAYS, n))
    return np.concatenate([axes, around / np.linalg.norm(around, axis=1, keepdims=True)])


class _Rays:
    """Poses along rays from a pose, and the first singular one on each."""

    def __init__(self, mechanism: Mechanism, pose: Array, length: float) -> None:
        self.mechanism, self.pose, self.length = mechanism, pose, length
        self.scale = np.array([1.0 / length if c.unit == "deg" else 1.0 for c in mechanism.task])

    def at(self, directions: Array, distances: float | Array) -> Array:
        """Poses at distances [mm] along directions, shape (n, n_task)."""
        return self.pose + directions * self.scale * np.broadcast_to(distances, (len(directions),))[:, None]

    def watched(self, poses: Array) -> tuple[Array, Array]:
        """Determinant of the lines, and whether every lever is there, shape (n,) each."""
        with np.errstate(all="ignore"):
            G = with_length(compute_hand_jacobian(self.mechanism, poses), self.length)
        finite = np.all(np.isfinite(G), axis=(1, 2))
        determinant, _, levers = split_singularities(np.where(finite[:, None, None], G, 0.0))
        return determinant, finite & (np.min(levers, axis=-1) > _NO_LEVER)

    def first_events(self, directions: Array, kind: Kind, within: float) -> Array:
        """Distance of the first event of a kind on each ray [mm], infinite where none or another comes first."""
        n, steps = len(directions), within * np.arange(_N_STEPS + 1) / _N_STEPS
        poses = self.at(np.repeat(directions, len(steps), axis=0), np.tile(steps, n))
        determinant, has_levers = (a.reshape(n, -1) for a in self.watched(poses))
        sign = np.sign(determinant[:, :1])
        crossed = (np.sign(determinant) != sign) & has_levers
        event, other = (crossed, ~has_levers) if kind is Kind.PARALLEL else (~has_levers, crossed)
        first, before = _first(event), _first(other)
        rays = np.flatnonzero((first < before) & (first > 0))
        out = np.full(n, np.inf)
        if len(rays) == 0:
            return out
        low, high = steps[first[rays] - 1], steps[first[rays]]
        for _ in range(_N_HALVINGS):
            middle = 0.5 * (low + high)
            determinant, has_levers = self.watched(self.at(directions[rays], middle))
            is_past = ~has_levers if kind is Kind.SERIAL else np.sign(determinant) != sign[rays, 0]
            low, high = np.where(is_past, low, middle), np.where(is_past, middle, high)
        out[rays] = high
        return out


def _first(events: Array) -> Array:
    """Column of the first event of each row; the number of columns where there is none."""
    return np.where(events.any(axis=1), np.argmax(events, axis=1), events.shape[1])
