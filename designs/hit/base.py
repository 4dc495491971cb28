"""The base: a plate and, per leg, two pedestals that hold the bearings of the pin."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..chains.pivot import Lay, Run, eye_hole, outer_rings
from ..chains.tripod import DELTAS
from ..language.bodies import Part
from ..language.features import CrossHole, Hole, Milled, Slab
from ..language.hardware import purchased_part, screw_feature
from ..language.supplies import Bearing, Screw, bearing, screw
from .parameters import HitBase, HitFrame, HitMaterials, HitParameters

_FOOT_SCREW, _FOOT_SCREW_LENGTH = "ISO4762-M4", 16.0
_BENCH_SCREW = 6.6  # clearance for M6, to fix the device to a bench


def base_parts(sections: Mapping[str, Any]) -> tuple[Part, ...]:
    """All parts of the base, in the base frame (pins at z = 0)."""
    p: HitParameters = sections["parameters"]
    b: HitBase = sections["parts.base"]
    f: HitFrame = sections["parts.frame"]
    m: HitMaterials = sections["materials"]
    row = bearing(sections["supplies"].frame_bearing)
    foot = screw(_FOOT_SCREW)
    near = f.pin_span / 2.0 + f.end_block / 2.0 + b.pedestal_gap
    middle = near + b.pedestal_thickness / 2.0
    bottom = -b.pin_height - b.plate_thickness
    places = [
        _base_point(p.base_radius, delta, reach, side * middle)
        for delta in DELTAS
        for side in (-1.0, 1.0)
        for reach in _screw_reach(b)
    ]
    parts = [Part(name="base_plate", material=m.frame, feature=_plate(p, b, f, places, middle, bottom, foot))]
    for i, delta in enumerate(DELTAS):
        for name, side in (("left", -1.0), ("right", 1.0)):
            parts.extend(_pedestal(f"leg_{i + 1}_{name}", delta, side, near, p, b, m, row))
    for k, (x, y) in enumerate(places):
        at = Lay(z=(0.0, 0.0, 1.0)).at(x, y, bottom + foot.head_height + 0.4)
        parts.append(
            purchased_part(
                f"foot_screw_{k + 1}",
                screw_feature(foot.name, _FOOT_SCREW_LENGTH),
                foot,
                at,
                length=_FOOT_SCREW_LENGTH,
                fit="from below into the pedestal",
            )
        )
    return tuple(parts)


def _screw_reach(b: HitBase) -> tuple[float, float]:
    """Radial distance of a pedestal's two foot screws from its axis [mm]."""
    return -b.pedestal_foot / 2.0 + 7.0, b.pedestal_foot / 2.0 - 7.0


def _base_point(radius: float, delta: float, outwards: float, along: float) -> tuple[float, float]:
    """A point of the plate: `outwards` beyond the pin's foot, `along` the pin."""
    c, s = math.cos(delta), math.sin(delta)
    return (radius + outwards) * c - along * s, (radius + outwards) * s + along * c


def _plate(
    p: HitParameters,
    b: HitBase,
    f: HitFrame,
    places: list[tuple[float, float]],
    middle: float,
    bottom: float,
    foot: Screw,
) -> Milled:
    rim = [(*_base_point(p.base_radius, delta, 0.0, s * middle), b.plate_rim) for delta in DELTAS for s in (-1.0, 1.0)]
    low, high = bottom, bottom + b.plate_thickness
    holes = [
        Hole(
            x=x,
            y=y,
            top=bottom,
            upwards=True,
            diameter=foot.clearance_hole,
            head_diameter=foot.head_diameter + 0.5,
            head_depth=foot.head_height + 0.4,
        )
        for x, y in places
    ]
    bench = p.base_radius + b.plate_rim / 2.0
    holes.append(Hole(top=high, diameter=_BENCH_SCREW, n=3, pitch_radius=bench, first=0.0))
    windows: tuple[Slab, ...] = ()
    if b.window_diameter > 0.0:
        windows = (Slab(circles=((0.0, 0.0, b.window_diameter / 2.0),), low=low, high=high),)
    return Milled(
        slabs=(Slab(circles=tuple(rim), low=low, high=high),), windows=windows, holes=tuple(holes), edge_break=1.0
    )


def _pedestal(
    name: str, delta: float, side: float, near: float, p: HitParameters, b: HitBase, m: HitMaterials, row: Bearing
) -> tuple[Part, ...]:
    """A pedestal, drawn across the pin: x inwards, y up, z along the pin; its bearing goes in from the leg's side."""
    c, s = math.cos(delta), math.sin(delta)
    lay = Lay(z=(-s, c, 0.0), x=(-c, -s, 0.0), origin=(p.base_radius * c, p.base_radius * s, 0.0))
    low, high = (near, near + b.pedestal_thickness) if side > 0 else (-near - b.pedestal_thickness, -near)
    run = Run(low=low, high=low + row.width) if side > 0 else Run(low=high - row.width, high=high)
    half, corner = b.pedestal_foot / 2.0, 0.5
    circles = (
        (0.0, 0.0, b.pedestal_head / 2.0),
        (-half + corner, -b.pin_height + corner, corner),
        (half - corner, -b.pin_height + corner, corner),
    )
    seat = eye_hole(row, 0.0, 0.0, run, row.outer - 4.0, opens_up=side < 0)
    threads = tuple(
        CrossHole(
            origin=(-reach, -b.pin_height, (low + high) / 2.0),
            direction=(0.0, 1.0, 0.0),
            diameter=4.0,
            depth=_FOOT_SCREW_LENGTH - 3.0,
            thread="M4",
        )
        for reach in _screw_reach(b)
    )
    feature = Milled(
        slabs=(Slab(circles=circles, low=low, high=high),), holes=(seat,), cross_holes=threads, edge_break=0.4
    )
    return (
        Part(
            name=f"{name}_pedestal",
            feature=feature,
            at=lay.at(0.0, 0.0, 0.0),
            material=m.frame,
            fit="on the base plate, two screws from below",
        ),
        *outer_rings(f"{name}_pin", row, 0.0, 0.0, run, lay),
    )
