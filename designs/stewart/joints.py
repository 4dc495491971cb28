"""Joints and bodies of the paired Stewart platform: per pair a hinge, two stages, two slides, a scissor pin, a ball."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..chains.hinged_triad import TriadLeg
from ..chains.triples import point
from ..language.bodies import Body
from ..language.joints import Joint, JointKind, Point
from ..language.vectors import Vec
from .parameters import StewartLimits, StewartParameters

BODY_NAMES = ("waist", "stage_left", "stage_right", "rod_left", "rod_right")

_X: Point = (1.0, 0.0, 0.0)
_Z: Point = (0.0, 0.0, 1.0)
_ORIGIN: Point = (0.0, 0.0, 0.0)


def build_joints(
    p: StewartParameters, limits: StewartLimits, legs: Sequence[TriadLeg], sockets: Sequence[tuple[Vec, Vec]]
) -> tuple[Joint, ...]:
    """All joints, the six slides first, pair by pair; a slide's value is gimbal to scissor pin."""
    pairs = [
        _pair_joints(f"leg_{i + 1}", p, limits, leg, socket)
        for i, (leg, socket) in enumerate(zip(legs, sockets, strict=True))
    ]
    return (
        *(j for pair in pairs for j in pair if j.is_active),
        *(j for pair in pairs for j in pair if not j.is_active),
    )


def _pair_joints(
    name: str, p: StewartParameters, lim: StewartLimits, leg: TriadLeg, socket: tuple[Vec, Vec]
) -> tuple[Joint, ...]:
    square, normal = math.pi / 2.0, (0.0, -1.0, 0.0)
    stage = (square - lim.stage_max, square + lim.stage_max)

    def joint(
        what: str,
        kind: JointKind,
        parent: str,
        child: str,
        span: tuple[float, float],
        at: Point = _ORIGIN,
        axis: Point = _Z,
        to: Point = _ORIGIN,
        to_axis: Point = _Z,
    ) -> Joint:
        return Joint(
            name=f"{name}_{what}",
            kind=kind,
            parent=parent if parent == "base" else f"{name}_{parent}",
            child=child if child == "platform" else f"{name}_{child}",
            p_parent=at,
            axis_parent=axis,
            p_child=to,
            axis_child=to_axis,
            lower=span[0],
            upper=span[1],
            is_active=kind is JointKind.PRISMATIC,
        )

    turn, slide, span = JointKind.REVOLUTE, JointKind.PRISMATIC, (lim.length_min, lim.length_max)
    l_1 = p.pair_half_spacing
    return (
        joint("slide_left", slide, "stage_left", "rod_left", span, axis=_X, to_axis=_X),
        joint("slide_right", slide, "stage_right", "rod_right", span, axis=_X, to_axis=_X),
        joint(
            "waist",
            turn,
            "base",
            "waist",
            (-lim.waist_max, lim.waist_max),
            point(leg.foot),
            point(leg.axis),
            _ORIGIN,
            _X,
        ),
        joint("stage_left", turn, "waist", "stage_left", stage, (-l_1, 0.0, 0.0), normal),
        joint("stage_right", turn, "waist", "stage_right", stage, (l_1, 0.0, 0.0), normal),
        joint("scissor", turn, "rod_left", "rod_right", (lim.scissor_min, lim.scissor_max)),
        joint(
            "ball",
            JointKind.SPHERICAL,
            "rod_left",
            "platform",
            (0.0, lim.cone_max),
            (0.0, 0.0, p.ball_offset),
            point(socket[0]),
            point(leg.p_hand),
            point(socket[1]),
        ),
    )


def build_bodies() -> tuple[Body, ...]:
    """Base, five bodies a pair, platform; left and right stages are mirror images, rods differ at the scissor pin."""
    links = [
        Body(name=f"leg_{i}_{name}", kind=name, group=f"leg_{i}", parts=()) for i in (1, 2, 3) for name in BODY_NAMES
    ]
    return (
        Body(name="base", kind="base", group="", parts=()),
        *links,
        Body(name="platform", kind="platform", group="", parts=()),
    )
