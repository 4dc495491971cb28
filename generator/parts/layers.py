"""What a milled part must weigh: its layers as polygons, from within and from without.

A second way beside the kernel, for the kernel can lose a piece of a union and still call the result valid.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Milled

from .holes import hole_centres, hole_steps
from .outline import Arc, depth_inside, hull_of_circles, outline_area, outline_length, polygon_of_arcs

#: Chords to a turn: bounds of a full circle then lie 0.12 % apart.
_CHORDS = 128
#: The same for the wall around a hole: an arc of 100 mm then strays by 0.5 micrometres.
_FINE_CHORDS = 1024
#: Two heights or areas closer than this are one [mm], [mm2].
_SAME = 1e-7


@dataclass(frozen=True, slots=True, kw_only=True)
class Prism:
    """An outline between two heights [mm]; `name` is for messages."""

    name: str
    arcs: tuple[Arc, ...]
    low: float
    high: float

    def spans(self, low: float, high: float) -> bool:
        """It fills the whole layer between two heights."""
        return self.low <= low + _SAME and self.high >= high - _SAME


def prisms_of_slabs(slabs: tuple[Any, ...], name: str) -> tuple[Prism, ...]:
    """The outlines of slabs or windows, already checked."""
    return tuple(
        Prism(name=f"{name} {i}", arcs=hull_of_circles(s.circles), low=s.low, high=s.high) for i, s in enumerate(slabs)
    )


def drop_contained(prisms: tuple[Prism, ...]) -> tuple[Prism, ...]:
    """The prisms without those that lie within another one and so add nothing."""
    kept: list[Prism] = []
    for i, inner in enumerate(prisms):
        others = [*kept, *prisms[i + 1 :]]
        if not any(outer.spans(inner.low, inner.high) and _covers(outer.arcs, inner.arcs) for outer in others):
            kept.append(inner)
    return tuple(kept)


def _covers(outer: tuple[Arc, ...], inner: tuple[Arc, ...]) -> bool:
    return all(depth_inside(outer, arc.x, arc.y) >= arc.radius - _SAME for arc in inner)


def hole_prisms(feature: Milled, span: tuple[float, float], where: str) -> tuple[list[Prism], list[Prism]]:
    """Cylinders that the holes certainly clear, and cylinders that they certainly stay within; equal but at a cone."""
    least: list[Prism] = []
    most: list[Prism] = []
    for i, hole in enumerate(feature.holes):
        steps = hole_steps(hole, i, span, where)
        sign = 1.0 if hole.upwards else -1.0
        for x, y in hole_centres(hole):
            for (r_0, z_0), (r_1, z_1) in itertools.pairwise(steps):
                if z_1 > z_0:
                    low, high = sorted((hole.top + sign * z_0, hole.top + sign * z_1))
                    for found, radius in ((least, min(r_0, r_1)), (most, max(r_0, r_1))):
                        arc = Arc(x=x, y=y, radius=radius, start=0.0, end=math.tau)
                        found.append(
                            Prism(
                                name=f"hole {i} (diameter {2 * radius:g} mm at x = {x:.4g}, y = {y:.4g} mm)",
                                arcs=(arc,),
                                low=low,
                                high=high,
                            )
                        )
    return least, most


def bound_volume(slabs: tuple[Prism, ...], least_cut: list[Prism], most_cut: list[Prism]) -> tuple[float, float]:
    """Lower and upper bound of the volume [mm3] of a union of slabs without cutters, layer by layer.

    Args:
        slabs: of the union.
        least_cut: cutters, or what they certainly clear.
        most_cut: cutters, or what they certainly stay within.
    """
    heights = sorted({h for p in (*slabs, *least_cut, *most_cut) for h in (p.low, p.high)})
    lower = upper = 0.0
    for low, high in itertools.pairwise(heights):
        if high - low < _SAME:
            continue
        here = [p for p in slabs if p.spans(low, high)]
        if not here:
            continue
        inner = _section(here, outside=False) - _section([p for p in most_cut if p.spans(low, high)], outside=True)
        outer = _section(here, outside=True) - _section([p for p in least_cut if p.spans(low, high)], outside=False)
        lower += inner.area() * (high - low)
        upper += outer.area() * (high - low)
    # The polygon library rounds corners to 1e-8 mm.
    return lower * (1.0 - 1e-6), upper * (1.0 + 1e-6)


def _section(prisms: list[Prism], *, outside: bool, n: int = _CHORDS) -> Any:
    """Union of the prisms' outlines as a manifold3d cross section; n chords (or tangents) to a turn."""
    from manifold3d import CrossSection, FillRule

    polygons = [polygon_of_arcs(p.arcs, n, outside=outside) for p in prisms]
    return CrossSection(polygons, FillRule.Positive) if polygons else CrossSection()


def refuse_lost_walls(slabs: tuple[Prism, ...], holes: list[Prism], where: str) -> None:
    """A hole must lie wholly in the blank, or wholly outside it, in every layer that it passes.

    Raises:
        BuildError: a hole breaks through a wall, or leaves it no thickness; says by how much.
    """
    for hole in holes:
        inside = [h for p in slabs for h in (p.low, p.high) if hole.low < h < hole.high]
        for low, high in itertools.pairwise(sorted({hole.low, *inside, hole.high})):
            here = [p for p in slabs if p.spans(low, high)] if high - low > _SAME else []
            wall = _wall(hole.arcs[0], here)
            if wall is not None:
                raise BuildError(
                    where,
                    f"{hole.name} leaves a wall of {wall:.4g} mm at z = {low:.4g} to {high:.4g} mm; "
                    "narrow the hole or widen the slab",
                )


def _wall(disc: Arc, slabs: list[Prism]) -> float | None:
    """The wall [mm] that a round hole lacks in one layer; None if it lies wholly in the slabs or beside them.

    A hole within one slab is decided exactly, one that only several slabs together can hold by fine polygons.
    """
    depths = [depth_inside(p.arcs, disc.x, disc.y) for p in slabs]
    if not slabs or max(depths) > disc.radius or max(depths) <= -disc.radius:
        return None
    hole = Prism(name="", arcs=(disc,), low=0.0, high=0.0)
    outer = _section([hole], outside=True, n=_FINE_CHORDS)
    held = (outer ^ _section(slabs, outside=False, n=_FINE_CHORDS)).area() / outer.area()
    return None if held > 1.0 - 1e-7 or held < 1e-6 else max(depths) - disc.radius


def chamfer_volume(arcs: tuple[Arc, ...], c: float) -> float:
    """Volume [mm3] that a 45 degree chamfer of leg c [mm] takes off one end face of a prism.

    The outline moved inwards by t has the area A - P t + w t^2: an arc of sweep s adds s/2 to w, a sharp corner
    tan(s/2) (Steiner). Integrated over t from 0 to c.
    """
    weight = sum(arc.sweep / 2.0 if arc.radius > 0.0 else math.tan(arc.sweep / 2.0) for arc in arcs)
    return outline_length(arcs) * c**2 / 2.0 - weight * c**3 / 3.0


def largest(slabs: tuple[Prism, ...]) -> int:
    """Index of the slab whose outline encloses most."""
    return max(range(len(slabs)), key=lambda i: outline_area(slabs[i].arcs))
