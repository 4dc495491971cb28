"""How far a body may move along a path before it touches another: searched on meshes, settled on the exact faces."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.joints import Joint
from linkwright.generator.assembly import AssembledBody

from .brep import TOUCH, BodyFaces, build_body_faces, compute_gap
from .contact.distance import compute_distance
from .contact.tree import ContactTree, build_tree
from .mating import body_triangles, steady_faces

Array = np.ndarray

#: The pose of the child seen from the parent after a travel [rad or mm].
Motion = Callable[[float], Array]

#: How far a search looks at first [mm].
_FIRST_LOOK = 0.5
#: Exact gaps from here on need not be known [mm].
_EXACT_MARGIN = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class Surroundings:
    """A body as the searches see it.

    Attributes:
        tree: its mesh.
        faces: its exact faces.
        corners: all corners of its mesh, shape (n, 3) [mm].
        deviation: of that mesh [mm].
    """

    tree: ContactTree
    faces: BodyFaces
    corners: Array
    deviation: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Travel:
    """How far it went.

    Attributes:
        extent: travel at contact, or the end of the search [rad or mm].
        is_stopped: by contact.
        parts: numbers of the parent's and the child's part that meet; (-1, -1) if none.
        point: where, in the parent's axes [mm].
    """

    extent: float
    is_stopped: bool
    parts: tuple[int, int] = (-1, -1)
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)


def build_surroundings(body: AssembledBody) -> Surroundings:
    """The tree, faces and corners of a body."""
    corners, groups, _ = body_triangles(body)
    return Surroundings(
        tree=build_tree(corners, groups),
        faces=build_body_faces(body),
        corners=np.unique(corners.reshape(-1, 3), axis=0),
        deviation=max(a.solid.mesh.deviation for a in body.parts),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Passage:
    """A child that moves along paths past its parent, but for the pairs of faces that cannot stop it.

    Attributes:
        parent, child: the two bodies.
        exempt_parent, exempt_child: bits of `steady_faces`, shape (n_faces,).
        where: names the pair in errors.
    """

    parent: Surroundings
    child: Surroundings
    exempt_parent: Array
    exempt_child: Array
    where: str

    def measure(self, path: Motion, *, rate: float, end: float, resolution: float) -> Travel:
        """How far the child gets.

        Args:
            path: of the child; path(0) is where it starts.
            rate: no point of the child moves farther than this per unit of travel [mm per rad, or 1].
            end: where the search stops [rad or mm].
            resolution: to which the contact is wanted [rad or mm]. A contact that is entered and left again within
                one resolution may be passed over.

        The meshes answer where contact is, within their deviation; the exact faces then settle it. If they stay
        apart beyond that (a gap below the meshes' deviation), the meshes' answer, which is the smaller, stands.
        """
        found = self._search(path, rate, end, resolution)
        if not found.is_stopped:
            return found
        start = max(0.0, found.extent - 4.0 * (self.parent.deviation + self.child.deviation) / rate - 2.0 * resolution)
        settled = self._settle(path, start, found.extent, rate, end, resolution)
        extent = found.extent if settled is None else settled
        return Travel(extent=extent, is_stopped=True, parts=found.parts, point=found.point)

    def _search(self, path: Motion, rate: float, end: float, resolution: float) -> Travel:
        """Conservative advancement: the child cannot reach the parent before it has travelled distance / rate."""
        travel, free, warm = 0.0, 0.0, (-1, -1)
        point: tuple[float, float, float] = (0.0, 0.0, 0.0)
        cutoff = _FIRST_LOOK
        while True:
            near = compute_distance(
                self.parent.tree,
                self.child.tree,
                path(travel),
                cutoff=cutoff,
                exempt_a=self.exempt_parent,
                exempt_b=self.exempt_child,
                warm=warm if warm[0] >= 0 else None,
            )
            if near.witness[0] >= 0:
                warm = near.witness
            if near.point_a is not None:
                point = tuple(float(x) for x in near.point_a)  # type: ignore[assignment]
            if near.value <= 0.0:
                return Travel(extent=0.5 * (free + travel), is_stopped=True, parts=self._parts(warm), point=point)
            if travel >= end:
                return Travel(extent=end, is_stopped=False)
            # Looking far is dear where much is near: twice as far after a free look, else not as far as the last gap.
            cutoff = 2.0 * cutoff if near.value >= cutoff else max(_FIRST_LOOK, 0.5 * near.value)
            free = min(end, travel + near.value / rate)
            travel = min(end, max(free, travel + resolution))

    def _parts(self, witness: tuple[int, int]) -> tuple[int, int]:
        if witness[0] < 0:
            return (-1, -1)
        face_a, face_b = self.parent.tree.groups[witness[0]], self.child.tree.groups[witness[1]]
        return int(self.parent.faces.parts[face_a]), int(self.child.faces.parts[face_b])

    def gap(self, T: Array) -> float:
        """The exact gap at a pose of the child, at most `_EXACT_MARGIN` [mm]."""
        return compute_gap(
            self.parent.faces,
            self.child.faces,
            T,
            self.exempt_parent,
            self.exempt_child,
            margin=_EXACT_MARGIN,
            where=self.where,
        )

    def _settle(
        self, path: Motion, start: float, near: float, rate: float, end: float, resolution: float
    ) -> float | None:
        """Where the exact gap first vanishes, from a free start near the meshes' contact; None if it does not.

        Steps follow the gap's measured slope, never beyond a known contact; the last prediction is the answer once
        it lies within the resolution.
        """
        low, back = start, 4.0 * resolution
        gap, high = self.gap(path(low)), None
        while gap <= TOUCH and low > 0.0:
            high, low, back = low, max(0.0, low - back), 2.0 * back
            gap = self.gap(path(low))
        if gap <= TOUCH:
            return 0.0
        slope, is_measured = rate, False
        give_up = min(end, near + max(64.0 * resolution, near - start))
        while low < give_up:
            ahead = gap / slope
            if is_measured and ahead <= 0.5 * resolution:
                return low + ahead
            if high is not None and high - low <= 0.5 * resolution:
                return 0.5 * (low + high)
            # A little short of a prediction, so that it ends free and near enough to be the last one.
            at = low + (ahead - 0.25 * resolution if is_measured else max(ahead, 0.1 * resolution))
            if high is not None and (at >= high or not is_measured):
                at = 0.5 * (low + high)
            here = self.gap(path(at))
            if here <= TOUCH:
                high, is_measured = at, False
                continue
            falls = (gap - here) / (at - low)
            is_measured = falls > 0.01 * rate
            slope = min(falls, rate) if is_measured else rate
            low, gap = at, here
        return None


def build_passage(parent: Surroundings, child: Surroundings, joint: Joint, where: str) -> Passage:
    """The passage of a joint's child past its parent."""
    return Passage(
        parent=parent,
        child=child,
        where=where,
        exempt_parent=steady_faces(parent.faces.body, joint, as_parent=True),
        exempt_child=steady_faces(child.faces.body, joint, as_parent=False),
    )
