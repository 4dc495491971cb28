"""Two masts: arms on pins of one base, each with a rod on a ball at its tip. In no catalogue, but all joints real."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.catalogue import Entry
from linkwright.designs.design import Clearance, Design, Outputs, Workspace
from linkwright.designs.language.bodies import Body, Part, Placement
from linkwright.designs.language.features import Hole, Milled, Slab, Turned, Vertex
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.mechanism import Coordinate, ForwardSolution, InverseSolution, Mechanism
from linkwright.designs.language.parameters import angle, choice, length
from linkwright.designs.language.units import DEG

SIDES = (-1.0, 1.0)
TASK = (Coordinate(name="turn_1", unit="deg"), Coordinate(name="turn_2", unit="deg"))


@dataclass(frozen=True, slots=True, kw_only=True)
class MastParameters:
    half_distance: float = length(43.7, "middle to a pin")
    arm_length: float = length(61.3, "pin to ball")
    ball_height: float = length(17.0, "base's face to ball")


@dataclass(frozen=True, slots=True, kw_only=True)
class MastLimits:
    turn_max: float = angle(70.0 * DEG, "either way")
    cone_max: float = angle(33.0 * DEG, "of the ball", least=0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class MastParts:
    width: float = length(14.0, "of an arm")
    material: str = choice("aluminium_6082", "of the arms", ("aluminium_6082", "brass"))


SECTIONS = {"parameters": MastParameters, "joint_limits": MastLimits, "parts": MastParts}


def ring(inner: float, outer: float, low: float, high: float) -> Turned:
    corners = ((inner, low), (outer, low), (outer, high), (inner, high))
    return Turned(profile=tuple(Vertex(r=r, z=z) for r, z in corners))


def ball_bar(radius: float, root: float, reach: float) -> Turned:
    """A ball about the origin with a bar upwards."""
    start = math.sqrt(radius**2 - root**2)
    return Turned(
        profile=(
            Vertex(r=0.0, z=-radius),
            Vertex(r=root, z=start, mid=(radius, 0.0)),
            Vertex(r=root, z=reach),
            Vertex(r=0.0, z=reach),
        )
    )


def seat(radius: float, outer: float) -> Turned:
    """A ring about the origin, spherical inside, from half a radius below to half a radius above."""
    h = 0.5 * radius
    r = math.sqrt(radius**2 - h**2)
    return Turned(
        profile=(
            Vertex(r=outer, z=-h),
            Vertex(r=outer, z=h),
            Vertex(r=r, z=h),
            Vertex(r=r, z=-h, mid=(radius, 0.0)),
        )
    )


class Masts(Mechanism):
    name = "masts"
    title = "Two masts with rods"
    source = "none"
    task = TASK
    branches = ("plain",)
    assembly_mode = "plain"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = {key: sections.get(key, section()) for key, section in SECTIONS.items()}
        self.p: MastParameters = self.sections["parameters"]
        self.home = np.array([12.0 * DEG, -31.0 * DEG])
        self.joints = tuple(self._joints())
        self.bodies = tuple(self._bodies())

    def _joints(self):
        lim = self.sections["joint_limits"]
        for i, side in enumerate(SIDES, 1):
            yield Joint(
                name=f"turn_{i}",
                kind=JointKind.REVOLUTE,
                parent="base",
                child=f"leg_{i}_arm",
                p_parent=(side * self.p.half_distance, 0.0, 5.0),
                axis_parent=(0.0, 0.0, 1.0),
                p_child=(0.0, 0.0, 0.0),
                axis_child=(0.0, 0.0, 1.0),
                lower=-lim.turn_max,
                upper=lim.turn_max,
                is_active=True,
            )
        for i, _ in enumerate(SIDES, 1):
            yield Joint(
                name=f"ball_{i}",
                kind=JointKind.SPHERICAL,
                parent=f"leg_{i}_arm",
                child=f"leg_{i}_rod",
                p_parent=(0.0, self.p.arm_length, self.p.ball_height),
                axis_parent=(0.0, 0.0, 1.0),
                p_child=(0.0, 0.0, 0.0),
                axis_child=(0.0, 0.0, 1.0),
                lower=0.0,
                upper=lim.cone_max,
            )

    def _bodies(self):
        d = self.p.half_distance
        plate = Milled(
            slabs=(Slab(circles=((-d, 0.0, 20.0), (d, 0.0, 20.0)), low=-6.0, high=0.0),),
            holes=tuple(Hole(x=side * d, top=0.0, diameter=6.0) for side in SIDES),
        )
        pin = Turned(
            profile=(Vertex(r=0.0, z=-6.0), Vertex(r=3.0, z=-6.0), Vertex(r=3.0, z=12.0), Vertex(r=0.0, z=12.0))
        )
        pins = tuple(
            Part(
                name=f"pin_{i}",
                feature=pin,
                at=Placement(origin=(side * d, 0.0, 0.0)),
                material="steel_c45",
                runs_in_joint=True,
                fit="press",
            )
            for i, side in enumerate(SIDES, 1)
        )
        yield Body(
            name="base",
            kind="base",
            group="",
            parts=(Part(name="plate", feature=plate, material="aluminium_6082"), *pins),
        )
        own = self.sections["parts"]
        arm = Milled(
            slabs=(Slab(circles=((0.0, 0.0, own.width), (0.0, self.p.arm_length, own.width)), low=1.0, high=9.0),),
            holes=(Hole(top=9.0, diameter=10.0), Hole(y=self.p.arm_length, top=9.0, diameter=12.0)),
            edge_break=0.4,
        )
        for i, _ in enumerate(SIDES, 1):
            yield Body(
                name=f"leg_{i}_arm",
                kind="arm",
                group=f"leg_{i}",
                parts=(
                    Part(name="bar", feature=arm, at=Placement(), material=own.material),
                    Part(
                        name="bearing",
                        feature=ring(3.05, 5.0, 2.0, 6.0),
                        material="steel_100cr6",
                        purchased="MR106ZZ",
                        mass=0.0012,
                        runs_in_joint=True,
                    ),
                    Part(
                        name="seat",
                        feature=seat(5.03, 9.0),
                        material="bronze_cusn8",
                        runs_in_joint=True,
                        at=Placement(origin=(0.0, self.p.arm_length, self.p.ball_height)),
                    ),
                ),
            )
            yield Body(
                name=f"leg_{i}_rod",
                kind="rod",
                group=f"leg_{i}",
                parts=(
                    Part(
                        name="ball_bar", feature=ball_bar(5.0, 2.0, 40.0), material="steel_100cr6", runs_in_joint=True
                    ),
                ),
            )

    def solve_inverse(self, poses, branch=None):
        joints = np.concatenate([poses, np.zeros((len(poses), 2))], axis=1)
        margins = self.sections["joint_limits"].turn_max - np.abs(poses)
        return InverseSolution(
            joints=joints,
            margins=margins,
            requirements=("turn_1", "turn_2"),
            is_reachable=np.all(margins >= 0.0, axis=1),
        )

    def solve_forward(self, active, near=None):
        n = len(active)
        return ForwardSolution(
            poses=np.array(active), is_solved=np.ones(n, bool), n_candidates=np.ones(n, int), residual=np.zeros(n)
        )

    def compute_jacobian(self, poses):
        return np.broadcast_to(np.eye(2), (len(poses), 2, 2)).copy()

    def place_bodies(self, poses):
        Ts = np.broadcast_to(np.eye(4), (len(poses), 5, 4, 4)).copy()
        for i, side in enumerate(SIDES):
            c, s = np.cos(poses[:, i]), np.sin(poses[:, i])
            arm, rod = Ts[:, 1 + 2 * i], Ts[:, 2 + 2 * i]
            arm[:, 0, 0], arm[:, 0, 1], arm[:, 1, 0], arm[:, 1, 1] = c, -s, s, c
            arm[:, 0, 3] = side * self.p.half_distance
            rod[:, 0, 3] = side * self.p.half_distance - s * self.p.arm_length
            rod[:, 1, 3] = c * self.p.arm_length
            rod[:, 2, 3] = self.p.ball_height
        return Ts

    def derived_numbers(self):
        return {"span": (2.0 * self.p.half_distance, "mm", "pin to pin")}

    def controller_parameters(self):
        return {
            "half_distance": (self.p.half_distance, "mm"),
            "arm_length": (self.p.arm_length, "mm"),
            "ball_height": (self.p.ball_height, "mm"),
        }


ENTRY = Entry(
    name="masts",
    title=Masts.title,
    source=Masts.source,
    sections=SECTIONS,
    task=TASK,
    workspace=Workspace(lower=(-0.5, -0.5), upper=(0.5, 0.5)),
    build=Masts,
)


def masts_design(*, outputs: Outputs | None = None, **numbers: Any) -> Design:
    """A design with kinematic parameters of its own."""
    mechanism = Masts({"parameters": MastParameters(**numbers)})
    return Design(
        name="two_masts",
        mechanism=mechanism,
        workspace=ENTRY.workspace,
        outputs=outputs or Outputs(),
        clearance=Clearance(mesh_deviation=0.05),
    )
