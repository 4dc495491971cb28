"""What each face of a solid lies on, so that joints find their bores and seats without searching by name."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Any

import numpy as np

Point = tuple[float, float, float]


class SurfaceKind(StrEnum):
    """The simple surfaces of which made parts consist."""

    PLANE = "plane"
    CYLINDER = "cylinder"
    CONE = "cone"
    SPHERE = "sphere"
    TORUS = "torus"
    OTHER = "other"


@dataclass(frozen=True, slots=True, kw_only=True)
class Surface:
    """The surface that one face lies on.

    Attributes:
        kind: of the surface.
        point: on its axis, its centre, or of the plane [mm].
        axis: unit vector; a plane's outward normal; (0, 0, 1) for a sphere and where there is none.
        radius: of a cylinder or sphere, the larger of a torus [mm]; 0 else.
    """

    kind: SurfaceKind
    point: Point
    axis: Point
    radius: float


def is_revolved_about(surface: Surface, point: Point, axis: Point, tol: float = 1e-6) -> bool:
    """The surface is one of revolution about the line through a point [mm] along an axis.

    True for a coaxial cylinder, cone or torus, a sphere whose centre is on the line and a plane across it; `tol`
    bounds the distance of the surface's point from the line [mm] and the sine between the axes.
    """
    if surface.kind is SurfaceKind.OTHER:
        return False
    line = np.asarray(axis, dtype=float) / np.linalg.norm(axis)
    offset = np.asarray(surface.point) - np.asarray(point, dtype=float)
    is_on_line = bool(np.linalg.norm(np.cross(offset, line)) <= tol)
    is_parallel = bool(np.linalg.norm(np.cross(surface.axis, line)) <= tol)
    if surface.kind is SurfaceKind.SPHERE:
        return is_on_line
    return is_parallel and (is_on_line or surface.kind is SurfaceKind.PLANE)


def is_sphere_at(surface: Surface, point: Point, tol: float = 1e-6) -> bool:
    """The surface is a sphere whose centre lies within `tol` of a point [mm]."""
    return surface.kind is SurfaceKind.SPHERE and bool(
        np.linalg.norm(np.asarray(surface.point) - np.asarray(point, dtype=float)) <= tol
    )


def surfaces_of_shape(shape: Any) -> tuple[Surface, ...]:
    """The surface of each face of a shape of the kernel in the order of its face map: index i is face i of the mesh."""
    from OCP.TopAbs import TopAbs_FACE
    from OCP.TopExp import TopExp
    from OCP.TopoDS import TopoDS
    from OCP.TopTools import TopTools_IndexedMapOfShape

    found = TopTools_IndexedMapOfShape()
    TopExp.MapShapes_s(shape, TopAbs_FACE, found)
    return tuple(_surface(TopoDS.Face_s(found.FindKey(i))) for i in range(1, found.Extent() + 1))


def _surface(face: Any) -> Surface:
    from OCP.BRepAdaptor import BRepAdaptor_Surface
    from OCP.GeomAbs import GeomAbs_Cone, GeomAbs_Cylinder, GeomAbs_Plane, GeomAbs_Sphere, GeomAbs_Torus
    from OCP.TopAbs import TopAbs_REVERSED

    adaptor = BRepAdaptor_Surface(face)
    kind = adaptor.GetType()
    if kind == GeomAbs_Plane:
        plane = adaptor.Plane()
        # A left-handed frame has its normal against its main direction; a reversed face against its plane's.
        flip = (face.Orientation() == TopAbs_REVERSED) != (not plane.Position().Direct())
        return _made(SurfaceKind.PLANE, plane.Location(), plane.Axis().Direction(), 0.0, flip=flip)
    if kind == GeomAbs_Cylinder:
        cylinder = adaptor.Cylinder()
        return _made(SurfaceKind.CYLINDER, cylinder.Location(), cylinder.Axis().Direction(), cylinder.Radius())
    if kind == GeomAbs_Cone:
        cone = adaptor.Cone()
        return _made(SurfaceKind.CONE, cone.Location(), cone.Axis().Direction(), 0.0)
    if kind == GeomAbs_Torus:
        torus = adaptor.Torus()
        return _made(SurfaceKind.TORUS, torus.Location(), torus.Axis().Direction(), torus.MajorRadius())
    if kind == GeomAbs_Sphere:
        sphere = adaptor.Sphere()
        return _made(SurfaceKind.SPHERE, sphere.Location(), None, sphere.Radius())
    return Surface(kind=SurfaceKind.OTHER, point=(0.0, 0.0, 0.0), axis=(0.0, 0.0, 1.0), radius=0.0)


def _made(kind: SurfaceKind, point: Any, direction: Any, radius: float, *, flip: bool = False) -> Surface:
    axis = (0.0, 0.0, 1.0) if direction is None else (direction.X(), direction.Y(), direction.Z())
    sign = -1.0 if flip else 1.0
    # Adding zero turns -0.0 into 0.0, so that equal surfaces read equal.
    return Surface(
        kind=kind,
        point=(point.X() + 0.0, point.Y() + 0.0, point.Z() + 0.0),
        axis=(sign * axis[0] + 0.0, sign * axis[1] + 0.0, sign * axis[2] + 0.0),
        radius=radius,
    )
