"""Whether a hole is a hole: somewhere along its depth material must surround it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from OCP.BRepClass3d import BRepClass3d_SolidClassifier
from OCP.gp import gp_Ax3, gp_Dir, gp_Pnt, gp_Vec
from OCP.TopAbs import TopAbs_IN

from linkwright.designs.language.errors import BuildError

from .holes import Tool

_DEPTHS = 48
_AROUND = 12
#: The probe runs this far outside the bore [mm]: a wall as thin as that is none.
_WALL = 1e-5


def refuse_open_bores(blank: Any, tools: Sequence[Tool], where: str) -> None:
    """Each drilled tool must be wholly surrounded by the uncut solid at one depth at least.

    Raises:
        BuildError: one is not: it is wider than the part, or only grazes it.
    """
    classifier = BRepClass3d_SolidClassifier(blank)

    def surrounds(place: gp_Ax3, radius: float, depth: float) -> bool:
        centre = place.Location().Translated(gp_Vec(place.Direction()) * depth)
        for k in range(_AROUND):
            angle = math.tau * k / _AROUND
            out = gp_Vec(place.XDirection()) * math.cos(angle) + gp_Vec(place.YDirection()) * math.sin(angle)
            classifier.Perform(centre.Translated(out * (radius + _WALL)), 1e-9)
            if classifier.State() != TopAbs_IN:
                return False
        return True

    for tool in tools:
        if tool.bore is None:
            continue
        place = gp_Ax3(gp_Pnt(*tool.bore.origin), gp_Dir(*tool.bore.direction))
        if not any(surrounds(place, tool.bore.radius, tool.bore.depth * share) for share in _shares()):
            raise BuildError(
                where,
                f"{tool.name} is open along its whole depth: nowhere does a wall surround its diameter of "
                f"{2.0 * tool.bore.radius:g} mm; narrow it or move it into the part",
            )


def _shares() -> list[float]:
    """Shares of the depth, coarse ones first: most holes are enclosed at the first."""
    shares = [(k + 0.5) / _DEPTHS for k in range(_DEPTHS)]
    return [*shares[_DEPTHS // 2 :: 8], *shares]
