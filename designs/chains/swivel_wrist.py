"""The wrist at a five-bar's tip: a swivel about the host forearm, a bend across it, a turn about the hand's own axis.

Three axes through one point stand in for the ball or universal joint of the paper: around a solid pen neck no cardan
gives the bend that is needed. The hand carries a `pole`, a unit vector fixed in it that lies along the five-bar's
normal when all is straight; the swivel's frame has x along the forearm and y along the bend axis, the hub's frame has
y along the bend axis and z along the pole.

Source: Stocco, Salcudean, Sassani, section V: the roll actuator works "relative to a pantograph forearm", and the
wrist is singular when the pen aligns with a forearm (iv); the order of the axes is not printed. Used: the order that
fits both. Shown by: tests/papers/test_stocco_platforms.py.
"""

from __future__ import annotations

from typing import NamedTuple

from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, atan2

#: Least sine of the angle between pole and forearm at which the wrist counts as regular.
ALIGNED = 1e-6


class WristState(NamedTuple):
    """Axes of swivel and hub, and the three angles [rad], all zero when pole and forearm's normal are one."""

    swivel_axes: Rot
    hub_axes: Rot
    swivel: Number
    bend: Number
    turn: Number


def solve_wrist(forearm: Rot, pole: Vec, zero: Vec, require: Require) -> WristState:
    """The wrist between a forearm and the hand.

    Args:
        forearm: axes of the host forearm in the base: x along it, z along its pins.
        pole: unit vector of the hand about which it turns, in the base.
        zero: unit vector of the hand across the pole, from which the turn is measured, in the base.
        require: told "pole along the forearm".
    """
    across = pole.cross(forearm.x)
    sine = across.norm()
    require(sine - ALIGNED, "pole along the forearm")
    bend_axis = across * (1.0 / sine)
    upright, hub_x = forearm.x.cross(bend_axis), bend_axis.cross(pole)
    return WristState(
        Rot(forearm.x, bend_axis, upright),
        Rot(hub_x, bend_axis, pole),
        atan2(bend_axis.dot(forearm.z), bend_axis.dot(forearm.y)),
        atan2(pole.dot(forearm.x), pole.dot(upright)),
        atan2(zero.dot(bend_axis), zero.dot(hub_x)),
    )


def turn_rate_axis(forearm: Rot, pole: Vec) -> Vec:
    """The vector u with d(turn)/dt = u . (omega of the hand - omega of the forearm)."""
    c = pole.dot(forearm.x)
    return (pole - forearm.x * c) * (1.0 / (1.0 - c * c))
