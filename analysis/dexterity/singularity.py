"""Where the nearest singular poses of both kinds are, seen from a pose.

Rays leave the pose in all directions of the task. On each the determinant of the motors' lines is watched: where it
changes its sign the parallel singularity, and with it the border of the assembly mode, has been crossed. Where a lever
runs out the serial singularity is met, which is the end of a motor's reach (a toggle). The first event ends a ray: what
lies behind it belongs to another assembly, or to none.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from linkwright.designs.language.mechanism import Mechanism

from .measures import compute_determinants, unit_lines
from .scaling import compute_hand_jacobian, with_length

Array = np.ndarray

#: A lever below this [mm/rad] is none: beyond its reach a leg's formulas keep it at rounding of zero.
_NO_LEVER = 1e-4
#: Rays, steps along each; parts into which the step with the event is cut, and how often (to 1e-12 of the step).
_N_RAYS, _N_STEPS, _N_PARTS, _N_CUTS = 500, 60, 32, 8
#: Rounds of rays near the best one, ever nearer, and rays a round.
_N_ROUNDS, _N_NEAR = 10, 24


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

    Joint limits and safety margins are not asked: they are there to keep clear of these poses. With more motors than
    coordinates the determinant has no sign to change, and only serial singularities are found: the other kind is then
    no border but a pose here and there, if any.

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
        best, distance = look.first_event(directions, kind, within)
        if not np.isfinite(distance):
            continue
        direction = directions[best]
        for k in range(_N_ROUNDS if len(look.pose) > 1 else 0):
            near = direction + rng.normal(size=(_N_NEAR, len(direction))) * 0.3 * 0.6**k
            near /= np.linalg.norm(near, axis=1, keepdims=True)
            i, closer = look.first_event(near, kind, distance)
            if closer < distance:
                direction, distance = near[i], closer
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
        self.sign = np.sign(self.watched(pose[None])[0][0])

    def at(self, directions: Array, distances: float | Array) -> Array:
        """Poses at distances [mm] along directions, shape (n, n_task)."""
        return self.pose + directions * self.scale * np.broadcast_to(distances, (len(directions),))[:, None]

    def watched(self, poses: Array) -> tuple[Array, Array]:
        """Determinant of the lines, and whether every lever is there, shape (n,) each."""
        with np.errstate(all="ignore"):
            G = with_length(compute_hand_jacobian(self.mechanism, poses), self.length)
        finite = np.all(np.isfinite(G), axis=(1, 2))
        W, levers = unit_lines(np.where(finite[:, None, None], G, 0.0))
        return compute_determinants(W), finite & (np.min(levers, axis=-1) > _NO_LEVER)

    def first_event(self, directions: Array, kind: Kind, within: float) -> tuple[int, float]:
        """The ray that meets an event of a kind nearest, and how far [mm]; infinitely far if none meets one first."""
        n, steps = len(directions), within * np.arange(_N_STEPS + 1) / _N_STEPS
        event, other = self._events(directions, np.tile(steps, (n, 1)), kind)
        first, before = _first(event), _first(other)
        first = np.where((first < before) & (first > 0), first, len(steps))
        nearest = int(np.min(first))
        if nearest == len(steps):
            return 0, np.inf
        # Only rays that meet it in the same step can be nearest; each is cut finer and finer around its event.
        rays = np.flatnonzero(first == nearest)
        low, high = np.full(len(rays), steps[nearest - 1]), np.full(len(rays), steps[nearest])
        for _ in range(_N_CUTS):
            inside = low[:, None] + (high - low)[:, None] * np.arange(1, _N_PARTS) / _N_PARTS
            event, _ = self._events(directions[rays], inside, kind)
            at = _first(event)[:, None]
            edges = np.concatenate([low[:, None], inside, high[:, None]], axis=1)
            low, high = (np.take_along_axis(edges, at + k, axis=1)[:, 0] for k in (0, 1))
        best = int(np.argmin(high))
        return int(rays[best]), float(high[best])

    def _events(self, directions: Array, distances: Array, kind: Kind) -> tuple[Array, Array]:
        """Whether an event of the kind, and one of the other kind, has happened at distances (n, k) along rays."""
        n, k = distances.shape
        poses = self.at(np.repeat(directions, k, axis=0), distances.ravel())
        determinant, has_levers = (a.reshape(n, k) for a in self.watched(poses))
        crossed = (np.sign(determinant) != self.sign) & has_levers
        return (crossed, ~has_levers) if kind is Kind.PARALLEL else (~has_levers, crossed)


def _first(events: Array) -> Array:
    """Column of the first event of each row; the number of columns where there is none."""
    return np.where(events.any(axis=1), np.argmax(events, axis=1), events.shape[1])
