"""The frame of a sub-chain: two side plates around the lower bars' hubs, both motors, axles, keel and counterweight.

Body axes: x along the motor axes (outwards), y along the pin, z up the leg. Parts are drawn in the leg's plane, whose
axes are (y, z), with x as height.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from ..chains.pivot import Lay, Run, inner_rings, outer_rings, pinned, sleeve
from ..language.bodies import Part, Placement
from ..language.features import CrossHole, Hole, Milled, Slab, Turned, Vertex
from ..language.hardware import motor_body, pin, purchased_part, screw_feature
from ..language.supplies import bearing, clip, motor, screw
from .joints import polar
from .layers import stack_layers
from .parameters import HitFrame, HitLinks, HitMaterials, HitParameters

#: The leg's plane seen from outside: part x along the pin, part y up the leg, part z outwards.
LEG_PLANE = Lay(z=(1.0, 0.0, 0.0), x=(0.0, 1.0, 0.0))
_PLANE = Placement(z=(1.0, 0.0, 0.0), x=(0.0, 1.0, 0.0))
_BLOCK_SCREW = "ISO4762-M4"
_ROD = 6.0  # M6: stiff enough for 0.2 kg at 50 mm
_NUT_ACROSS, _NUT_HEIGHT = 10.0, 5.0  # ISO 4032-M6 (width across flats, height)


class FrameShop:
    """Makes the frame's parts from the design's sections."""

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.p: HitParameters = sections["parameters"]
        self.f: HitFrame = sections["parts.frame"]
        self.links: HitLinks = sections["parts.links"]
        self.materials: HitMaterials = sections["materials"]
        supplies = sections["supplies"]
        self.row, self.link_row = bearing(supplies.frame_bearing), bearing(supplies.link_bearing)
        self.clip, self.motor = clip(supplies.clip), motor(supplies.motor)
        self.layers = stack_layers(self.links, self.link_row)
        self.half = self.f.plate_gap / 2.0
        #: Bearing seat, lip, and the recess that centres the motor.
        self.thickness = self.row.width + self.f.bearing_lip + self.motor.pilot_length
        self.outer_face = self.half + self.thickness
        self.motor_screw = self._motor_screw()
        self.e, self.h = self.p.frame_width / 2.0, self.p.pivot_height
        v1 = polar(self.p.lower_offset, self.p.lower_offset_angle)
        self.foot = (-self.e + v1[0], self.h + v1[1])

    def _motor_screw(self) -> tuple[float, float]:
        """Length of the motor's screws, and how deep their heads sink into the side plate's inner face [mm].

        The longest whose head sinks in and whose tip stays 0.3 mm short of the holes' ground.
        """
        mount = screw(f"ISO4762-{self.motor.mount_screw}")
        reach = self.thickness + self.motor.mount_depth - 0.3
        length = max(known for known in mount.lengths if known <= reach - mount.head_height)
        return length, reach - length

    def parts(self) -> tuple[Part, ...]:
        """All parts of the frame."""
        return (
            *self._side(-1.0),
            *self._side(1.0),
            *self._blocks(),
            *self._inner_foot(),
            *self._balance(),
        )

    def _screw_places(self) -> tuple[tuple[float, float], ...]:
        """Where the side plates are screwed to blocks and keel: two screws each."""
        span, tall = self.f.pin_span / 2.0, self.f.end_block_height / 2.0 - 4.0
        return ((-span, -tall), (-span, tall), (span, -tall), (span, tall), (-5.5, 2.0), (5.5, 2.0))

    def _side(self, side: float) -> tuple[Part, ...]:
        """A side plate at -x (side -1, carries the left bar's motor) or +x (+1, the right bar's), with its parts."""
        name = "inner" if side < 0 else "outer"
        inner, outer = side * self.half, side * self.outer_face
        low, high = min(inner, outer), max(inner, outer)
        own, other = (-self.e, self.e) if side < 0 else (self.e, -self.e)
        plate = Part(
            name=f"side_plate_{name}",
            at=_PLANE,
            material=self.materials.frame,
            feature=Milled(
                slabs=self._outline(own, other, low, high, with_foot=side > 0),
                holes=self._holes(side, own, other, inner, outer),
                edge_break=self.links.edge_break,
            ),
        )
        run = Run(low=min(inner, inner + side * self.row.width), high=max(inner, inner + side * self.row.width))
        rings = [
            r
            for tag, y in (("left", -self.e), ("right", self.e))
            for r in outer_rings(f"{name}_{tag}", self.row, y, self.h, run, LEG_PLANE)
        ]
        return plate, *rings, *self._motor(side, name, own, outer), *self._plate_screws(side, name, outer)

    def _outline(self, own: float, other: float, low: float, high: float, *, with_foot: bool) -> tuple[Slab, ...]:
        """The motor's flange, the other bar's bearing, both end blocks, and the lug of the inner lower bar."""
        f, span, tall = self.f, self.f.pin_span / 2.0, self.f.end_block_height / 2.0
        big = self.motor.mount_circle / 2.0 + self.f.plate_rim + 2.0
        small = self.row.outer / 2.0 + f.plate_rim
        corner = 3.0
        edge = span + f.end_block / 2.0 - corner
        ends = tuple((s * edge, t * (tall - corner), corner) for s in (-1.0, 1.0) for t in (-1.0, 1.0))
        slabs = [Slab(circles=((own, self.h, big), (other, self.h, small), *ends), low=low, high=high)]
        if with_foot:
            lug = self.link_row.bore / 2.0 + 4.0
            slabs.append(Slab(circles=((*self.foot, lug), (0.0, self.h, lug)), low=low, high=high))
        return tuple(slabs)

    def _holes(self, side: float, own: float, other: float, inner: float, outer: float) -> tuple[Hole, ...]:
        row, m = self.row, self.motor
        seat_up = side > 0
        lip_bore = row.outer - 4.0
        seats = tuple(
            Hole(
                x=y,
                y=self.h,
                top=inner,
                upwards=seat_up,
                diameter=lip_bore,
                head_diameter=row.outer,
                head_depth=row.width,
            )
            for y in (own, other)
        )
        recess = Hole(x=own, y=self.h, top=outer, upwards=not seat_up, diameter=m.pilot_diameter, depth=m.pilot_length)
        mount = screw(f"ISO4762-{m.mount_screw}")
        flange = Hole(
            x=own,
            y=self.h,
            top=inner,
            upwards=seat_up,
            diameter=mount.clearance_hole,
            head_diameter=mount.head_diameter + 0.5,
            head_depth=self.motor_screw[1],
            n=m.n_mount,
            pitch_radius=m.mount_circle / 2.0,
            first=m.first_hole,
        )
        block = screw(_BLOCK_SCREW)
        blocks = tuple(
            Hole(
                x=y,
                y=z,
                top=outer,
                upwards=not seat_up,
                diameter=block.clearance_hole,
                head_diameter=block.head_diameter + 0.5,
                head_depth=block.head_height + 0.4,
            )
            for y, z in self._screw_places()
        )
        foot = (Hole(x=self.foot[0], y=self.foot[1], top=outer, diameter=self.link_row.bore),) if side > 0 else ()
        return (*seats, recess, flange, *blocks, *foot)

    def _motor(self, side: float, name: str, own: float, outer: float) -> tuple[Part, ...]:
        m, mount = self.motor, screw(f"ISO4762-{self.motor.mount_screw}")
        length, recess = self.motor_screw
        head = side * (self.half + recess)
        body = purchased_part(
            f"motor_{name}",
            motor_body(m.name),
            m,
            LEG_PLANE.at(own, self.h, outer, flip=side > 0),
            runs_in_joint=True,
            fit="pilot H7 in the side plate",
        )
        screws = []
        for k in range(m.n_mount):
            angle = m.first_hole + 2.0 * math.pi * k / m.n_mount
            y, z = own + m.mount_circle / 2.0 * math.cos(angle), self.h + m.mount_circle / 2.0 * math.sin(angle)
            at = LEG_PLANE.at(y, z, head, flip=side < 0)
            screws.append(
                purchased_part(
                    f"motor_{name}_screw_{k + 1}",
                    screw_feature(mount.name, length),
                    mount,
                    at,
                    length=length,
                    fit="screwed into the motor's flange",
                )
            )
        return body, *screws

    def _plate_screws(self, side: float, name: str, outer: float) -> tuple[Part, ...]:
        block, length = screw(_BLOCK_SCREW), 12.0
        head = outer - side * (block.head_height + 0.4)
        return tuple(
            purchased_part(
                f"block_screw_{name}_{k + 1}",
                screw_feature(block.name, length),
                block,
                LEG_PLANE.at(y, z, head, flip=side > 0),
                length=length,
                fit="screwed into block or keel",
            )
            for k, (y, z) in enumerate(self._screw_places())
        )

    def _tapped(self, y: float, z: float) -> tuple[Hole, ...]:
        block = screw(_BLOCK_SCREW)
        return tuple(
            Hole(
                x=y, y=z, top=s * self.half, upwards=s < 0, diameter=block.diameter, depth=self.half - 0.5, thread="M4"
            )
            for s in (-1.0, 1.0)
        )

    def _block(self, name: str, circles: tuple[tuple[float, float, float], ...], places, cross: CrossHole) -> Part:
        holes = tuple(h for y, z in places for h in self._tapped(y, z))
        feature = Milled(
            slabs=(Slab(circles=circles, low=-self.half, high=self.half),),
            holes=holes,
            cross_holes=(cross,),
            edge_break=self.links.edge_break,
        )
        return Part(
            name=name, feature=feature, at=_PLANE, material=self.materials.frame, fit="between the side plates, screwed"
        )

    def _blocks(self) -> tuple[Part, ...]:
        """End blocks with the stub axles on which the leg leans, and the keel between them."""
        f, row, places = self.f, self.row, self._screw_places()
        span, half, tall, corner = f.pin_span / 2.0, f.end_block / 2.0, f.end_block_height / 2.0, 1.5
        parts: list[Part] = []
        for name, s in (("left", -1.0), ("right", 1.0)):
            circles = tuple(
                (s * span + a * (half - corner), b * (tall - corner), corner) for a in (-1, 1) for b in (-1, 1)
            )
            here = tuple(q for q in places if q[0] * s > 10.0)
            bore = CrossHole(
                origin=(s * (span + half), 0.0, 0.0), direction=(-s, 0.0, 0.0), diameter=row.bore, depth=f.end_block
            )
            parts.append(self._block(f"end_block_{name}", circles, here, bore))
            parts.extend(self._axle(name, s, span - half))
        keel = tuple((a * 7.5, z, 1.5) for a in (-1.0, 1.0) for z in (4.5, -10.5))
        rod = CrossHole(origin=(0.0, -12.0, 0.0), direction=(0.0, 1.0, 0.0), diameter=_ROD, depth=9.0, thread="M6")
        parts.append(self._block("keel", keel, places[4:], rod))
        return tuple(parts)

    def _axle(self, name: str, s: float, start: float) -> tuple[Part, ...]:
        """A stub axle along the pin, pressed into its block; its inner ring runs in the pedestal."""
        f, row = self.f, self.row
        along = Lay(z=(0.0, s, 0.0), x=(1.0, 0.0, 0.0))
        face = start + f.end_block
        gap = f.axle_length - f.end_block - row.width
        run = Run(low=face + gap, high=face + gap + row.width)
        return (
            Part(
                name=f"axle_{name}",
                feature=pin(row.bore, f.axle_length),
                at=along.at(0.0, 0.0, start),
                material=self.materials.pins,
                runs_in_joint=True,
                fit="press H7/r6 in the end block",
            ),
            Part(
                name=f"axle_{name}_sleeve",
                feature=sleeve(row, gap),
                at=along.at(0.0, 0.0, face),
                material=self.materials.pins,
                runs_in_joint=True,
                fit="slide on the axle",
            ),
            *inner_rings(f"axle_{name}", row, 0.0, 0.0, run, along),
        )

    def _inner_foot(self) -> tuple[Part, ...]:
        """The pin on the outer side plate on which the inner lower bar turns."""
        run = self.layers.inner_lower.run(self.links.lip, opens_up=True)
        return pinned(
            "inner_foot",
            self.link_row,
            self.clip,
            *self.foot,
            (self.half, self.outer_face),
            ups=(run,),
            end_length=self.links.end_length,
            material=self.materials.pins,
            lay=LEG_PLANE,
        )

    def _balance(self) -> tuple[Part, ...]:
        """The adjustable counterweight below the pin: a disc between two nuts on a threaded rod."""
        f = self.f
        down = Lay(z=(0.0, 0.0, -1.0), x=(1.0, 0.0, 0.0))
        start = 12.0 - 8.5
        low, high = (
            f.counterweight_drop - f.counterweight_length / 2.0,
            f.counterweight_drop + f.counterweight_length / 2.0,
        )
        r, bore = f.counterweight_diameter / 2.0, _ROD / 2.0
        disc = Turned(
            profile=tuple(
                Vertex(r=a, z=b)
                for a, b in (
                    (bore, 0.0),
                    (r - 1.0, 0.0),
                    (r, 1.0),
                    (r, f.counterweight_length - 1.0),
                    (r - 1.0, f.counterweight_length),
                    (bore, f.counterweight_length),
                )
            )
        )
        flat = _NUT_ACROSS / math.sqrt(3.0)
        hexagon = tuple(
            (flat * math.cos(k * math.pi / 3.0), flat * math.sin(k * math.pi / 3.0), 0.05) for k in range(6)
        )
        nut = Milled(
            slabs=(Slab(circles=hexagon, low=0.0, high=_NUT_HEIGHT),), holes=(Hole(top=_NUT_HEIGHT, diameter=_ROD),)
        )
        return (
            Part(
                name="counterweight_rod",
                feature=pin(_ROD, f.rod_length),
                at=down.at(0.0, 0.0, start),
                material=self.materials.counterweights,
                fit="M6, screwed into the keel",
            ),
            Part(
                name="counterweight",
                feature=disc,
                at=down.at(0.0, 0.0, low),
                material=self.materials.counterweights,
                fit="slides on the rod, held by two nuts",
            ),
            Part(
                name="counterweight_nut_upper",
                feature=nut,
                at=down.at(0.0, 0.0, low - _NUT_HEIGHT),
                material="stainless_1_4301",
                purchased="ISO4032-M6",
                fit="on the rod",
            ),
            Part(
                name="counterweight_nut_lower",
                feature=nut,
                at=down.at(0.0, 0.0, high),
                material="stainless_1_4301",
                purchased="ISO4032-M6",
                fit="on the rod",
            ),
        )
