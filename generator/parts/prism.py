"""Slabs as solids of the kernel: an outline raised along z, its edges broken where asked."""

from __future__ import annotations

import math
from typing import Any

from OCP.BRep import BRep_Tool
from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeVertex,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepFilletAPI import BRepFilletAPI_MakeChamfer
from OCP.BRepPrimAPI import BRepPrimAPI_MakePrism
from OCP.Geom import Geom_Circle
from OCP.gp import gp_Ax2, gp_Dir, gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_EDGE, TopAbs_VERTEX
from OCP.TopoDS import TopoDS

from linkwright.designs.language.errors import BuildError

from .booleans import sole_solid, sub_shapes
from .layers import chamfer_volume
from .outline import Arc, outline_area

#: Corners of an outline that are closer than this are one vertex [mm].
_SAME_POINT = 1e-7


def build_prism(arcs: tuple[Arc, ...], low: float, high: float) -> Any:
    """The solid over an outline from z = low to z = high [mm]."""
    wire = BRepBuilderAPI_MakeWire()
    for edge in _edges(arcs, low):
        wire.Add(edge)
    return BRepPrimAPI_MakePrism(
        BRepBuilderAPI_MakeFace(wire.Wire(), True).Face(), gp_Vec(0.0, 0.0, high - low)
    ).Shape()


def _edges(arcs: tuple[Arc, ...], z: float) -> list[Any]:
    ends: list[tuple[tuple[float, float], Any]] = []

    def vertex(point: tuple[float, float]) -> Any:
        for known, made in ends:
            if math.dist(known, point) < _SAME_POINT:
                return made
        ends.append((point, BRepBuilderAPI_MakeVertex(gp_Pnt(*point, z)).Vertex()))
        return ends[-1][1]

    edges = []
    for arc, follower in zip(arcs, arcs[1:] + arcs[:1], strict=True):
        first, last, after = arc.point(arc.start), arc.point(arc.end), follower.point(follower.start)
        if arc.radius > 0.0 and arc.sweep * arc.radius > _SAME_POINT:
            circle = Geom_Circle(
                gp_Ax2(gp_Pnt(arc.x, arc.y, z), gp_Dir(0.0, 0.0, 1.0), gp_Dir(1.0, 0.0, 0.0)), arc.radius
            )
            if arc.sweep >= math.tau - 1e-12:
                edges.append(BRepBuilderAPI_MakeEdge(circle).Edge())
                continue
            edges.append(BRepBuilderAPI_MakeEdge(circle, vertex(first), vertex(last), arc.start, arc.end).Edge())
        if math.dist(last, after) > _SAME_POINT:
            edges.append(BRepBuilderAPI_MakeEdge(vertex(last), vertex(after)).Edge())
    return edges


def break_edges(prism: Any, arcs: tuple[Arc, ...], low: float, high: float, size: float, where: str) -> Any:
    """The prism with 45 degree chamfers of leg `size` [mm] around its top and bottom faces.

    Raises:
        BuildError: the chamfer does not fit, or the kernel's differs from the outline moved inwards.
    """
    tightest = min((arc.radius for arc in arcs if arc.radius > 0.0), default=math.inf)
    if size < 0.0 or size >= tightest or 2.0 * size > high - low - _SAME_POINT:
        raise BuildError(
            where,
            f"an edge break of {size:g} mm does not fit the largest slab: it must lie between 0, its smallest "
            f"corner radius ({tightest:g} mm) and half its thickness ({(high - low) / 2.0:g} mm)",
        )
    maker = BRepFilletAPI_MakeChamfer(prism)
    for edge in sub_shapes(prism, TopAbs_EDGE):
        heights = [BRep_Tool.Pnt_s(TopoDS.Vertex_s(v)).Z() for v in sub_shapes(edge, TopAbs_VERTEX)]
        if max(heights) - min(heights) < _SAME_POINT:
            maker.Add(size, TopoDS.Edge_s(edge))
    maker.Build()
    if not maker.IsDone():
        raise BuildError(
            where,
            f"the kernel could not break the edges of the largest slab by {size:g} mm; choose a smaller edge break",
        )
    volume = outline_area(arcs) * (high - low) - 2.0 * chamfer_volume(arcs, size)
    return sole_solid(maker.Shape(), (volume * (1 - 1e-6), volume * (1 + 1e-6)), f"edge breaks of {size:g} mm", where)
