"""The platform: a three-armed plate with a socket under the end of each arm, and the handle on top."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..chains.pivot import Lay
from ..chains.spherical_joint import SphericalJointDimensions, socket_parts
from ..chains.tripod import DELTAS
from ..language.bodies import Part
from ..language.features import Hole, Milled, Slab, Turned, Vertex
from ..language.hardware import purchased_part, screw_feature
from ..language.supplies import screw
from .parameters import HitMaterials, HitParameters, HitPlatform

_MOUNT_SCREW = "ISO4762-M6"
_HANDLE_SCREW, _HANDLE_SCREW_LENGTH = "ISO10642-M6", 20.0


def platform_parts(sections: Mapping[str, Any]) -> tuple[Part, ...]:
    """All parts of the platform, in its frame: origin amid the ball centres, z up."""
    p: HitParameters = sections["parameters"]
    s: HitPlatform = sections["parts.platform"]
    d: SphericalJointDimensions = sections["parts.spherical_joint"]
    m: HitMaterials = sections["materials"]
    low = -d.back
    parts = [Part(name="plate", feature=_star(p, s, d, low), material=m.platform)]
    for i, delta in enumerate(DELTAS):
        parts.extend(_socket(f"socket_{i + 1}", p, s, d, m, delta))
    top = low + s.plate_thickness
    up = Lay(z=(0.0, 0.0, 1.0))
    handle_screw = screw(_HANDLE_SCREW)
    parts.append(
        Part(
            name="handle",
            feature=_handle(s),
            at=up.at(0.0, 0.0, top),
            material=m.handle,
            fit="on the plate, one screw from below",
        )
    )
    parts.append(
        purchased_part(
            "handle_screw",
            screw_feature(_HANDLE_SCREW, _HANDLE_SCREW_LENGTH),
            handle_screw,
            up.at(0.0, 0.0, low),
            length=_HANDLE_SCREW_LENGTH,
            fit="into the handle",
        )
    )
    return tuple(parts)


def _star(p: HitParameters, s: HitPlatform, d: SphericalJointDimensions, low: float) -> Milled:
    high = low + s.plate_thickness
    reach, hub, arm = p.platform_radius, s.hub_diameter / 2.0, s.arm_width / 2.0
    mount, handle = screw(_MOUNT_SCREW), screw(_HANDLE_SCREW)
    slabs = [Slab(circles=((0.0, 0.0, hub),), low=low, high=high)]
    windows, holes = [], []
    for delta in DELTAS:
        x, y = reach * math.cos(delta), reach * math.sin(delta)
        slabs.append(Slab(circles=((0.0, 0.0, arm), (x, y, arm)), low=low, high=high))
        slot = arm / 2.5
        # From the hub's rim to where the bushing's back begins, 4 mm of metal left at both ends.
        first, last = hub + 4.0 + slot, reach - d.cover_diameter / 2.0 - 4.0 - slot
        if last > first:
            windows.append(
                Slab(
                    circles=tuple((f * math.cos(delta), f * math.sin(delta), slot) for f in (first, last)),
                    low=low,
                    high=high,
                )
            )
        holes.append(Hole(x=x, y=y, top=high, diameter=mount.clearance_hole))
    holes.append(
        Hole(
            top=low,
            upwards=True,
            diameter=handle.clearance_hole,
            head_diameter=handle.countersink_diameter,
            head_depth=(handle.countersink_diameter - handle.clearance_hole) / 2.0,
            countersink=True,
        )
    )
    return Milled(slabs=tuple(slabs), windows=tuple(windows), holes=tuple(holes))


def _handle(s: HitPlatform) -> Turned:
    """A grip with a waist, tapped from below."""
    r, h = s.handle_diameter / 2.0, s.handle_length
    waist = 0.8 * r
    profile = (
        Vertex(r=0.0, z=0.0),
        Vertex(r=r, z=0.0),
        Vertex(r=r, z=0.08 * h),
        Vertex(r=waist, z=0.3 * h, mid=(0.87 * r, 0.18 * h)),
        Vertex(r=r, z=0.75 * h, mid=(0.92 * r, 0.52 * h)),
        Vertex(r=r, z=h - r),
        Vertex(r=0.0, z=h, mid=(r * math.sqrt(0.5), h - r + r * math.sqrt(0.5))),
    )
    return Turned(profile=profile, holes=(Hole(top=0.0, upwards=True, diameter=6.0, depth=18.0, thread="M6"),))


def _socket(
    name: str, p: HitParameters, s: HitPlatform, d: SphericalJointDimensions, m: HitMaterials, delta: float
) -> tuple[Part, ...]:
    """A socket that opens downwards, its ball's centre in the platform's plane, screwed on from above."""
    c, n = math.cos(delta), math.sin(delta)
    lay = Lay(z=(0.0, 0.0, -1.0), x=(c, n, 0.0), origin=(p.platform_radius * c, p.platform_radius * n, 0.0))
    mount = screw(_MOUNT_SCREW)
    length = max(known for known in mount.lengths if known <= s.plate_thickness + d.mount_depth - 0.5)
    mount_screw = purchased_part(
        f"{name}_mount_screw",
        screw_feature(mount.name, length),
        mount,
        lay.at(0.0, 0.0, d.back - s.plate_thickness),
        length=length,
        fit="into the bushing's floor",
    )
    return (*socket_parts(d, name, lay, housing=m.platform, seats=m.seats, shims=m.pins), mount_screw)
