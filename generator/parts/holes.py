"""Holes as tools: each the solid that a drill, a counterbore or a broach takes away, and not a hair more.

A tool starts exactly at its mouth plane. Tools that begin a little above it, as CAD libraries make them, notch
whatever stands beside the hole.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import CrossHole, Hole

from .profile import straight_profile, swept_volume

#: How far a through hole's tool runs out of the part at its far end [mm]; nothing is there.
_RUN_OUT = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Bore:
    """The narrow part of a drilled hole: from `origin` [mm] along a unit direction, radius and depth [mm]."""

    origin: tuple[float, float, float]
    direction: tuple[float, float, float]
    radius: float
    depth: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Tool:
    """What one hole takes away.

    Attributes:
        name: for messages ("hole 2").
        shape: solid of the kernel.
        volume: of the tool [mm3]; the part loses no more than that.
        bore: of a drilled hole; None for what is milled or broached.
    """

    name: str
    shape: Any
    volume: float
    bore: Bore | None = None


def hole_centres(hole: Hole) -> tuple[tuple[float, float], ...]:
    """Where a hole and its repetitions are drilled: n points (x, y) [mm]."""
    if hole.n == 1 and hole.pitch_radius == 0.0:
        return ((hole.x, hole.y),)
    angles = [hole.first + k * math.tau / hole.n for k in range(hole.n)]
    return tuple((hole.x + hole.pitch_radius * math.cos(a), hole.y + hole.pitch_radius * math.sin(a)) for a in angles)


def hole_steps(hole: Hole, i: int, span: tuple[float, float], where: str) -> tuple[tuple[float, float], ...]:
    """Radius and depth below the mouth [mm] at each corner of a hole's profile, from the mouth down.

    Args:
        hole: as described.
        i: its number in the feature, for messages.
        span: lowest and highest z of the part [mm].
        where: names the part.

    Raises:
        BuildError: a length that is not positive, a head that does not fit its hole, or a mouth beyond the part.
    """
    name = f"hole {i}"
    _check_numbers(hole, name, where)
    beyond = hole.top - span[0] if not hole.upwards else span[1] - hole.top
    _need(
        beyond > 0.0,
        where,
        f"{name} starts at z = {hole.top:g} mm and goes {'up' if hole.upwards else 'down'}: away from "
        f"the part, which lies from {span[0]:g} to {span[1]:g} mm",
    )
    depth, radius = (beyond + _RUN_OUT if hole.depth is None else hole.depth), hole.diameter / 2.0
    if hole.head_diameter == 0.0:
        return ((radius, 0.0), (radius, depth))
    head = hole.head_diameter / 2.0
    head_depth, deepest = (head - radius if hole.countersink else hole.head_depth), min(depth, beyond)
    _need(
        0.0 < head_depth < deepest,
        where,
        f"{name} has a head {head_depth:g} mm deep; that must lie between 0 and {deepest:g} mm, where the hole or "
        "the part ends",
    )
    if hole.countersink:
        return ((head, 0.0), (radius, head_depth), (radius, depth))
    return ((head, 0.0), (head, head_depth), (radius, head_depth), (radius, depth))


def _check_numbers(hole: Hole, name: str, where: str) -> None:
    """What must hold for a hole's numbers whatever the part."""
    place = (hole.x, hole.y, hole.top, hole.first)
    _need(all(map(math.isfinite, place)), where, f"{name} lies at {place}: not numbers")
    _need(hole.diameter > 0.0, where, f"{name} has diameter {hole.diameter:g} mm; it must be positive")
    _need(hole.depth is None or hole.depth > 0.0, where, f"{name} has depth {hole.depth} mm; it must be positive")
    _need(hole.n >= 1, where, f"{name} is repeated {hole.n} times; at least once")
    _need(
        hole.n == 1 or hole.pitch_radius > 0.0,
        where,
        f"{name} is repeated {hole.n} times on a circle of radius {hole.pitch_radius:g} mm; it must be positive",
    )
    _need(
        hole.head_diameter == 0.0 or hole.head_diameter > hole.diameter,
        where,
        f"{name} has a head of diameter {hole.head_diameter:g} mm; it must be wider than the hole "
        f"({hole.diameter:g} mm)",
    )


def tools_of_holes(holes: tuple[Hole, ...], span: tuple[float, float], where: str) -> list[Tool]:
    """One tool for each hole and repetition; `span` is the part's lowest and highest z [mm]."""
    tools = []
    for i, hole in enumerate(holes):
        steps = hole_steps(hole, i, span, where)
        direction = (0.0, 0.0, 1.0 if hole.upwards else -1.0)
        for k, (x, y) in enumerate(hole_centres(hole)):
            name = f"hole {i} (diameter {hole.diameter:g} mm at x = {x:.4g}, y = {y:.4g} mm)" + (f", {k}" if k else "")
            tools.append(_drill(name, steps, (x, y, hole.top), direction))
    return tools


def tools_of_cross_holes(holes: tuple[CrossHole, ...], where: str) -> list[Tool]:
    """One tool for each hole in any direction."""
    tools = []
    for i, hole in enumerate(holes):
        name = f"cross hole {i}"
        _need(
            hole.diameter > 0.0 and hole.depth > 0.0,
            where,
            f"{name} has diameter {hole.diameter:g} mm and depth {hole.depth:g} mm; both must be positive",
        )
        length = math.hypot(*hole.direction)
        _need(length > 1e-9, where, f"{name} has no direction")
        a, b, c = hole.direction
        direction = (a / length, b / length, c / length)
        steps = ((hole.diameter / 2.0, 0.0), (hole.diameter / 2.0, hole.depth))
        tools.append(_drill(f"{name} (diameter {hole.diameter:g} mm)", steps, hole.origin, direction))
    return tools


def hex_tool(socket: tuple[float, float, float], where: str) -> Tool:
    """A hexagonal prism about z from (across flats, z of its mouth, depth downwards) [mm]."""
    from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace, BRepBuilderAPI_MakePolygon
    from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
    from OCP.gp import gp_Pnt, gp_Vec

    flats, mouth, depth = socket
    _need(
        flats > 0.0 and depth > 0.0,
        where,
        f"the hexagon socket is {flats:g} mm across flats and {depth:g} mm deep; both must be positive",
    )
    corner = flats / math.sqrt(3.0)
    polygon = BRepBuilderAPI_MakePolygon()
    for k in range(6):
        polygon.Add(gp_Pnt(corner * math.cos(k * math.pi / 3.0), corner * math.sin(k * math.pi / 3.0), mouth))
    polygon.Close()
    prism = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(polygon.Wire()).Face(), gp_Vec(0.0, 0.0, -depth))
    return Tool(name="hexagon socket", shape=prism.Shape(), volume=math.sqrt(3.0) / 2.0 * flats**2 * depth)


def _drill(
    name: str,
    steps: tuple[tuple[float, float], ...],
    origin: tuple[float, float, float],
    direction: tuple[float, float, float],
) -> Tool:
    from .revolve import revolve

    edges = straight_profile(((0.0, 0.0), *steps, (0.0, steps[-1][1])))
    bore = Bore(origin=origin, direction=direction, radius=steps[-1][0], depth=steps[-1][1])
    return Tool(name=name, shape=revolve(edges, origin, direction), volume=swept_volume(edges), bore=bore)


def _need(holds: bool, where: str, what: str) -> None:
    if not holds:
        raise BuildError(where, what)
