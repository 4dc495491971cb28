"""One solid with all that is asked of it: exact boundary, mesh, surfaces, volume, inertia and box."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from io import BytesIO
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Feature, Turned

from .mesh import Mesh, build_mesh, compute_mesh_volume
from .surfaces import Surface, surfaces_of_shape

if TYPE_CHECKING:
    from .store import Store

Array = np.ndarray


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A part's shape in its own frame.

    Attributes:
        key: content hash of the numbers that it was made from.
        brep: exact boundary as bytes of the kernel.
        mesh: its triangles.
        surfaces: surface of each face, indexed as `mesh.faces`.
        volume, area: [mm3], [mm2].
        centre: of the volume, shape (3,) [mm].
        inertia: about the centre at unit density, shape (3, 3) [mm5].
        lower, upper: corners of the box around it, shape (3,) [mm].
    """

    key: str
    brep: bytes
    mesh: Mesh
    surfaces: tuple[Surface, ...]
    volume: float
    area: float
    centre: Array
    inertia: Array
    lower: Array
    upper: Array

    @property
    def shape(self) -> Any:
        """The exact boundary as a TopoDS_Shape; loads the kernel, and is read once for all equal solids."""
        return shape_from_brep(self.brep)


@lru_cache(maxsize=1024)
def shape_from_brep(brep: bytes) -> Any:
    """The shape that `brep_from_shape` wrote."""
    from OCP.BinTools import BinTools
    from OCP.TopoDS import TopoDS_Shape

    shape = TopoDS_Shape()
    BinTools.Read_s(shape, BytesIO(brep))
    return shape


def brep_from_shape(shape: Any) -> bytes:
    """A shape's exact boundary as bytes, without triangles; equal numbers give equal bytes."""
    from OCP.BinTools import BinTools

    stream = BytesIO()
    BinTools.Write_s(shape, stream)
    return stream.getvalue()


def build_solid(feature: Feature, deviation: float, *, where: str, store: Store | None = None) -> Solid:
    """The solid of a feature, from the store if it is there.

    Args:
        feature: numbers.
        deviation: largest distance between solid and mesh [mm].
        where: names design, body and part in errors ("hit: lower_left: bar").
        store: of solids; None builds anew.

    Raises:
        BuildError: the numbers make no sense, or the result is not one valid, closed solid of the volume they imply.
    """
    from .store import content_key

    key = content_key(feature, deviation)
    if store is not None and (found := store.load(key)) is not None:
        return found
    try:
        solid = _measure(key, _build_shape(feature, where), deviation, where)
    except Exception as error:
        # The kernel's exceptions have no base class of their own; all others pass.
        if type(error).__module__.split(".")[0] != "OCP":
            raise
        raise BuildError(where, f"the CAD kernel gave up: {type(error).__name__} {error}") from error
    if store is not None:
        store.save(solid)
    return solid


def _build_shape(feature: Feature, where: str) -> Any:
    from .parts.booleans import cut, sole_solid, unify
    from .parts.enclosure import refuse_open_bores
    from .parts.milled import build_milled
    from .parts.turned import build_turned

    if isinstance(feature, Turned):
        blank, made_of = build_turned(feature, where), "its profile"
    else:
        blank, made_of = build_milled(feature, where), "its slabs"
    whole = sole_solid(unify(blank.shape), blank.volume, made_of, where)
    if not blank.tools:
        return whole
    finished = cut(whole, blank.tools, where)
    refuse_open_bores(whole, blank.tools, where)
    return sole_solid(unify(finished), blank.cut_volume, "its holes and windows", where)


def _measure(key: str, built: Any, deviation: float, where: str) -> Solid:
    from OCP.Bnd import Bnd_Box
    from OCP.BRepBndLib import BRepBndLib
    from OCP.BRepGProp import BRepGProp
    from OCP.GProp import GProp_GProps

    # All numbers are taken from the bytes as they will be read again.
    brep = brep_from_shape(built)
    shape = shape_from_brep(brep)
    mass, skin, box = GProp_GProps(), GProp_GProps(), Bnd_Box()
    BRepGProp.VolumeProperties_s(shape, mass)
    BRepGProp.SurfaceProperties_s(shape, skin)
    BRepBndLib.AddOptimal_s(shape, box, False, False)
    matrix, centre = mass.MatrixOfInertia(), mass.CentreOfMass()
    mesh = build_mesh(shape, deviation, where=where)
    volume, area = mass.Mass(), skin.Mass()
    missing = abs(compute_mesh_volume(mesh) - volume)
    if missing > 2.0 * deviation * area:
        raise BuildError(
            where,
            f"its mesh encloses {missing:.4g} mm3 more or less than the solid of {volume:.6g} mm3; a deviation "
            f"of {deviation:g} mm allows {2.0 * deviation * area:.4g} mm3",
        )
    corners = box.Get()
    return Solid(
        key=key,
        brep=brep,
        mesh=mesh,
        surfaces=surfaces_of_shape(shape),
        volume=volume,
        area=area,
        centre=_locked([centre.X(), centre.Y(), centre.Z()]),
        inertia=_locked([[matrix.Value(i, j) for j in (1, 2, 3)] for i in (1, 2, 3)]),
        lower=_locked(corners[:3]),
        upper=_locked(corners[3:]),
    )


def _locked(numbers: Any) -> Array:
    a = np.array(numbers, dtype=float)
    a.setflags(write=False)
    return a
