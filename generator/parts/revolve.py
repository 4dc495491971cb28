"""Profiles to solids of revolution, with true planes, cylinders, cones, spheres and tori as faces."""

from __future__ import annotations

from typing import Any

from OCP.BRepBuilderAPI import (
    BRepBuilderAPI_MakeEdge,
    BRepBuilderAPI_MakeFace,
    BRepBuilderAPI_MakeVertex,
    BRepBuilderAPI_MakeWire,
)
from OCP.BRepPrimAPI import BRepPrimAPI_MakeRevol
from OCP.Geom import Geom_Circle
from OCP.gp import gp_Ax1, gp_Ax2, gp_Ax3, gp_Dir, gp_Pln, gp_Pnt, gp_Vec

from .profile import Corner, ProfileEdge

Point = tuple[float, float, float]


def revolve(edges: tuple[ProfileEdge, ...], origin: Point = (0.0, 0.0, 0.0), axis: Point = (0.0, 0.0, 1.0)) -> Any:
    """The solid that a counter-clockwise profile sweeps about a line, z of the profile along the line."""
    place = gp_Ax3(gp_Pnt(*origin), gp_Dir(*axis))
    wire = BRepBuilderAPI_MakeWire()
    corners: dict[Corner, Any] = {}
    for edge in edges:
        wire.Add(_edge(edge, place, corners))
    # The profile's plane holds the radial direction and the axis; seen from minus y, r points right and z up.
    plane = gp_Pln(gp_Ax3(place.Location(), place.YDirection().Reversed(), place.XDirection()))
    face = BRepBuilderAPI_MakeFace(plane, wire.Wire(), True)
    return BRepPrimAPI_MakeRevol(face.Face(), gp_Ax1(place.Location(), place.Direction())).Shape()


def _point(corner: Corner, place: gp_Ax3) -> gp_Pnt:
    move = gp_Vec(place.XDirection()) * corner[0] + gp_Vec(place.Direction()) * corner[1]
    return place.Location().Translated(move)


def _edge(edge: ProfileEdge, place: gp_Ax3, corners: dict[Corner, Any]) -> Any:
    """The edge in space; neighbours share the corner between them."""
    for corner in (edge.start, edge.end):
        if corner not in corners:
            corners[corner] = BRepBuilderAPI_MakeVertex(_point(corner, place)).Vertex()
    start, end = corners[edge.start], corners[edge.end]
    if edge.centre is None:
        return BRepBuilderAPI_MakeEdge(start, end).Edge()
    # About minus y angles grow as in (r, z); a clockwise arc runs about plus y with its angles negated.
    normal = place.YDirection().Reversed() if edge.sweep > 0 else place.YDirection()
    first = edge.first if edge.sweep > 0 else -edge.first
    circle = Geom_Circle(gp_Ax2(_point(edge.centre, place), normal, place.XDirection()), edge.radius)
    return BRepBuilderAPI_MakeEdge(circle, start, end, first, first + abs(edge.sweep)).Edge()
