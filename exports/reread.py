"""What a written STEP file says, read back by the other library: instances by body, their solids and their faces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from linkwright.designs.language.errors import ReleaseError

if TYPE_CHECKING:
    import cadquery as cq

Colour = tuple[float, float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class RereadInstance:
    """One part at its place.

    Attributes:
        path: names from the group (or the body) down to the part.
        T_base_part: its pose in the base, shape (4, 4) [mm].
        volume: [mm3]; centre: of mass, in the base, shape (3,) [mm].
        n_solids: how many solids its shape holds.
        colour: sRGB, or None.
    """

    path: tuple[str, ...]
    T_base_part: np.ndarray
    volume: float
    centre: np.ndarray
    n_solids: int
    colour: Colour | None

    @property
    def body(self) -> str:
        """Name of the body that it belongs to."""
        return self.path[-2]


@dataclass(frozen=True, slots=True, kw_only=True)
class Cylinder:
    """A cylindrical face: a point of its axis, the axis' direction, both in the base, and the radius [mm]."""

    point: np.ndarray
    direction: np.ndarray
    radius: float
    part: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Sphere:
    """A spherical face: its centre in the base and its radius [mm]."""

    centre: np.ndarray
    radius: float
    part: str


@dataclass(frozen=True, slots=True, kw_only=True)
class RecoveredBody:
    """The round faces of one body, in the base frame."""

    cylinders: tuple[Cylinder, ...] = ()
    spheres: tuple[Sphere, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class RereadAssembly:
    """An assembly as the file says it."""

    name: str
    instances: tuple[RereadInstance, ...]
    bodies: Mapping[str, RecoveredBody] = field(default_factory=dict)


def recover_axes(step_path: Path) -> Mapping[str, RecoveredBody]:
    """Axes of all cylindrical and centres of all spherical faces of a written assembly: body name -> faces.

    Raises:
        ReleaseError: the file cannot be read back.
    """
    return reread_assembly(step_path).bodies


def reread_assembly(step_path: Path) -> RereadAssembly:
    """All that a written assembly says.

    Raises:
        ReleaseError: the file cannot be read back.
    """
    import cadquery as cq

    try:
        root = cq.Assembly.importStep(str(step_path))
    except ValueError as error:
        raise ReleaseError(f"{step_path.name}: cadquery cannot read it back: {error}") from error
    shapes = _ShapeFacts()
    instances: list[RereadInstance] = []
    round_faces: dict[str, tuple[list[Cylinder], list[Sphere]]] = {}
    for path, shape, T, colour in _walk(root, (), np.eye(4)):
        facts = shapes.of(shape)
        centre = T[:3, :3] @ facts.centre + T[:3, 3]
        instance = RereadInstance(
            path=path, T_base_part=T, volume=facts.volume, centre=centre, n_solids=facts.n_solids, colour=colour
        )
        instances.append(instance)
        cylinders, spheres = round_faces.setdefault(instance.body, ([], []))
        cylinders += [_moved_cylinder(c, T, path[-1]) for c in facts.cylinders]
        spheres += [_moved_sphere(s, T, path[-1]) for s in facts.spheres]
    bodies = {name: RecoveredBody(cylinders=tuple(c), spheres=tuple(s)) for name, (c, s) in round_faces.items()}
    return RereadAssembly(name=root.name, instances=tuple(instances), bodies=bodies)


def reread_volume(step_path: Path) -> tuple[float, int]:
    """Volume [mm3] and number of solids of a written part.

    Raises:
        ReleaseError: the file cannot be read back.
    """
    import cadquery as cq

    try:
        solids: list[Any] = cq.importers.importStep(str(step_path)).solids().vals()
    except ValueError as error:
        raise ReleaseError(f"{step_path.name}: cadquery cannot read it back: {error}") from error
    return float(sum(solid.Volume() for solid in solids)), len(solids)


def _walk(
    node: cq.Assembly, path: tuple[str, ...], T_base_parent: np.ndarray
) -> Iterator[tuple[tuple[str, ...], Any, np.ndarray, Colour | None]]:
    T = T_base_parent @ matrix(node.loc)
    if node.obj is not None:
        colour = node.color.toTuple()[:3] if node.color else None
        yield (*path, node.name) if path else ("", node.name), node.obj, T, colour
    for child in node.children:
        below = path if node.parent is None else (*path, node.name)
        yield from _walk(child, below, T)


def matrix(location: cq.Location) -> np.ndarray:
    """A cadquery location as a pose, shape (4, 4) [mm]."""
    trsf = location.wrapped.Transformation()
    T = np.eye(4)
    T[:3] = [[trsf.Value(row, column) for column in range(1, 5)] for row in range(1, 4)]
    return T


@dataclass(frozen=True, slots=True)
class _Facts:
    volume: float
    centre: np.ndarray
    n_solids: int
    cylinders: tuple[Cylinder, ...]
    spheres: tuple[Sphere, ...]


class _ShapeFacts:
    """Facts of each distinct shape, measured once: the instances of a product share its shape."""

    def __init__(self) -> None:
        self._known: dict[int, list[tuple[Any, _Facts]]] = {}

    def of(self, shape: Any) -> _Facts:
        row = self._known.setdefault(shape.hashCode(), [])
        for known, facts in row:
            if known.isSame(shape):
                return facts
        facts = _measured(shape)
        row.append((shape, facts))
        return facts


def _measured(shape: Any) -> _Facts:
    import cadquery as cq

    cylinders: list[Cylinder] = []
    spheres: list[Sphere] = []
    for face in shape.Faces():
        kind = face.geomType()
        if kind == "CYLINDER":
            surface = face._geomAdaptor().Cylinder()
            axis = surface.Axis()
            cylinders.append(
                Cylinder(
                    point=_array(axis.Location()), direction=_array(axis.Direction()), radius=surface.Radius(), part=""
                )
            )
        elif kind == "SPHERE":
            surface = face._geomAdaptor().Sphere()
            spheres.append(Sphere(centre=_array(surface.Location()), radius=surface.Radius(), part=""))
    return _Facts(
        float(shape.Volume()),
        np.array(cq.Shape.centerOfMass(shape).toTuple()),
        len(shape.Solids()),
        tuple(cylinders),
        tuple(spheres),
    )


def _array(point_or_direction: Any) -> np.ndarray:
    return np.array([point_or_direction.X(), point_or_direction.Y(), point_or_direction.Z()])


def _moved_cylinder(c: Cylinder, T: np.ndarray, part: str) -> Cylinder:
    return Cylinder(point=T[:3, :3] @ c.point + T[:3, 3], direction=T[:3, :3] @ c.direction, radius=c.radius, part=part)


def _moved_sphere(s: Sphere, T: np.ndarray, part: str) -> Sphere:
    return Sphere(centre=T[:3, :3] @ s.centre + T[:3, 3], radius=s.radius, part=part)
