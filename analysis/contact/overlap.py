"""How much two closed meshes share: the exact volume of their intersection."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.designs.language.errors import BuildError

if TYPE_CHECKING:
    from linkwright.generator.mesh import Mesh

Array = np.ndarray


@dataclass(frozen=True, slots=True, kw_only=True)
class Overlap:
    """What two meshes share.

    Attributes:
        volume: of the intersection [mm3].
        centre: middle of the box around it, in A's axes, shape (3,) [mm]; None if the volume is 0.
    """

    volume: float
    centre: Array | None


def build_manifold(mesh: Mesh, where: str) -> Any:
    """The mesh as manifold3d takes it.

    Raises:
        BuildError: the mesh is not closed.
    """
    import manifold3d

    # The binding takes no locked arrays: hence copies.
    body = manifold3d.Manifold(
        manifold3d.Mesh64(
            vert_properties=np.array(mesh.vertices, dtype=np.float64),
            tri_verts=np.array(mesh.triangles, dtype=np.uint64),
        )
    )
    if body.status() != manifold3d.Error.NoError:
        raise BuildError(where, f"its mesh does not bound a volume ({body.status().name}); overlaps cannot be measured")
    return body


def compute_overlap(a: Any, b: Any, T_ab: Array) -> Overlap:
    """The intersection of two bodies of `build_manifold`, B placed at T_ab, shape (4, 4) [mm]."""
    shared = a ^ b.transform(np.ascontiguousarray(T_ab[:3], dtype=float))
    volume = float(shared.volume())
    if volume <= 0.0:
        return Overlap(volume=0.0, centre=None)
    box = np.array(shared.bounding_box(), dtype=float)
    return Overlap(volume=volume, centre=0.5 * (box[:3] + box[3:]))
