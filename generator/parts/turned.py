"""Turned parts: a profile of lines and arcs revolved about z, then drilled."""

from __future__ import annotations

import math

from linkwright.designs.language.errors import BuildError
from linkwright.designs.language.features import Hole, Turned

from .blank import Blank
from .holes import hex_tool, hole_centres, tools_of_cross_holes, tools_of_holes
from .profile import ProfileEdge, build_profile, outer_walls, profile_span, swept_volume
from .revolve import revolve

#: Relative error allowed to the kernel's integration of a solid of revolution against Pappus.
_EXACT = 1e-9


def build_turned(feature: Turned, where: str) -> Blank:
    """The uncut solid and what is to be cut from it.

    Raises:
        BuildError: the profile or a hole makes no sense.
    """
    edges = build_profile(feature.profile, where)
    span = profile_span(edges)
    tools = tools_of_holes(feature.holes, span, where) + tools_of_cross_holes(feature.cross_holes, where)
    if feature.hex_socket is not None:
        tools.append(hex_tool(feature.hex_socket, where))
    for i, hole in enumerate(feature.holes):
        _refuse_lost_wall(edges, hole, i, where)
    volume = swept_volume(edges)
    low, high = volume * (1.0 - _EXACT), volume * (1.0 + _EXACT)
    return Blank(
        shape=revolve(edges),
        volume=(low, high),
        tools=tuple(tools),
        cut_volume=(low - sum(tool.volume for tool in tools), high),
    )


def _refuse_lost_wall(edges: tuple[ProfileEdge, ...], hole: Hole, i: int, where: str) -> None:
    """A hole must stay within the straight cylinders that bound the part along its depth."""
    sign = 1.0 if hole.upwards else -1.0
    depth = math.inf if hole.depth is None else hole.depth
    for name, diameter, length in (
        ("hole", hole.diameter, depth),
        ("head of hole", hole.head_diameter, hole.head_depth),
    ):
        low, high = sorted((hole.top, hole.top + sign * length))
        for x, y in hole_centres(hole):
            reach = math.hypot(x, y) + diameter / 2.0
            for wall in outer_walls(edges, low, high):
                if diameter > 0.0 and reach - diameter < wall <= reach:
                    raise BuildError(
                        where,
                        f"{name} {i} (diameter {diameter:g} mm) leaves a wall of {wall - reach:.4g} mm in "
                        f"the cylinder of diameter {2.0 * wall:g} mm; narrow the hole or widen the part",
                    )
