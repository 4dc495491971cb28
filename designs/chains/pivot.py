"""A pin with bearings: what sits in the eye of one body, and what is pressed into the other and runs in it.

A bearing is two parts here, since its rings move with different bodies: the outer ring with its shields in the eye,
the inner ring on the pin. Sleeves fill the pin between rings, a clip ends it. All lie along one axis, in a frame
whose z is that axis; `Lay` puts that frame into the body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..language.bodies import Part, Placement
from ..language.features import Hole, Turned, Vertex
from ..language.hardware import SHIELD_RECESS, spacer
from ..language.hardware import clip as clip_feature
from ..language.hardware import pin as pin_feature
from ..language.supplies import Bearing, Clip

#: Air between the inner ring and the shields, radially [mm]: about 0.15 in small bearings.
RING_GAP = 0.15


@dataclass(frozen=True, slots=True, kw_only=True)
class Lay:
    """How the plane (x, y) and axis z of a stack lie in a body: directions of z and x in the body's axes."""

    z: tuple[float, float, float] = (0.0, 0.0, 1.0)
    x: tuple[float, float, float] = (1.0, 0.0, 0.0)
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)

    def at(self, x: float, y: float, z: float, *, flip: bool = False) -> Placement:
        """Placement of a part at (x, y, z) of the stack's frame; flipped, its z points down the axis."""
        e_z, e_x = self.z, self.x
        e_y = (e_z[1] * e_x[2] - e_z[2] * e_x[1], e_z[2] * e_x[0] - e_z[0] * e_x[2], e_z[0] * e_x[1] - e_z[1] * e_x[0])
        o = self.origin
        origin = (
            o[0] + x * e_x[0] + y * e_y[0] + z * e_z[0],
            o[1] + x * e_x[1] + y * e_y[1] + z * e_z[1],
            o[2] + x * e_x[2] + y * e_y[2] + z * e_z[2],
        )
        return Placement(origin=origin, z=(-e_z[0], -e_z[1], -e_z[2]) if flip else e_z, x=e_x)


#: For bodies whose z is the axis of their pins.
ALONG_Z = Lay()


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """Bearings on a pin from z = low to z = high."""

    low: float
    high: float


def inner_ring(row: Bearing) -> Turned:
    """The ring on the pin, z from 0 to the bearing's width."""
    return spacer(row.bore, row.inner_land, row.width)


def outer_ring(row: Bearing) -> Turned:
    """The ring in the eye with its recessed shields, z from 0 to the bearing's width."""
    shield, land, outer, width = row.inner_land / 2.0 + RING_GAP, row.outer_land / 2.0, row.outer / 2.0, row.width
    corners = (
        (land, 0.0),
        (outer, 0.0),
        (outer, width),
        (land, width),
        (land, width - SHIELD_RECESS),
        (shield, width - SHIELD_RECESS),
        (shield, SHIELD_RECESS),
        (land, SHIELD_RECESS),
    )
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners))


def sleeve(row: Bearing, length: float) -> Turned:
    """A tube on the pin between inner rings, z from 0 to `length` [mm]: touches the inner ring only."""
    return spacer(row.bore, min(row.inner_land, row.shaft_shoulder_max), length)


def eye_hole(row: Bearing, x: float, y: float, run: Run, lip_bore: float, *, opens_up: bool) -> Hole:
    """The bore of an eye: a seat for the outer rings that opens on one side, a lip with its own bore on the other."""
    return Hole(
        x=x,
        y=y,
        top=run.high if opens_up else run.low,
        upwards=not opens_up,
        diameter=lip_bore,
        depth=None,
        head_diameter=row.outer,
        head_depth=run.high - run.low,
    )


def outer_rings(name: str, row: Bearing, x: float, y: float, run: Run, lay: Lay = ALONG_Z) -> tuple[Part, ...]:
    """The outer rings of an eye, pressed in side by side."""
    return tuple(
        Part(
            name=f"{name}_outer_ring_{k + 1}",
            feature=outer_ring(row),
            at=lay.at(x, y, run.low + k * row.width),
            material="steel_100cr6",
            purchased=row.name,
            mass=0.6 * row.mass,
            runs_in_joint=True,
            fit="light press N7 in the eye, against its lip",
        )
        for k in range(round((run.high - run.low) / row.width))
    )


def inner_rings(name: str, row: Bearing, x: float, y: float, run: Run, lay: Lay = ALONG_Z) -> tuple[Part, ...]:
    """The inner rings of a run, on the pin."""
    return tuple(
        Part(
            name=f"{name}_inner_ring_{k + 1}",
            feature=inner_ring(row),
            at=lay.at(x, y, run.low + k * row.width),
            material="steel_100cr6",
            purchased=f"{row.name} (inner ring)",
            mass=0.4 * row.mass,
            runs_in_joint=True,
            fit="slide h6 on the pin, held by sleeve and clip",
        )
        for k in range(round((run.high - run.low) / row.width))
    )


def pinned(
    name: str,
    row: Bearing,
    clip: Clip,
    x: float,
    y: float,
    fixed: tuple[float, float],
    *,
    ups: Sequence[Run] = (),
    downs: Sequence[Run] = (),
    end_length: float,
    material: str,
    lay: Lay = ALONG_Z,
) -> tuple[Part, ...]:
    """A pin pressed into its body over z = fixed, with inner rings, sleeves and clips on each side that has runs.

    A side without runs ends flush with the body.
    """
    land = max(end_length, clip.end_land)
    low = downs[-1].low - clip.groove_width - land if downs else fixed[0]
    high = ups[-1].high + clip.groove_width + land if ups else fixed[1]
    grooves = [clip.groove(land)] if downs else []
    grooves += [clip.groove(ups[-1].high - low)] if ups else []
    parts = [
        Part(
            name=f"{name}_pin",
            feature=pin_feature(row.bore, high - low, grooves=tuple(grooves)),
            at=lay.at(x, y, low),
            material=material,
            runs_in_joint=True,
            fit="press H7/p6 in its body",
        )
    ]
    for side, runs in (("up", ups), ("down", downs)):
        edge = fixed[1] if side == "up" else fixed[0]
        for k, run in enumerate(runs):
            tag = f"{name}_{side}_{k + 1}"
            start, stop = (edge, run.low) if side == "up" else (run.high, edge)
            if stop - start > 1e-9:
                parts.append(
                    Part(
                        name=f"{tag}_sleeve",
                        feature=sleeve(row, stop - start),
                        at=lay.at(x, y, start),
                        material=material,
                        runs_in_joint=True,
                        fit="slide on the pin",
                    )
                )
            parts.extend(inner_rings(tag, row, x, y, run, lay))
            edge = run.high if side == "up" else run.low
        if runs:
            at = runs[-1].high if side == "up" else runs[-1].low - clip.thickness
            parts.append(
                Part(
                    name=f"{name}_{side}_clip",
                    feature=clip_feature(clip.name),
                    at=lay.at(x, y, at),
                    material="stainless_1_4301",
                    purchased=clip.name,
                    mass=clip.mass,
                    runs_in_joint=True,
                    fit="snaps into the pin's groove",
                )
            )
    return tuple(parts)
