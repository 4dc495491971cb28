"""A mechanism of one's own, outside the package: a five-bar whose two arms differ, with bars, pins and bearings.

    linkwright --mechanisms examples/asymmetric_five_bar.py check examples/asymmetric_five_bar.toml

It is made of chains that the package has: the dyad (an arm), the dyad pair (where two arms meet) and the pivot (pin,
bearings, sleeves, clips). The motors are not drawn.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from linkwright.designs.catalogue import Entry
from linkwright.designs.chains.dyad import DyadAngles, rate_row, solve_dyad
from linkwright.designs.chains.dyad_pair import meet_circles
from linkwright.designs.chains.dyad_pair_mechanism import TASK, DyadPairMechanism, hinge, link_frame
from linkwright.designs.chains.pivot import Run, eye_hole, outer_rings, pinned
from linkwright.designs.chains.sections import check_order
from linkwright.designs.design import Workspace
from linkwright.designs.language.bodies import Body, Part
from linkwright.designs.language.errors import ParameterError
from linkwright.designs.language.features import Hole, Milled, Slab
from linkwright.designs.language.joints import Joint
from linkwright.designs.language.materials import material_names
from linkwright.designs.language.mechanism import Array
from linkwright.designs.language.parameters import angle, choice, length
from linkwright.designs.language.supplies import bearing, clip, names
from linkwright.designs.language.units import DEG
from linkwright.designs.language.vectors import Rot, Vec, rot_z
from linkwright.designs.language.vocabulary import Number, Require, Requirements, cos, sin


@dataclass(frozen=True, slots=True, kw_only=True)
class Dimensions:
    """The kinematic dimensions, free on each side."""

    pivot_distance: float = length(90.0, "between the driven axes", symbol="d")
    right_arm_length: float = length(80.0, "right driven link", symbol="a_1")
    right_tip_link_length: float = length(120.0, "right elbow to the tip", symbol="b_1")
    left_arm_length: float = length(100.0, "left driven link; longer, to give room on the left", symbol="a_2")
    left_tip_link_length: float = length(110.0, "left elbow to the tip", symbol="b_2")


@dataclass(frozen=True, slots=True, kw_only=True)
class Limits:
    """The declared joint limits; `linkwright check` shows that the solids allow them."""

    right_arm_min: float = angle(-30.0 * DEG, "right arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    right_arm_max: float = angle(100.0 * DEG, "right arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    left_arm_min: float = angle(80.0 * DEG, "left arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    left_arm_max: float = angle(210.0 * DEG, "left arm from +x", least=-180.0 * DEG, most=360.0 * DEG)
    elbow_min: float = angle(20.0 * DEG, "bend of an elbow: away from stretched", least=0.0, most=180.0 * DEG)
    elbow_max: float = angle(150.0 * DEG, "bend of an elbow: away from folded", least=0.0, most=180.0 * DEG)
    tip_min: float = angle(20.0 * DEG, "angle between the tip links", least=0.0, most=180.0 * DEG)
    tip_max: float = angle(160.0 * DEG, "angle between the tip links", least=0.0, most=180.0 * DEG)


@dataclass(frozen=True, slots=True, kw_only=True)
class Bars:
    """Bars and pins: the arms in one layer, the right tip link above them, the left one above that."""

    width: float = length(12.0, "of a bar")
    eye_diameter: float = length(16.0, "bearing outer ring plus 3 mm wall")
    lip: float = length(1.0, "shoulder that holds the outer rings")
    lip_bore: float = length(9.0, "of that shoulder: carries the outer ring, passes the clip")
    layer_gap: float = length(1.5, "air between layers; pins end 0.7 mm above theirs")
    end_length: float = length(1.0, "pin beyond its clip")
    edge_break: float = length(0.4, "chamfer on the outlines", least=0.0)
    base_thickness: float = length(10.0, "of the plate that holds the driven axes")
    base_rim: float = length(18.0, "metal around these")


@dataclass(frozen=True, slots=True, kw_only=True)
class Supplies:
    """Catalogue parts and materials by name (`linkwright list --supplies`)."""

    bearing: str = choice("MR104ZZ", "two in each eye", names("bearings"))
    clip: str = choice("DIN6799-3.2", "on every pin", names("clips"))
    bars: str = choice("aluminium_6082", "material of bars and base plate", material_names())
    pins: str = choice("steel_c45", "material of pins and sleeves", material_names())


SECTIONS: dict[str, type] = {
    "parameters": Dimensions,
    "joint_limits": Limits,
    "parts.bars": Bars,
    "supplies": Supplies,
}


class State(NamedTuple):
    """The device at a pose: directions of the links [rad]."""

    right: DyadAngles
    left: DyadAngles


class AsymmetricFiveBar(DyadPairMechanism):
    """Two different arms driven at the base, with one tip, 2 DOF."""

    name = "asymmetric_five_bar"
    title = "Planar five-bar with two different arms, 2 DOF"
    source = "an example of this repository"
    assembly_mode = "tip beyond the elbows"
    section_classes = SECTIONS

    def __init__(self, sections: Mapping[str, Any]) -> None:
        super().__init__(sections)
        self.dimensions: Dimensions = self.sections["parameters"]
        check_order(self.sections["joint_limits"], ("right_arm", "left_arm", "elbow", "tip"))
        self.joints = build_joints(self.dimensions, self.sections["joint_limits"])
        self.bodies = BarShop(self.sections).bodies()
        self.home = self._right_angles()

    def _right_angles(self) -> Array:
        """The tip with both elbows at a right angle: halfway between folded and stretched."""
        d, need = self.dimensions, Requirements()
        right = float(np.hypot(d.right_arm_length, d.right_tip_link_length))
        left = float(np.hypot(d.left_arm_length, d.left_tip_link_length))
        pivots = ((0.5 * d.pivot_distance, 0.0), (-0.5 * d.pivot_distance, 0.0))
        tip = meet_circles(*pivots, right, left, -1.0, need)
        if min(need.margins) < 0.0:
            raise ParameterError("pivot_distance_mm", d.pivot_distance, f"must be below {right + left:g} mm")
        return np.array(tip, dtype=float)

    def solve_state(self, pose: Sequence[Number], branch: tuple[float, float], require: Require) -> State:
        """Both arms for a tip at x, y [mm], their elbows on the sides (right, left) of +-1."""
        d, (x, y) = self.dimensions, pose
        half = 0.5 * d.pivot_distance

        def right(margin: Number, name: str) -> None:
            require(margin, f"right arm {name}")

        def left(margin: Number, name: str) -> None:
            require(margin, f"left arm {name}")

        return State(
            solve_dyad(x - half, y, d.right_arm_length, d.right_tip_link_length, branch[0], right),
            solve_dyad(x + half, y, d.left_arm_length, d.left_tip_link_length, branch[1], left),
        )

    def joint_values(self, state: State) -> Sequence[Number]:
        """The two arms, then elbows and tip, in the order of `build_joints`."""
        right, left = state
        return right.pivot, left.pivot, right.tip - right.pivot, left.tip - left.pivot, left.tip - right.tip

    def rate_rows(self, state: State) -> Sequence[Sequence[Number]]:
        """d(arm angles)/d(x, y) [rad/mm]."""
        d = self.dimensions
        return (
            rate_row(state.right.tip, state.right.pivot, d.right_arm_length),
            rate_row(state.left.tip, state.left.pivot, d.left_arm_length),
        )

    def body_frames(self, state: State) -> Sequence[tuple[Rot, Vec]]:
        """Base, right arm and tip link, left arm and tip link."""
        d, frames = self.dimensions, [(rot_z(0.0), Vec(0.0, 0.0, 0.0))]
        half = 0.5 * d.pivot_distance
        for x, arm, angles in ((half, d.right_arm_length, state.right), (-half, d.left_arm_length, state.left)):
            elbow = (x + arm * cos(angles.pivot), arm * sin(angles.pivot))
            frames += [link_frame(angles.pivot, x, 0.0), link_frame(angles.tip, *elbow)]
        return frames

    def locate_tip(self, active: Array, require: Requirements) -> tuple[Array, Array]:
        """Tip (x, y) [mm] beyond the elbows, for columns of arm angles [rad]."""
        d = self.dimensions
        half, a, b = 0.5 * d.pivot_distance, d.right_arm_length, d.left_arm_length
        right = (half + a * cos(active[:, 0]), a * sin(active[:, 0]))
        left = (-half + b * cos(active[:, 1]), b * sin(active[:, 1]))
        return meet_circles(right, left, d.right_tip_link_length, d.left_tip_link_length, -1.0, require)

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        d = self.dimensions
        return {
            "right_reach": (d.right_arm_length + d.right_tip_link_length, "mm", "right arm stretched"),
            "left_reach": (d.left_arm_length + d.left_tip_link_length, "mm", "left arm stretched"),
            "home_condition": (self.home_condition(), "", "condition number of the Jacobian at home"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        d = self.dimensions
        return {
            "pivot_distance": (d.pivot_distance, "mm"),
            "right_arm_length": (d.right_arm_length, "mm"),
            "right_tip_link_length": (d.right_tip_link_length, "mm"),
            "left_arm_length": (d.left_arm_length, "mm"),
            "left_tip_link_length": (d.left_tip_link_length, "mm"),
        }


def build_joints(d: Dimensions, lim: Limits) -> tuple[Joint, ...]:
    """All pins, the two driven ones first."""
    half, end = 0.5 * d.pivot_distance, (0.0, 0.0)
    right, left = (d.right_arm_length, 0.0), (d.left_arm_length, 0.0)
    tips = (d.right_tip_link_length, 0.0), (d.left_tip_link_length, 0.0)
    spans = (lim.right_arm_min, lim.right_arm_max), (lim.left_arm_min, lim.left_arm_max)
    return (
        hinge("right_drive", "base", "right_arm", (half, 0.0), end, spans[0], active=True),
        hinge("left_drive", "base", "left_arm", (-half, 0.0), end, spans[1], active=True),
        hinge("right_elbow", "right_arm", "right_tip_link", right, end, (lim.elbow_min, lim.elbow_max)),
        hinge("left_elbow", "left_arm", "left_tip_link", left, end, (-lim.elbow_max, -lim.elbow_min)),
        hinge("tip", "right_tip_link", "left_tip_link", tips[0], tips[1], (-lim.tip_max, -lim.tip_min)),
    )


class BarShop:
    """Makes the five bodies; the frame of a bar has x along it, z along the pins, and z = 0 amid the arms' layer."""

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.d: Dimensions = sections["parameters"]
        self.bars: Bars = sections["parts.bars"]
        self.supplies: Supplies = sections["supplies"]
        self.row = bearing(self.supplies.bearing)
        self.clip = clip(self.supplies.clip)
        self.thickness = 2.0 * self.row.width + self.bars.lip  # two bearings and the lip

    def bodies(self) -> tuple[Body, ...]:
        """Base, right arm and tip link, left arm and tip link."""
        d = self.d
        return (
            Body(name="base", kind="base", group="", parts=self._base()),
            *self._side("right", d.right_arm_length, d.right_tip_link_length, layer=1),
            *self._side("left", d.left_arm_length, d.left_tip_link_length, layer=2),
        )

    def _side(self, side: str, arm: float, tip_link: float, *, layer: int) -> tuple[Body, Body]:
        elbow = self._pinned("elbow", arm, self._span(0), layer)
        # The right tip link carries the tip's pin, the left one turns on it.
        tip = self._pinned("tip", tip_link, self._span(layer), layer + 1) if layer == 1 else ()
        arm_parts = (*self._bar(arm, 0, has_head_bearing=False), *elbow)
        tip_parts = (*self._bar(tip_link, layer, has_head_bearing=layer == 2), *tip)
        return (
            Body(name=f"{side}_arm", kind=f"{side}_arm", group=side, parts=arm_parts),
            Body(name=f"{side}_tip_link", kind=f"{side}_tip_link", group=side, parts=tip_parts),
        )

    def _span(self, layer: int) -> tuple[float, float]:
        """Lower and upper face of a layer [mm]; layer 0 holds the arms."""
        middle = layer * (self.thickness + self.bars.layer_gap)
        return middle - 0.5 * self.thickness, middle + 0.5 * self.thickness

    def _run(self, layer: int) -> Run:
        low, high = self._span(layer)
        return Run(low=low, high=high - self.bars.lip)

    def _bar(self, reach: float, layer: int, *, has_head_bearing: bool) -> tuple[Part, ...]:
        """A bar with bearings at its foot; at its head bearings too, or the bore for a pin."""
        (low, high), run, eye = self._span(layer), self._run(layer), self.bars.eye_diameter / 2.0

        def seat(x: float) -> Hole:
            return eye_hole(self.row, x, 0.0, run, self.bars.lip_bore, opens_up=False)

        head = seat(reach) if has_head_bearing else Hole(x=reach, top=high, diameter=self.row.bore)
        half = self.bars.width / 2.0
        slabs = (
            Slab(circles=((0.0, 0.0, half), (reach, 0.0, half)), low=low, high=high),
            Slab(circles=((0.0, 0.0, eye),), low=low, high=high),
            Slab(circles=((reach, 0.0, eye),), low=low, high=high),
        )
        feature = Milled(slabs=slabs, holes=(seat(0.0), head), edge_break=self.bars.edge_break)
        rings = outer_rings("head", self.row, reach, 0.0, run) if has_head_bearing else ()
        bar = Part(name="bar", feature=feature, material=self.supplies.bars)
        return (bar, *outer_rings("foot", self.row, 0.0, 0.0, run), *rings)

    def _pinned(self, name: str, x: float, fixed: tuple[float, float], to_layer: int) -> tuple[Part, ...]:
        """A pin pressed into its body over z = fixed, on which the bar of a layer above turns."""
        return pinned(
            name,
            self.row,
            self.clip,
            x,
            0.0,
            fixed,
            ups=(self._run(to_layer),),
            end_length=self.bars.end_length,
            material=self.supplies.pins,
        )

    def _base(self) -> tuple[Part, ...]:
        half, rim = 0.5 * self.d.pivot_distance, self.bars.base_rim
        high = self._span(0)[0] - self.bars.layer_gap
        low = high - self.bars.base_thickness
        pivots = (-half, half)
        plate = Milled(
            slabs=(Slab(circles=tuple((x, 0.0, rim) for x in pivots), low=low, high=high),),
            holes=tuple(Hole(x=x, top=high, diameter=self.row.bore) for x in pivots),
            edge_break=self.bars.edge_break,
        )
        return (
            Part(name="plate", feature=plate, material=self.supplies.bars),
            *self._pinned("left", -half, (low, high), 0),
            *self._pinned("right", half, (low, high), 0),
        )


#: What `linkwright --mechanisms` takes up: one row per mechanism, like those of the package's own catalogue.
ENTRIES: tuple[Entry, ...] = (
    Entry(
        name=AsymmetricFiveBar.name,
        title=AsymmetricFiveBar.title,
        source=AsymmetricFiveBar.source,
        sections=SECTIONS,
        task=TASK,
        workspace=Workspace(lower=(-20.0, 105.0), upper=(30.0, 145.0)),
        build=AsymmetricFiveBar,
    ),
)
