"""Milled parts: slabs united, their edges broken, then windows and holes cut."""

from __future__ import annotations

import math
from typing import Any

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Milled, Slab

from .blank import Blank
from .booleans import fuse
from .holes import Tool, tools_of_cross_holes, tools_of_holes
from .layers import (
    Prism,
    bound_volume,
    chamfer_volume,
    drop_contained,
    hole_prisms,
    largest,
    prisms_of_slabs,
    refuse_lost_walls,
)
from .outline import outline_area, split_arcs
from .prism import break_edges, build_prism


def build_milled(feature: Milled, where: str) -> Blank:
    """The uncut solid and what is to be cut from it.

    Raises:
        BuildError: a slab, window or hole makes no sense, or the edge break does not fit.
    """
    if not feature.slabs:
        raise BuildError(where, "a milled part needs at least one slab")
    for name, group in (("slab", feature.slabs), ("window", feature.windows)):
        for i, slab in enumerate(group):
            _check_slab(slab, f"{name} {i}", where)
    slabs = drop_contained(prisms_of_slabs(feature.slabs, "slab"))
    windows = prisms_of_slabs(feature.windows, "window")
    span = (min(s.low for s in slabs), max(s.high for s in slabs))
    tools = _window_tools(windows, slabs) + tools_of_holes(feature.holes, span, where)
    tools += tools_of_cross_holes(feature.cross_holes, where)
    least, most = hole_prisms(feature, span, where)
    refuse_lost_walls(slabs, most, where)
    main = largest(slabs)
    broken = 2.0 * chamfer_volume(slabs[main].arcs, feature.edge_break) if feature.edge_break else 0.0
    lower, upper = bound_volume(slabs, [], [])
    cut_lower, cut_upper = bound_volume(slabs, [*windows, *least], [*windows, *most])
    crossed = sum(math.pi / 4.0 * h.diameter**2 * h.depth for h in feature.cross_holes)
    return Blank(
        shape=_unite(slabs, main, feature.edge_break, where),
        volume=(lower - broken, upper),
        tools=tuple(tools),
        cut_volume=(cut_lower - broken - crossed, cut_upper),
    )


def _check_slab(slab: Slab, name: str, where: str) -> None:
    if not slab.circles:
        raise BuildError(where, f"{name} has no circles")
    if not slab.high > slab.low:
        raise BuildError(
            where,
            f"{name} goes from z = {slab.low:g} to {slab.high:g} mm: its thickness of "
            f"{slab.high - slab.low:g} mm must be positive",
        )
    for x, y, r in slab.circles:
        if not (math.isfinite(x) and math.isfinite(y) and math.isfinite(r)) or r < 0.0:
            raise BuildError(
                where, f"{name} has a circle of radius {r:g} mm at ({x:g}, {y:g}); a radius must not be negative"
            )
    if outline_area(prisms_of_slabs((slab,), name)[0].arcs) < 1e-6:
        raise BuildError(where, f"{name} encloses no area: its circles are points on one line")


def _split(prism: Prism, others: tuple[Prism, ...]) -> Any:
    return split_arcs(prism.arcs, tuple(arc for other in others for arc in other.arcs))


def _window_tools(windows: tuple[Prism, ...], slabs: tuple[Prism, ...]) -> list[Tool]:
    return [
        Tool(
            name=w.name,
            shape=build_prism(_split(w, (*slabs, *windows)), w.low, w.high),
            volume=outline_area(w.arcs) * (w.high - w.low),
        )
        for w in windows
    ]


def _unite(slabs: tuple[Prism, ...], main: int, edge_break: float, where: str) -> Any:
    """The union of the slabs, the largest with broken edges except where another slab stands on it."""
    shapes = [build_prism(_split(s, slabs), s.low, s.high) for s in slabs]
    if edge_break == 0.0:
        return fuse(shapes, where)
    base = slabs[main]
    shapes[main] = break_edges(
        build_prism(base.arcs, base.low, base.high), base.arcs, base.low, base.high, edge_break, where
    )
    return fuse([*shapes, *_feet(slabs, main, edge_break, where)], where)


def _feet(slabs: tuple[Prism, ...], main: int, edge_break: float, where: str) -> list[Any]:
    """What fills the broken edge under a slab that stands on the largest one: else a groove runs beneath it."""
    base, feet = slabs[main], []
    for i, slab in enumerate(slabs):
        if i == main:
            continue
        for low, high in ((base.high - edge_break, base.high), (base.low, base.low + edge_break)):
            stands = abs(slab.low - base.high) < 1e-7 if high == base.high else abs(slab.high - base.low) < 1e-7
            if stands:
                feet.append(_common(slab, base, low, high, where))
    return feet


def _common(slab: Prism, base: Prism, low: float, high: float, where: str) -> Any:
    from OCP.BRepAlgoAPI import BRepAlgoAPI_Common

    both = (slab, base)
    operation = BRepAlgoAPI_Common(*(build_prism(_split(p, both), low, high) for p in both))
    if not operation.IsDone():
        raise BuildError(where, f"the kernel could not seat {slab.name} on {base.name}")
    return operation.Shape()
