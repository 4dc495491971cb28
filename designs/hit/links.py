"""The eight links of a sub-chain that swing above its frame, part by part.

A link's frame has x along the link from its lower pin and z along the motor axes, so a part's heights are the layers'.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..chains.pivot import Run, eye_hole, inner_rings, outer_rings, pinned, sleeve
from ..chains.spherical_joint import SphericalJointDimensions, ball_bar
from ..language.bodies import Part, Placement
from ..language.features import CrossHole, Hole, Milled, Slab
from ..language.hardware import motor_shaft, pin
from ..language.supplies import bearing, clip, motor
from .joints import polar
from .layers import Layer, stack_layers
from .parameters import HitFrame, HitLinks, HitMaterials, HitParameters

_WINDOW_END = 14.0  # metal between an eye's centre and the window's end, beyond the eye's radius [mm]


class LinkShop:
    """Makes the links of one sub-chain from the design's sections."""

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.p: HitParameters = sections["parameters"]
        self.links: HitLinks = sections["parts.links"]
        self.frame: HitFrame = sections["parts.frame"]
        self.ball: SphericalJointDimensions = sections["parts.spherical_joint"]
        self.materials: HitMaterials = sections["materials"]
        supplies = sections["supplies"]
        self.row = bearing(supplies.link_bearing)
        self.frame_row = bearing(supplies.frame_bearing)
        self.clip = clip(supplies.clip)
        self.motor = motor(supplies.motor)
        self.layers = stack_layers(self.links, self.row)

    def _pinned(
        self, name: str, x: float, y: float, fixed: Layer, *, ups: tuple[Run, ...] = (), downs: tuple[Run, ...] = ()
    ) -> tuple[Part, ...]:
        return pinned(
            name,
            self.row,
            self.clip,
            x,
            y,
            (fixed.low, fixed.high),
            ups=ups,
            downs=downs,
            end_length=self.links.end_length,
            material=self.materials.pins,
        )

    def _bar(
        self,
        layer: Layer,
        length: float,
        eyes: tuple[float, float],
        width: float,
        holes: tuple[Hole, ...],
        cross_holes: tuple[CrossHole, ...] = (),
    ) -> Part:
        """A bar along x with round eyes (diameters) at 0 and `length`, and a window that saves weight."""
        start, stop = eyes[0] / 2.0 + _WINDOW_END / 2.0, length - eyes[1] / 2.0 - _WINDOW_END / 2.0
        rib = width / 4.0 - 0.25
        slabs = (
            Slab(circles=((0.0, 0.0, width / 2.0), (length, 0.0, width / 2.0)), low=layer.low, high=layer.high),
            Slab(circles=((0.0, 0.0, eyes[0] / 2.0),), low=layer.low, high=layer.high),
            Slab(circles=((length, 0.0, eyes[1] / 2.0),), low=layer.low, high=layer.high),
        )
        window = Slab(circles=((start + rib, 0.0, rib), (stop - rib, 0.0, rib)), low=layer.low, high=layer.high)
        feature = Milled(
            slabs=slabs,
            windows=(window,) if stop - start > 4.0 * rib else (),
            holes=holes,
            cross_holes=cross_holes,
            edge_break=self.links.edge_break,
        )
        return Part(name="bar", feature=feature, material=self.materials.links)

    def _seat(self, layer: Layer, x: float, *, opens_up: bool) -> tuple[Hole, Run]:
        run = layer.run(self.links.lip, opens_up=opens_up)
        return eye_hole(self.row, x, 0.0, run, self.links.lip_bore, opens_up=opens_up), run

    def _eyed_bar(
        self, layer: Layer, length: float, width: float, eye: float, opens_up: tuple[bool, bool]
    ) -> tuple[Part, ...]:
        """A bar with bearings in both eyes; each eye opens up or down the layer."""
        first, run_1 = self._seat(layer, 0.0, opens_up=opens_up[0])
        second, run_2 = self._seat(layer, length, opens_up=opens_up[1])
        return (
            self._bar(layer, length, (eye, eye), width, (first, second)),
            *outer_rings("foot", self.row, 0.0, 0.0, run_1),
            *outer_rings("head", self.row, length, 0.0, run_2),
        )

    def upper_bar(self) -> tuple[Part, ...]:
        """Elbow to top bar; left and right are equal."""
        return self._eyed_bar(
            self.layers.upper, self.p.upper_link_length, self.links.bar_width, self.links.eye_diameter, (False, False)
        )

    def inner_lower(self) -> tuple[Part, ...]:
        """Frame to elbow plate, parallel to the lower left bar."""
        return self._eyed_bar(
            self.layers.inner_lower,
            self.p.lower_link_length,
            self.links.inner_bar_width,
            self.links.inner_eye_diameter,
            (True, True),
        )

    def inner_upper(self) -> tuple[Part, ...]:
        """Elbow plate to top bar, parallel to the upper left bar; its pins come from both sides."""
        return self._eyed_bar(
            self.layers.inner_upper,
            self.p.upper_link_length,
            self.links.inner_bar_width,
            self.links.inner_eye_diameter,
            (False, True),
        )

    def lower_bar(self, *, left: bool) -> tuple[Part, ...]:
        """Drive shaft to elbow, with the elbow's pin; on the left that pin also carries the elbow plate."""
        layer, length = self.layers.middle, self.p.lower_link_length
        down = (self.layers.upper.run(self.links.lip, opens_up=False),)
        up = (self.layers.elbow.run(self.links.lip, opens_up=False),) if left else ()
        holes = (
            Hole(top=layer.high, diameter=self.frame_row.bore),
            Hole(x=length, top=layer.high, diameter=self.row.bore),
        )
        bar = self._bar(layer, length, (self.frame.hub_diameter, self.links.eye_diameter), self.links.bar_width, holes)
        return (bar, *self._drive(left=left), *self._pinned("elbow", length, 0.0, layer, downs=down, ups=up))

    def _drive(self, *, left: bool) -> tuple[Part, ...]:
        """Drive shaft in both side plates, hollow on its motor's side, with the motor's shaft bonded in."""
        half, row, motor_row = self.frame.plate_gap / 2.0, self.frame_row, self.motor
        reach, hub = half + row.width, self.layers.middle
        face = reach + self.frame.bearing_lip + motor_row.pilot_length  # the motor's mounting face
        depth = reach - (face - motor_row.shaft_length) + 0.5
        shaft = Part(
            name="drive_shaft",
            feature=pin(row.bore, 2.0 * reach, bore=motor_row.shaft_diameter, bore_depth=depth),
            at=Placement(origin=(0.0, 0.0, -reach))
            if left
            else Placement(origin=(0.0, 0.0, reach), z=(0.0, 0.0, -1.0)),
            material=self.materials.pins,
            runs_in_joint=True,
            fit="press H7/r6 in the bar's hub",
        )
        rotor = Part(
            name="motor_shaft",
            feature=motor_shaft(motor_row.name),
            at=Placement(origin=(0.0, 0.0, -face)) if left else Placement(origin=(0.0, 0.0, face), z=(0.0, 0.0, -1.0)),
            material="stainless_1_4301",
            purchased=f"{motor_row.name} (shaft)",
            mass=0.0,
            runs_in_joint=True,
            fit="slide H7/h6 in the drive shaft, bonded",
        )
        tube = sleeve(row, half - hub.high)
        inner, outer = Run(low=-reach, high=-half), Run(low=half, high=reach)
        return (
            shaft,
            rotor,
            Part(
                name="sleeve_inner",
                feature=tube,
                at=Placement(origin=(0.0, 0.0, -half)),
                material=self.materials.pins,
                runs_in_joint=True,
                fit="slide on the drive shaft",
            ),
            Part(
                name="sleeve_outer",
                feature=tube,
                at=Placement(origin=(0.0, 0.0, hub.high)),
                material=self.materials.pins,
                runs_in_joint=True,
                fit="slide on the drive shaft",
            ),
            *inner_rings("shaft_inner", row, 0.0, 0.0, inner),
            *inner_rings("shaft_outer", row, 0.0, 0.0, outer),
        )

    def elbow_plate(self) -> tuple[Part, ...]:
        """Turns on the left elbow's pin and holds the pins of both inner bars."""
        layer = self.layers.elbow
        v1 = polar(self.p.lower_offset, self.p.lower_offset_angle)
        v2 = polar(self.p.upper_offset, self.p.upper_offset_angle)
        run = layer.run(self.links.lip, opens_up=False)
        small = self.row.bore / 2.0 + 4.0
        circles = ((0.0, 0.0, self.links.eye_diameter / 2.0), (*v1, small), (*v2, small))
        holes = (
            eye_hole(self.row, 0.0, 0.0, run, self.links.lip_bore, opens_up=False),
            Hole(x=v1[0], y=v1[1], top=layer.high, diameter=self.row.bore),
            Hole(x=v2[0], y=v2[1], top=layer.high, diameter=self.row.bore),
        )
        plate = Milled(
            slabs=(Slab(circles=circles, low=layer.low, high=layer.high),),
            holes=holes,
            edge_break=self.links.edge_break,
        )
        return (
            Part(name="plate", feature=plate, material=self.materials.links),
            *outer_rings("elbow", self.row, 0.0, 0.0, run),
            *self._pinned("lower", *v1, layer, ups=(self.layers.inner_lower.run(self.links.lip, opens_up=True),)),
            *self._pinned("upper", *v2, layer, downs=(self.layers.inner_upper.run(self.links.lip, opens_up=False),)),
        )

    def top_bar(self) -> tuple[Part, ...]:
        """Joins the upper bars, only translates, and carries the ball-bar in the plane of the pin."""
        layer, e, eye = self.layers.middle, self.p.frame_width / 2.0, self.links.eye_diameter / 2.0
        v2 = polar(self.p.upper_offset, self.p.upper_offset_angle)
        third = (-e + v2[0], v2[1])
        seat = self.p.ball_height - self.ball.stem_length
        slabs = (
            Slab(circles=((-e, 0.0, eye), (e, 0.0, eye)), low=layer.low, high=layer.high),
            Slab(circles=((-e, 0.0, eye - 0.5), (*third, eye - 2.0)), low=layer.low, high=layer.high),
        )
        holes = tuple(Hole(x=x, y=y, top=layer.high, diameter=self.row.bore) for x, y in ((-e, 0.0), (e, 0.0), third))
        tapped = CrossHole(
            origin=(0.0, seat, 0.0),
            direction=(0.0, -1.0, 0.0),
            diameter=self.ball.stud_diameter,
            depth=min(self.ball.stud_length + 1.0, 2.0 * eye - 3.0),
            thread=f"M{self.ball.stud_diameter:g}",
        )
        down = (self.layers.upper.run(self.links.lip, opens_up=False),)
        up = (self.layers.inner_upper.run(self.links.lip, opens_up=True),)
        ball_at = Placement(origin=(0.0, self.p.ball_height, 0.0), z=(0.0, -1.0, 0.0))
        return (
            Part(
                name="bar",
                feature=Milled(slabs=slabs, holes=holes, cross_holes=(tapped,), edge_break=self.links.edge_break),
                material=self.materials.links,
            ),
            *self._pinned("left", -e, 0.0, layer, downs=down),
            *self._pinned("right", e, 0.0, layer, downs=down),
            *self._pinned("inner", *third, layer, ups=up),
            Part(
                name="ball_bar",
                feature=ball_bar(self.ball),
                at=ball_at,
                material=self.materials.balls,
                runs_in_joint=True,
                fit="screwed into the top bar against its shoulder",
            ),
        )
