"""The kinematics of PATHOS-II, written once over any number: floats, batches, later nodes and intervals.

Legs 1-3 stand on the lower base plate, legs 4-6 hang from the upper one, which is the lower one turned by 180 degrees
about X; so leg 4 faces leg 1, leg 5 faces leg 3, leg 6 faces leg 2. The platform's frame lies midway between its two
plates, z along the grip, x towards the globular joints 1 and 4.

Source: Kim, Chung: Design and Analysis of a New 7-DOF Parallel Type Haptic Device: PATHOS-II.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence
from typing import NamedTuple

from ..language.vectors import Rot, Vec, rot_fixed_xyz, rot_x, rot_y, rot_z
from ..language.vocabulary import Number, Require, atan2, cos, fabs, hypot, sin, sqrt
from .parameters import PathosParameters

N_LEGS = 6

#: theta_b2 = theta_p of the six legs.
TURNS = tuple(2.0 * math.pi * k / 3.0 for k in (0, 1, 2)) * 2

#: +1 on the lower base plate (theta_b1 = 0), -1 on the upper one (theta_b1 = 180 degrees).
SIDES = (1.0, 1.0, 1.0, -1.0, -1.0, -1.0)

#: Least distance [mm] from stretched, folded and aligned legs at which a pose still counts as reachable.
REACH_MARGIN = 1e-6

#: The side of a leg to which its elbow leans, seen from above, as the direction of turning about Z.
BRANCHES: dict[str, float] = {"counter-clockwise": 1.0, "clockwise": -1.0}


class LegState(NamedTuple):
    """One leg at a pose.

    Attributes:
        foot: motor's axis in the base plate [mm]; motor: its frame B_i before turning.
        links: axes of the three links; ring, fork: of the two inner bodies of the globular joint.
        hip, elbow, globe: points on R2, R3 and the globular joint's centre [mm].
        arm: platform's origin to the globular joint [mm].
        angles: theta_1 .. theta_6 [rad].
    """

    foot: Vec
    motor: Rot
    links: tuple[Rot, Rot, Rot]
    ring: Rot
    fork: Rot
    hip: Vec
    elbow: Vec
    globe: Vec
    arm: Vec
    angles: tuple[Number, Number, Number, Number, Number, Number]


class PathosState(NamedTuple):
    """The device at a pose; h_0 [mm] is half the distance of the top plates."""

    origin: Vec
    Q: Rot
    h_0: Number
    legs: tuple[LegState, ...]


def turned_side(side: float) -> Rot:
    """Rx(theta_b1), exactly."""
    return Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, side, 0.0), Vec(0.0, 0.0, side))


def product(*turns: Rot) -> Rot:
    """The product of rotations, left to right."""
    result = turns[0]
    for turn in turns[1:]:
        result = Rot(result.apply(turn.x), result.apply(turn.y), result.apply(turn.z))
    return result


def motor_frame(p: PathosParameters, leg: int) -> tuple[Rot, Vec]:
    """B_i: axes with z along the motor, and the point where that axis meets the base plate [mm].

    Source: Kim, Chung, eq. (1), first brace; L is 0 below and l_0 above.
    """
    plate = product(turned_side(SIDES[leg]), rot_z(TURNS[leg]))
    tilted = product(plate, rot_y(p.motor_tilt))
    lift = Vec(0.0, 0.0, 0.0 if SIDES[leg] > 0.0 else p.base_distance)
    return tilted, lift + plate.z * p.shift_up + tilted.x * p.shift_along


def globe_in_platform(p: PathosParameters, h_0: Number, leg: int) -> tuple[Rot, Vec]:
    """P_i: axes of the globular joint's last link and its centre in the platform's frame [mm].

    Source: Kim, Chung, eq. (1), last brace.
    """
    side, turn = turned_side(SIDES[leg]), rot_z(TURNS[leg])
    axes = product(side, turn, rot_y(p.globular_tilt))
    return axes, side.apply(turn.apply(Vec(p.plate_radius, 0.0, 0.0)) + Vec(0.0, 0.0, -h_0))


def solve_state(p: PathosParameters, pose: Sequence[Number], branch: Sequence[float], require: Require) -> PathosState:
    """All legs at a pose x, y, z [mm], rx, ry, rz [rad], h_0 [mm], each with its elbow on a side of +-1 (BRANCHES)."""
    x, y, z, rx, ry, rz, h_0 = pose
    origin, Q = Vec(x, y, z), rot_fixed_xyz(rx, ry, rz)
    legs = []
    for i, sense in enumerate(branch):

        def need(margin: Number, name: str, leg: str = f"leg_{i + 1}") -> None:
            require(margin, f"{leg} {name}")

        legs.append(_solve_leg(p, i, origin, Q, h_0, sense, need))
    return PathosState(origin, Q, h_0, tuple(legs))


def _solve_leg(
    p: PathosParameters, i: int, origin: Vec, Q: Rot, h_0: Number, sense: float, require: Require
) -> LegState:
    motor, foot = motor_frame(p, i)
    last, centre = globe_in_platform(p, h_0, i)
    arm = Q.apply(centre)
    globe = origin + arm
    t1, t2, t3 = solve_dyad(p, motor.inverse_apply(globe - foot), -sense * SIDES[i], require)
    first = product(motor, rot_z(t1))
    second = product(first, rot_y(t2))
    third = product(second, rot_x(t3))
    t4, t5, t6 = solve_globe(third, product(Q, last))
    ring = product(third, rot_z(t4))
    hip = foot + first.z * p.lower_link_length
    return LegState(
        foot=foot,
        motor=motor,
        links=(first, second, third),
        ring=ring,
        fork=product(ring, rot_y(t5)),
        hip=hip,
        elbow=hip + second.z * p.middle_link_length,
        globe=globe,
        arm=arm,
        angles=(t1, t2, t3, t4, t5, t6),
    )


def solve_dyad(p: PathosParameters, a: Vec, s_y: float, require: Require) -> tuple[Number, Number, Number]:
    """theta_1, theta_2, theta_3 [rad] that carry the globular joint to a, seen from B_i [mm].

    Args:
        p: the dimensions.
        a: the globular joint's centre in the motor's frame [mm].
        s_y: sign of c_1y. That of c_1x is -1: the pairs (s_x, s_y) and (-s_x, -s_y) are the same points of the leg.
        require: told "stretched", "folded" and "reaches its motor's axis", all in mm.

    Source: Kim, Chung, eqs. (8)-(14). Printed: (4) with theta_3 for theta_2; (14) with a_z^2 in c_1x, and two signs for
    c_1y and c_2y, which are one number. Used: (4) with theta_2; c_1x^2 = a_x^2 + a_y^2 - c_1y^2.
    Shown by: tests/papers/test_kim_chung_pathos2.py.
    """
    l_1, l_2, l_3 = p.lower_link_length, p.middle_link_length, p.upper_link_length
    rho2, up = a.x * a.x + a.y * a.y, a.z - l_1
    c_2z = (l_2 * l_2 - l_3 * l_3 + rho2 + up * up) / (2.0 * l_2)
    require(l_2 + l_3 - c_2z - REACH_MARGIN, "stretched")
    require(c_2z - (l_2 - l_3) - REACH_MARGIN, "folded")
    c_1y = s_y * sqrt(l_3 * l_3 - (c_2z - l_2) * (c_2z - l_2))
    require(sqrt(rho2) - fabs(c_1y) - REACH_MARGIN, "too near its motor's axis")
    c_1x = -sqrt(rho2 - c_1y * c_1y)
    return (
        atan2(c_1x * a.y - c_1y * a.x, c_1x * a.x + c_1y * a.y),
        atan2(c_2z * c_1x, c_2z * up),
        atan2(-c_1y, c_2z - l_2),
    )


def solve_globe(third: Rot, last: Rot) -> tuple[Number, Number, Number]:
    """theta_4, theta_5, theta_6 [rad], turns about Z, Y, Z between the upper link and the plate's side of the joint.

    theta_5 lies between 0 and 180 degrees; the joint is singular at both.

    Source: Kim, Chung, eqs. (15)-(18). Printed: Rx(theta_6) in (1). Used: Rz(theta_6), as in (15).
    Shown by: tests/papers/test_kim_chung_pathos2.py.
    """
    b = Rot(third.inverse_apply(last.x), third.inverse_apply(last.y), third.inverse_apply(last.z))
    t4 = atan2(b.z.y, b.z.x)
    c, s = cos(t4), sin(t4)
    return t4, atan2(b.z.x * c + b.z.y * s, b.z.z), atan2(b.x.y * c - b.x.x * s, b.y.y * c - b.y.x * s)


def joint_values(state: PathosState) -> tuple[Number, ...]:
    """Values of all joints in the order of `joints.build_joints`: six motors, the gap, then the rest leg by leg."""
    motors = [leg.angles[0] for leg in state.legs]
    return (*motors, 2.0 * state.h_0, *(value for leg in state.legs for value in leg.angles[1:]))


def force_rows(state: PathosState) -> list[tuple[Vec, Vec, Number]]:
    """Per leg the force that its motor alone can give to the plate: direction, moment about the origin [mm], grip part.

    The force through the globular joint that R2 and R3 cannot feel meets both their axes: it lies along the upper link.
    With the twist [v; omega] and dh_0/dt it does the power n.v + (arm x n).omega + grip dh_0/dt.
    """
    rows = []
    for side, leg in zip(SIDES, state.legs, strict=True):
        n = leg.links[2].z
        rows.append((n, leg.arm.cross(n), -side * n.dot(state.Q.z)))
    return rows


def motor_lever(leg: LegState) -> Number:
    """The motor's lever [mm] on the force along the upper link; 0 at the reach limits (serial singularity)."""
    return leg.links[2].z.dot(leg.motor.z.cross(leg.globe - leg.foot))


