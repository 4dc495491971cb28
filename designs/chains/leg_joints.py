"""Joints of a leg whose bodies lie in one plane: pins between its links, and the pin that carries the plane."""

from __future__ import annotations

import math

from ..language.joints import Joint, JointKind, Point

AXIS_X: Point = (1.0, 0.0, 0.0)
AXIS_Y: Point = (0.0, 1.0, 0.0)
AXIS_Z: Point = (0.0, 0.0, 1.0)
ORIGIN: Point = (0.0, 0.0, 0.0)


def leg_hinge(
    leg: str,
    name: str,
    parent: str,
    child: str,
    at: Point,
    to: Point,
    span: tuple[float, float],
    *,
    axis: Point = AXIS_Z,
    to_axis: Point | None = None,
    active: bool = False,
) -> Joint:
    """A pin of a leg; bodies and joint are named after the leg, except the base and the platform.

    Args:
        leg, name: the joint is `<leg>_<name>`.
        parent, child: bodies, without the leg.
        at, to: points of the pin in the parent's and the child's frame [mm].
        span: limits [rad].
        axis, to_axis: its direction in both frames; `to_axis` is `axis` if not given.
        active: driven by a motor.
    """
    return Joint(
        name=f"{leg}_{name}",
        kind=JointKind.REVOLUTE,
        parent=_full(leg, parent),
        child=_full(leg, child),
        p_parent=at,
        axis_parent=axis,
        p_child=to,
        axis_child=axis if to_axis is None else to_axis,
        lower=span[0],
        upper=span[1],
        is_active=active,
    )


def base_pin(leg: str, delta: float, base_radius: float, lean_max: float) -> Joint:
    """The pin at C_i, tangential, on which the leg's frame (y along the pin) leans by up to `lean_max` [rad]."""
    c, s = math.cos(delta), math.sin(delta)
    at = (base_radius * c, base_radius * s, 0.0)
    return leg_hinge(leg, "pin", "base", "frame", at, ORIGIN, (-lean_max, lean_max), axis=(-s, c, 0.0), to_axis=AXIS_Y)


def _full(leg: str, body: str) -> str:
    return body if body in ("base", "platform") else f"{leg}_{body}"
