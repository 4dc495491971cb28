"""Mass, centre and inertia of parts, and of the bodies that they make up."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.bodies import Part
from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.materials import material

from .solids import Solid

Array = np.ndarray

#: A smallest moment of this share of the largest is the rounding of a zero.
_NO_MOMENT = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class MassProperties:
    """Of a rigid thing in some frame.

    Attributes:
        mass: [kg].
        centre: shape (3,) [mm].
        inertia: about the centre, along the frame's axes, shape (3, 3) [kg mm2].
    """

    mass: float
    centre: Array
    inertia: Array


def compute_part_mass(part: Part, solid: Solid, where: str) -> MassProperties:
    """Of one part in its own frame: volume times density, or the catalogue's mass spread evenly over the volume.

    A catalogue mass of 0 says that another part carries it (a motor's shaft).

    Raises:
        UnknownNameError: the materials table has no such material.
        BuildError: the catalogue mass is negative.
    """
    if part.mass is not None and not part.mass >= 0.0:
        raise BuildError(where, f"has a catalogue mass of {part.mass:g} kg; it must not be negative")
    density = material(part.material).density if part.mass is None else part.mass / solid.volume
    return MassProperties(mass=density * solid.volume, centre=solid.centre, inertia=density * solid.inertia)


def move_mass(properties: MassProperties, T_ab: Array) -> MassProperties:
    """What is known in frame b, in frame a; T_ab of shape (4, 4) [mm]."""
    R = T_ab[:3, :3]
    return MassProperties(
        mass=properties.mass,
        centre=_locked(R @ properties.centre + T_ab[:3, 3]),
        inertia=_locked(R @ properties.inertia @ R.T),
    )


def compose_masses(several: Iterable[MassProperties], where: str) -> MassProperties:
    """Of all together; each about its own centre in one common frame (parallel axes).

    Raises:
        BuildError: nothing has mass, so that there is no centre.
    """
    several = list(several)
    mass = sum(p.mass for p in several)
    if not mass > 0.0:
        raise BuildError(where, f"has a mass of {mass:g} kg; it must be positive")
    centre = sum((p.mass * p.centre for p in several), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for p in several:
        d = p.centre - centre
        inertia += p.inertia + p.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return MassProperties(mass=mass, centre=_locked(centre), inertia=_locked((inertia + inertia.T) / 2.0))


def check_physical(properties: MassProperties, where: str) -> None:
    """A real thing has positive mass, positive principal moments, and none above the sum of the other two.

    Raises:
        BuildError: says which of these fails and by how much.
    """
    if not properties.mass > 0.0:
        raise BuildError(where, f"has a mass of {properties.mass:g} kg; it must be positive")
    moments = np.linalg.eigvalsh(properties.inertia)
    if not moments[0] > _NO_MOMENT * moments[2]:
        raise BuildError(where, f"has a principal moment of inertia of {moments[0]:g} kg mm2; it must be positive")
    if moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-9):
        raise BuildError(
            where,
            f"has principal moments of inertia {moments[0]:g}, {moments[1]:g}, {moments[2]:g} kg mm2; none may "
            "exceed the sum of the other two",
        )


def _locked(a: Array) -> Array:
    a = np.array(a, dtype=float)
    a.setflags(write=False)
    return a