def rate_rows(state: PathosState) -> tuple[tuple[Number, ...], ...]:
    """Rows of the inverse Jacobian: rates of six motors and of the gap from [v; omega; dh_0/dt].

    Source: Kim, Chung, eq. (22), inverted; the paper prints no elements.
    """
    rows: list[tuple[Number, ...]] = []
    for leg, (n, moment, grip) in zip(state.legs, force_rows(state), strict=True):
        w = 1.0 / motor_lever(leg)
        rows.append((*(n * w), *(moment * w), grip * w))
    return (*rows, (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 2.0))


def parallel_measure(p: PathosParameters, state: PathosState) -> Number:
    """Determinant of the six unit forces and their moments; 0 at a parallel singularity with the grip locked.

    Moments count per arm of a globular joint at home, so that it has no unit. Positive in the working assembly.
    By Laplace's rule over the triples of rows: forces of one triple times moments of the other.
    """
    rows, arm = force_rows(state), hypot(p.plate_radius, p.home_grip)
    total: Number = 0.0
    for triple in itertools.combinations(range(N_LEGS), 3):
        rest = [k for k in range(N_LEGS) if k not in triple]
        force = [rows[k][0] for k in triple]
        moment = [rows[k][1] for k in rest]
        sign = -1.0 if (sum(triple) - 3) % 2 else 1.0
        total = total + sign * force[0].dot(force[1].cross(force[2])) * moment[0].dot(moment[1].cross(moment[2]))
    return total / (arm * arm * arm)


def body_frames(state: PathosState) -> tuple[tuple[Rot, Vec], ...]:
    """Axes and origins of base, five bodies a leg, lower and upper plate.

    A link's z runs along it; a plate's z looks towards the other plate.
    """
    still = Rot(Vec(1.0, 0.0, 0.0), Vec(0.0, 1.0, 0.0), Vec(0.0, 0.0, 1.0))
    frames = [(still, Vec(0.0, 0.0, 0.0))]
    for leg in state.legs:
        first, second, third = leg.links
        frames += [(first, leg.foot), (second, leg.hip), (third, leg.elbow), (leg.ring, leg.globe)]
        frames.append((leg.fork, leg.globe))
    reach = state.Q.z * state.h_0
    lower = (state.Q, state.origin - reach)
    upper = (product(state.Q, turned_side(-1.0)), state.origin + reach)
    return (*frames, lower, upper)
