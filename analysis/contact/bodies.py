"""A body as the contact engine takes it, and how near two of them come over a set of poses."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.poses import invert_pose
from linkwright.generator.assembly import AssembledBody

from ..jointed_faces import JointedFaces
from ..mating import body_triangles
from .containment import compute_anchor, find_inside
from .distance import PoseScan, scan_poses
from .tree import ContactTree, build_tree

Array = np.ndarray

#: Surfaces nearer than this cross or touch [mm]; what is left of an exact 0 after rounding.
TOUCH = 1e-9


@dataclass(frozen=True, slots=True, kw_only=True)
class ContactBody:
    """What two bodies of one kind share.

    Attributes:
        tree: surface of all parts in the body's axes; groups are the numbers of the faces in the body.
        part_of_face: number of the part of each face, shape (n_faces,).
        anchors: a point well inside each part, shape (n_parts, 3) [mm].
        deviation: largest distance of a solid's surface from its mesh [mm].
    """

    tree: ContactTree
    part_of_face: Array
    anchors: Array
    deviation: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PairScan:
    """Two bodies over n poses.

    Attributes:
        scan: distances of their surfaces.
        swallowed_b: per pose a part of B that lies in A though no surfaces cross, or -1, shape (n,).
        swallowed_a: the same for a part of A in B.
    """

    scan: PoseScan
    swallowed_b: Array
    swallowed_a: Array

    @property
    def is_swallowed(self) -> Array:
        """A part of one lies in the other, shape (n,)."""
        return (self.swallowed_b >= 0) | (self.swallowed_a >= 0)

    @property
    def is_colliding(self) -> Array:
        """Surfaces cross or touch, or a part is swallowed, shape (n,)."""
        return (self.scan.values <= TOUCH) | self.is_swallowed


def build_contact_body(body: AssembledBody, classes: Array | None = None) -> ContactBody:
    """The searchable surface of a body.

    Args:
        body: with its solids.
        classes: a number per face, see `tree.build_tree`: which joints the face runs in.

    Raises:
        BuildError: a part's mesh has no inside.
    """
    triangles, faces, parts = body_triangles(body)
    anchors = []
    for i, assembled in enumerate(body.parts):
        where = f"{body.body.name}: {assembled.part.name}"
        point, depth = compute_anchor(build_tree(triangles[parts == i], max_edge=np.inf))
        if not depth > 0.0:
            raise BuildError(where, "no point inside its mesh was found; the mesh is open or inside out")
        anchors.append(point)
    return ContactBody(
        tree=build_tree(triangles, faces, classes=classes),
        part_of_face=np.repeat(np.arange(len(body.parts)), [len(p.solid.surfaces) for p in body.parts]),
        anchors=np.array(anchors),
        deviation=max(p.solid.mesh.deviation for p in body.parts),
    )


def scan_pair(
    a: ContactBody, b: ContactBody, Ts_ab: Array, *, need: float, share: float = 0.0, faces: JointedFaces | None = None
) -> PairScan:
    """How near two bodies come over n poses, and whether one holds a part of the other.

    Args:
        a, b: the bodies.
        Ts_ab: poses of B seen from A, shape (n, 4, 4) [mm].
        need: distances below this are wanted at every pose, exactly [mm].
        share: by which a least distance above `need` may exceed the exact one.
        faces: what the joints of the two say about their faces, if there are any.
    """
    scan = _scan(a, b, Ts_ab, need, share, faces)
    swallowed_a, swallowed_b = np.full(len(Ts_ab), -1), np.full(len(Ts_ab), -1)
    apart = np.linalg.norm(Ts_ab[:, :3, :3] @ b.tree.centre + Ts_ab[:, :3, 3] - a.tree.centre, axis=1)
    open_ = np.flatnonzero((apart < a.tree.radius + b.tree.radius) & (scan.values > TOUCH))
    if len(open_):
        swallowed_b[open_] = find_inside(a.tree, b.anchors, Ts_ab[open_])
        swallowed_a[open_] = find_inside(b.tree, a.anchors, invert_pose(Ts_ab[open_]))
    return PairScan(scan=scan, swallowed_a=swallowed_a, swallowed_b=swallowed_b)


def _scan(a: ContactBody, b: ContactBody, Ts: Array, need: float, share: float, faces: JointedFaces | None) -> PoseScan:
    """Distances over all poses; pairs of faces that keep their distance are looked at once.

    The first pose gives an upper bound of the steady pairs' distance, and so of the least one. If it is below
    `need`, they are looked at again where all others are farthest away: either the steady ones are nearer there, and
    then their distance is known, or they are farther than the others at every pose.
    """
    if faces is None:
        return scan_poses(a.tree, b.tree, Ts, need=need, share=share)

    def at_one(k: int) -> PoseScan:
        scan = scan_poses(
            a.tree, b.tree, Ts[k : k + 1], need=need, share=share, exempt_a=faces.exempt_a, exempt_b=faces.exempt_b
        )
        return dataclasses.replace(scan, pose=k if scan.pose == 0 else -1)

    first = at_one(0)
    moving = scan_poses(
        a.tree, b.tree, Ts, need=need, share=share, cutoff=first.value, exempt_a=faces.steady_a, exempt_b=faces.steady_b
    )
    looked, values = [moving, first], moving.values
    if first.value < need:
        far = int(np.argmax(values))
        looked.append(at_one(far))
        if looked[-1].value < values[far]:
            values = np.minimum(values, looked[-1].value)
    return dataclasses.replace(min(looked, key=lambda scan: scan.value), values=values)
