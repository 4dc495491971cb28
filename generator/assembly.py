"""All bodies of a design as solids: equal features are built once, bodies of one kind share all they have."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linkwright.designs.design import Design
from linkwright.designs.language.bodies import Body, Part
from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Feature

from .mass import MassProperties, check_physical, compose_masses, compute_part_mass, move_mass
from .solids import Solid, build_solid
from .store import Store

Array = np.ndarray
Progress = Callable[[int, int, str], None]


@dataclass(frozen=True, slots=True, kw_only=True)
class AssembledPart:
    """A part with its solid.

    Attributes:
        part: as described.
        solid: in the part's frame.
        T_body_part: its place in the body, shape (4, 4) [mm].
    """

    part: Part
    solid: Solid
    T_body_part: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class AssembledBody:
    """A body with its solids.

    Attributes:
        body: as described.
        parts: in the body's order.
        mass: [kg].
        centre: in the body's frame, shape (3,) [mm].
        inertia: about the centre, along the body's axes, shape (3, 3) [kg mm2].
    """

    body: Body
    parts: tuple[AssembledPart, ...]
    mass: float
    centre: Array
    inertia: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Assembly:
    """A design with its solids; `bodies` in the order of `mechanism.bodies`, which is that of `place_bodies`."""

    design: Design
    bodies: tuple[AssembledBody, ...]

    def body(self, name: str) -> AssembledBody:
        """The body of this name."""
        return next(b for b in self.bodies if b.body.name == name)


def build_assembly(
    design: Design, *, store: Store | None = None, progress: Progress | None = None, deviation: float | None = None
) -> Assembly:
    """The solids, masses and places of all parts of a design.

    Args:
        design: resolved.
        store: of solids; None builds all anew.
        progress: is told (done, of how many, what comes next) before each distinct solid and once at the end.
        deviation: of the meshes [mm]; None takes the design's `clearance.mesh_deviation`.

    Raises:
        BuildError: names design, body and part; or the mechanism has no parts at all.
    """
    if design.mechanism.bodies and not design.mechanism.has_solids:
        raise BuildError(
            design.name,
            f"{design.mechanism.name} has kinematics but no parts yet, so there is nothing to build or to check; "
            "show, ik and fk work on it",
        )
    if deviation is None:
        deviation = design.clearance.mesh_deviation
    kinds = _kinds(design)
    solids = _build_solids(design, kinds, deviation, store, progress)
    done = {kind: _assemble(design, body, solids) for kind, body in kinds.items()}
    bodies = []
    for body in design.mechanism.bodies:
        parts, mass = done[body.kind]
        bodies.append(AssembledBody(body=body, parts=parts, mass=mass.mass, centre=mass.centre, inertia=mass.inertia))
    return Assembly(design=design, bodies=tuple(bodies))


def _kinds(design: Design) -> dict[str, Body]:
    """The first body of each kind, after checking that the others of the kind equal it."""
    kinds: dict[str, Body] = {}
    names: set[str] = set()
    for body in design.mechanism.bodies:
        where = f"{design.name}: {body.name}"
        if body.name in names:
            raise BuildError(where, "two bodies have this name")
        names.add(body.name)
        if not body.parts:
            raise BuildError(where, "the body has no parts; it needs at least one")
        doubled = {p.name for p in body.parts if sum(q.name == p.name for q in body.parts) > 1}
        if doubled:
            raise BuildError(where, f"several of its parts are called {sorted(doubled)[0]}")
        first = kinds.setdefault(body.kind, body)
        if first is not body and first.parts != body.parts:
            raise BuildError(
                where, f"its parts differ from those of {first.name}, though both are of the kind {body.kind}"
            )
    if not kinds:
        raise BuildError(design.name, "the mechanism has no bodies")
    return kinds


def _build_solids(
    design: Design, kinds: dict[str, Body], deviation: float, store: Store | None, progress: Progress | None
) -> dict[Feature, Solid]:
    wanted: dict[Feature, str] = {}
    for kind, body in kinds.items():
        for part in body.parts:
            wanted.setdefault(part.feature, f"{kind}: {part.name}")
    solids: dict[Feature, Solid] = {}
    for feature, name in wanted.items():
        if progress is not None:
            progress(len(solids), len(wanted), name)
        solids[feature] = build_solid(feature, deviation, where=f"{design.name}: {name}", store=store)
    if progress is not None:
        progress(len(solids), len(wanted), "")
    return solids


def _assemble(
    design: Design, body: Body, solids: dict[Feature, Solid]
) -> tuple[tuple[AssembledPart, ...], MassProperties]:
    parts, masses = [], []
    for part in body.parts:
        where = f"{design.name}: {body.kind}: {part.name}"
        placed = AssembledPart(part=part, solid=solids[part.feature], T_body_part=_place(part, where))
        mass = compute_part_mass(part, placed.solid, where)
        if part.mass != 0.0:
            check_physical(mass, where)
        parts.append(placed)
        masses.append(move_mass(mass, placed.T_body_part))
    whole = compose_masses(masses, f"{design.name}: {body.kind}")
    check_physical(whole, f"{design.name}: {body.kind}")
    return tuple(parts), whole


def _place(part: Part, where: str) -> Array:
    """T_body_part, once its two directions are known to span a frame."""
    if not np.linalg.norm(np.cross(part.at.z, part.at.x)) > 1e-9:
        raise BuildError(
            where, f"its place has z along {part.at.z} and x along {part.at.x}; they must not be parallel or zero"
        )
    T = part.at.matrix()
    T.setflags(write=False)
    return T
