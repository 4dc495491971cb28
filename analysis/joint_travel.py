"""How far one joint's child gets past its parent: both ways about or along an axis, or leaning to every side."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from linkwright.designs.language.errors import KinematicsError
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.poses import transform_points, turn_about
from linkwright.designs.language.units import DEG

from .travel import Passage, Travel

Array = np.ndarray

#: To which a contact is found: a hundredth of a degree, and a two-hundredth of a millimetre.
TURN_RESOLUTION, SLIDE_RESOLUTION = 0.01 * DEG, 0.005
#: A mechanism's own joint axes must meet within this at home [mm, and parts of a unit vector].
_CLOSURE = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class JointTravel:
    """What was measured on one joint.

    Attributes:
        travels: revolute, prismatic: down and up from home; else one per azimuth.
        azimuths: of a ball joint's leans, about the parent's axis, from the child's x at home (its y where x lies
            along its axis) [rad]; empty for other joints.
    """

    travels: tuple[Travel, ...]
    azimuths: tuple[float, ...] = ()


def measure_joint(passage: Passage, joint: Joint, T_parent_child: Array, n_azimuths: int) -> JointTravel:
    """How far one joint goes.

    Args:
        passage: of its child past its parent.
        joint: the joint.
        T_parent_child: pose of the child seen from the parent at home, shape (4, 4) [mm].
        n_azimuths: towards which a ball joint leans.
    """
    at, along = np.array(joint.p_parent), np.array(joint.axis_parent) / np.linalg.norm(joint.axis_parent)
    corners = transform_points(T_parent_child, passage.child.corners) - at
    if joint.kind is JointKind.PRISMATIC:

        def slide(sign: float) -> Callable[[float], Array]:
            return lambda way: _shift(sign * way * along) @ T_parent_child

        end = 2.0 * (passage.parent.tree.radius + passage.child.tree.radius)
        return JointTravel(
            travels=tuple(
                passage.measure(slide(s), rate=1.0, end=end, resolution=SLIDE_RESOLUTION) for s in (-1.0, 1.0)
            )
        )

    def turn(axis: Array, start: Array) -> Callable[[float], Array]:
        return lambda angle: turn_about(at, axis, angle) @ start

    if joint.kind is JointKind.REVOLUTE:
        rate = float(np.linalg.norm(np.cross(corners, along), axis=1).max()) + passage.child.deviation
        return JointTravel(
            travels=tuple(
                passage.measure(turn(s * along, T_parent_child), rate=rate, end=math.pi, resolution=TURN_RESOLUTION)
                for s in (-1.0, 1.0)
            )
        )
    start, azimuths = _aligned(joint, T_parent_child), tuple(k * math.tau / n_azimuths for k in range(n_azimuths))
    rate = float(np.linalg.norm(corners, axis=1).max()) + passage.child.deviation
    axes = [lean_axis(along, azimuth, _zero_azimuth(along, start)) for azimuth in azimuths]
    return JointTravel(
        azimuths=azimuths,
        travels=tuple(
            passage.measure(turn(axis, start), rate=rate, end=math.pi, resolution=TURN_RESOLUTION) for axis in axes
        ),
    )


def lean_axis(along: Array, azimuth: float, zero: Array) -> Array:
    """The axis about which to turn so that `along` leans towards an azimuth [rad], which counts from `zero`."""
    x = zero - np.dot(zero, along) * along
    x /= np.linalg.norm(x)
    return -math.sin(azimuth) * x + math.cos(azimuth) * np.cross(along, x)


def _zero_azimuth(along: Array, T: Array) -> Array:
    """The child's x at home, or its y where x lies along the axis, as the parent sees it."""
    return T[:3, 0] if abs(float(np.dot(along, T[:3, 0]))) < 0.9 else T[:3, 1]


def _aligned(joint: Joint, T: Array) -> Array:
    """The child's pose with its axis along the parent's, by the shortest turn from home about the ball's centre."""
    along, here = np.array(joint.axis_parent), T[:3, :3] @ np.array(joint.axis_child)
    axis = np.cross(here, along)
    if np.linalg.norm(axis) < 1e-12:
        if np.dot(here, along) > 0.0:
            return T
        axis = lean_axis(along, 0.0, _zero_azimuth(along, T))
    angle = math.atan2(float(np.linalg.norm(np.cross(here, along))), float(np.dot(here, along)))
    return turn_about(np.array(joint.p_parent), axis, angle) @ T


def _shift(p: Array) -> Array:
    T = np.eye(4)
    T[:3, 3] = p
    return T


def check_closure(joint: Joint, T_parent_child: Array) -> None:
    """Refuse a mechanism whose joints and placed bodies disagree.

    Raises:
        KinematicsError: names the joint, its bodies, and by how much they miss.
    """
    T = T_parent_child
    offset = T[:3, :3] @ np.array(joint.p_child) + T[:3, 3] - np.array(joint.p_parent)
    apart = float(np.linalg.norm(np.cross(offset, joint.axis_parent) if joint.kind is JointKind.PRISMATIC else offset))
    if apart > _CLOSURE:
        raise KinematicsError(
            f"{joint.name}: at home {joint.child} misses {joint.parent} by {apart:.4g} mm at this "
            f"joint; place_bodies and joints must agree within {_CLOSURE:g} mm"
        )
    if joint.kind in (JointKind.REVOLUTE, JointKind.PRISMATIC):
        skew = float(np.linalg.norm(T[:3, :3] @ np.array(joint.axis_child) - np.array(joint.axis_parent)))
        if skew > _CLOSURE:
            raise KinematicsError(
                f"{joint.name}: at home the axes of {joint.child} and {joint.parent} differ by "
                f"{skew:.4g} (sine); they must agree within {_CLOSURE:g}"
            )
