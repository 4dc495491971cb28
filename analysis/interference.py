"""How much two bodies overlap where they collide, and which of their parts."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from linkwright.designs.language.poses import invert_pose
from linkwright.generator.assembly import AssembledBody

from .contact.bodies import ContactBody, PairScan
from .contact.crossings import find_crossings
from .contact.overlap import Overlap, build_manifold, compute_overlap
from .jointed_faces import JointedFaces

Array = np.ndarray

#: Colliding poses at which volumes are taken, spread evenly over all of them: each costs some milliseconds.
N_EXAMINED = 12
#: Overlaps below this are what rounding leaves of a touch [mm3].
LEAST_VOLUME = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class Interference:
    """Two bodies that collide.

    Attributes:
        n_poses: colliding poses.
        n_examined: of these, the ones at which the volume was taken.
        pose: number of the pose, among those examined, with the largest overlap.
        volume: that overlap, over all colliding parts [mm3]; 0 if surfaces only touch.
        parts: the two parts that share most of it.
        centre: middle of what they share, in A's axes, shape (3,) [mm]; None if the volume is 0.
        is_swallowed: no surfaces cross there: a part of one lies in the other.
    """

    n_poses: int
    n_examined: int
    pose: int
    volume: float
    parts: tuple[str, str]
    centre: Array | None
    is_swallowed: bool


def measure_interference(
    body_a: AssembledBody,
    body_b: AssembledBody,
    a: ContactBody,
    b: ContactBody,
    Ts_ab: Array,
    found: PairScan,
    faces: JointedFaces | None,
) -> Interference:
    """The worst overlap among up to `N_EXAMINED` of the colliding poses.

    Only parts with faces that cross and are not exempt, or that are swallowed, count. A pair of such parts counts
    with all that it shares, mating faces included: the meshes' facets there may add a sliver.

    Args:
        body_a, body_b, a, b: the bodies, as assembled and as the engine takes them.
        Ts_ab: poses of B seen from A, shape (n, 4, 4) [mm].
        found: what the scan of these poses said.
        faces: what the joints of the two say, as given to that scan.
    """
    colliding = np.flatnonzero(found.is_colliding)
    spread = np.linspace(0, len(colliding) - 1, min(N_EXAMINED, len(colliding)))
    chosen = colliding[np.unique(spread.round().astype(int))]
    worst: tuple[float, int, tuple[int, int], Overlap] | None = None
    for pose in chosen.tolist():
        pairs = _colliding_parts(a, b, Ts_ab[pose], pose, found, faces)
        overlaps = {pair: _overlap(body_a, body_b, *pair, Ts_ab[pose]) for pair in pairs}
        if not overlaps:
            continue
        total = sum(overlap.volume for overlap in overlaps.values())
        main = max(overlaps, key=lambda pair: overlaps[pair].volume)
        if worst is None or total > worst[0]:
            worst = total, pose, main, overlaps[main]
    total, pose, (i, j), overlap = worst if worst is not None else (0.0, int(chosen[0]), (0, 0), _NOTHING)
    return Interference(
        n_poses=len(colliding),
        n_examined=len(chosen),
        pose=pose,
        volume=total if total > LEAST_VOLUME else 0.0,
        parts=(body_a.parts[i].part.name, body_b.parts[j].part.name),
        centre=overlap.centre,
        is_swallowed=bool(found.is_swallowed[pose]),
    )


_NOTHING = Overlap(volume=0.0, centre=None)


def _colliding_parts(
    a: ContactBody, b: ContactBody, T_ab: Array, pose: int, found: PairScan, faces: JointedFaces | None
) -> set[tuple[int, int]]:
    """Pairs of parts whose faces cross, and a swallowed part with every part of the body that holds it."""
    exempt_a, exempt_b = (faces.exempt_a, faces.exempt_b) if faces is not None else (None, None)
    crossing = find_crossings(a.tree, b.tree, T_ab, exempt_a=exempt_a, exempt_b=exempt_b)
    pairs = {(int(a.part_of_face[i]), int(b.part_of_face[j])) for i, j in crossing}
    if found.swallowed_b[pose] >= 0:
        pairs |= {(i, int(found.swallowed_b[pose])) for i in range(len(a.anchors))}
    if found.swallowed_a[pose] >= 0:
        pairs |= {(int(found.swallowed_a[pose]), j) for j in range(len(b.anchors))}
    return pairs


def _overlap(body_a: AssembledBody, body_b: AssembledBody, i: int, j: int, T_ab: Array) -> Overlap:
    part_a, part_b = body_a.parts[i], body_b.parts[j]
    T = invert_pose(part_a.T_body_part) @ T_ab @ part_b.T_body_part
    overlap = compute_overlap(_manifold(_Key(body_a, i)), _manifold(_Key(body_b, j)), T)
    if overlap.centre is None:
        return overlap
    R, p = part_a.T_body_part[:3, :3], part_a.T_body_part[:3, 3]
    return Overlap(volume=overlap.volume, centre=R @ overlap.centre + p)


class _Key:
    """A part of a body, equal to every part with the same mesh."""

    def __init__(self, body: AssembledBody, i: int) -> None:
        self.solid = body.parts[i].solid
        self.where = f"{body.body.name}: {body.parts[i].part.name}"

    def __hash__(self) -> int:
        return hash(self.solid.key)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and other.solid.key == self.solid.key


@lru_cache(maxsize=256)
def _manifold(key: _Key) -> Any:
    return build_manifold(key.solid.mesh, key.where)
