"""Three planes on base hinges under one platform: what the paired Stewart platform and the Inoue platform share.

Base axes as in the paper: x = i to the right, y = j upwards, z = k away from the base. Leg 1 lies on +y, legs 2 and 3
at +-eta_1 from it; every hinge axis is tangential. The platform's points lie in its xy plane: one at l_6 on +y, a pair
at l_7 and +-eta_2. Each leg's driven chain places its point in the leg's plane; the three leans remain to be found.

Source: Stocco, Salcudean, Sassani, Fig. 10. Printed: l_6 and l_7 unexplained. Used: l_6 single, l_7 for the pair.
Shown by: tests/papers/test_stocco_platforms.py.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from ..language.formulas import FormulaMechanism
from ..language.forward import Candidates
from ..language.mechanism import ForwardSolution
from ..language.poses import task_from_pose
from ..language.vectors import Vec
from ..language.vocabulary import Number, Require, Requirements, cos, sin
from .triples import Triple

_PAIRS = ((0, 1), (1, 2), (2, 0))
_STEP_CAP = 0.4
_MAX_STEPS = 30

#: Least determinant of the closure (of unit vectors) in the working assembly: at 0 the platform moves with all motors
#: locked. Below 0.01 the pose is known to a hundredth of the joints' precision.
ASSEMBLY_MARGIN = 0.01

#: Leans from which the closure is searched [rad].
LEAN_STARTS = tuple(np.array(s) for s in itertools.product((0.0, -0.5, 0.5), repeat=3))


class TriadLeg(NamedTuple):
    """A leg: hinge point [mm] and axis in the base, point in the platform [mm]."""

    foot: Triple
    axis: Triple
    p_hand: Triple


def triad_legs(
    single_radius: Number,
    pair_radius: Number,
    base_angle: Number,
    single_arm: Number,
    pair_arm: Number,
    arm_angle: Number,
) -> tuple[TriadLeg, ...]:
    """Legs 1, 2, 3 from l_4, l_5 [mm], eta_1 [rad], l_6, l_7 [mm], eta_2 [rad]."""
    legs = []
    for turn, radius, arm, at in (
        (0.0, single_radius, single_arm, 0.0),
        (base_angle, pair_radius, pair_arm, arm_angle),
        (-base_angle, pair_radius, pair_arm, -arm_angle),
    ):
        s, c = sin(turn), cos(turn)
        legs.append(TriadLeg((radius * s, radius * c, 0.0), (c, -s, 0.0), (arm * sin(at), arm * cos(at), 0.0)))
    return tuple(legs)


def assembly_margin(points: Sequence[Vec], swings: Sequence[Vec]) -> Number:
    """Determinant of the closure's derivative by unit edges and unit swing directions; above 0 in the working mode.

    Args:
        points: the platform's three points in the base [mm].
        swings: unit direction in which each moves when its leg's hinge turns.
    """
    edges = [points[b] - points[a] for a, b in _PAIRS]
    units = [edge * (1.0 / edge.norm()) for edge in edges]
    forward, back = 1.0, 1.0
    for (a, b), edge in zip(_PAIRS, units, strict=True):
        forward, back = forward * edge.dot(swings[a]), back * edge.dot(swings[b])
    return forward - back


def close_triad(
    legs: Sequence[TriadLeg], along: np.ndarray, radius: np.ndarray, starts: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Newton on the leans: the three points keep the platform's distances.

    Args:
        legs: hinges and platform points.
        along, radius: each point along its hinge axis and from it [mm], shape (n, 3).
        starts: leans to start from [rad], shape (n, 3).

    Returns:
        points (n, 3, 3) in the base [mm]; residual (n,): largest misfit of a distance [mm].
    """
    sides = np.array([math.dist(legs[a].p_hand, legs[b].p_hand) for a, b in _PAIRS])
    leans = np.array(starts, dtype=float)
    open_ = np.arange(len(leans))
    for _ in range(_MAX_STEPS):
        f, A = _closure(*_swing(legs, along[open_], radius[open_], leans[open_]), sides)
        step = _solve3(A, f)
        step = np.clip(np.where(np.isfinite(step), step, 0.1), -_STEP_CAP, _STEP_CAP)
        leans[open_] -= step
        # A step below the rounding of a lean: this set has closed.
        open_ = open_[np.max(np.abs(step), axis=-1) > 1e-15]
        if len(open_) == 0:
            break
    points, slopes = _swing(legs, along, radius, leans)
    f, _ = _closure(points, slopes, sides)
    return points, np.max(np.abs(f) / (2.0 * sides), axis=-1)


def _swing(
    legs: Sequence[TriadLeg], along: np.ndarray, radius: np.ndarray, leans: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    points, slopes = np.empty((*leans.shape, 3)), np.empty((*leans.shape, 3))
    up = np.array([0.0, 0.0, 1.0])
    for i, leg in enumerate(legs):
        axis = np.array(leg.axis)
        out = np.cross(up, axis)
        s, c, r = np.sin(leans[:, i, None]), np.cos(leans[:, i, None]), radius[:, i, None]
        points[:, i] = np.array(leg.foot) + along[:, i, None] * axis + r * (c * up - s * out)
        slopes[:, i] = -r * (s * up + c * out)
    return points, slopes


def _closure(points: np.ndarray, slopes: np.ndarray, sides: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    f, A = np.empty(points.shape[:2]), np.zeros(points.shape)
    for k, (a, b) in enumerate(_PAIRS):
        apart = points[:, a] - points[:, b]
        f[:, k] = np.einsum("ni,ni->n", apart, apart) - sides[k] ** 2
        A[:, k, a] = 2.0 * np.einsum("ni,ni->n", apart, slopes[:, a])
        A[:, k, b] = -2.0 * np.einsum("ni,ni->n", apart, slopes[:, b])
    return f, A


def _solve3(A: np.ndarray, f: np.ndarray) -> np.ndarray:
    """X with A x = f by cofactors; not finite where A is singular."""
    c0, c1, c2 = np.cross(A[:, 1], A[:, 2]), np.cross(A[:, 2], A[:, 0]), np.cross(A[:, 0], A[:, 1])
    with np.errstate(divide="ignore", invalid="ignore"):
        return (c0 * f[:, :1] + c1 * f[:, 1:2] + c2 * f[:, 2:3]) / np.einsum("ni,ni->n", A[:, 0], c0)[:, None]


def platform_pose(legs: Sequence[TriadLeg], points: np.ndarray) -> np.ndarray:
    """T_base_platform, shape (n, 4, 4), from the three points in the base (n, 3, 3) [mm]."""
    own = np.array([leg.p_hand for leg in legs])
    F_own, F = _triangle(own[None])[0], _triangle(points)
    T = np.zeros((len(points), 4, 4))
    T[:, :3, :3] = F @ F_own.T
    T[:, :3, 3] = points.mean(axis=1) - np.einsum("nij,j->ni", T[:, :3, :3], own.mean(axis=0))
    T[:, 3, 3] = 1.0
    return T


def _triangle(points: np.ndarray) -> np.ndarray:
    x = points[:, 0] - 0.5 * (points[:, 1] + points[:, 2])
    x = x / np.linalg.norm(x, axis=-1, keepdims=True)
    y = points[:, 1] - points[:, 2]
    y = y - np.einsum("ni,ni->n", x, y)[:, None] * x
    y = y / np.linalg.norm(y, axis=-1, keepdims=True)
    return np.stack([x, y, np.cross(x, y)], axis=-1)


def solve_triad(
    mechanism: FormulaMechanism,
    legs: Sequence[TriadLeg],
    active: np.ndarray,
    locate: Callable[[tuple[np.ndarray, ...], Require], tuple[Sequence[np.ndarray], Sequence[np.ndarray]]],
    leans: Callable[[np.ndarray], np.ndarray],
    rest_radius: float,
    near: np.ndarray | None,
) -> ForwardSolution:
    """Poses for six driven values: every leg's chain places its point on a circle, Newton closes the three circles.

    Args:
        mechanism: whose inverse a pose must return to; gives home.
        legs: hinges and platform points.
        active: driven values, shape (n, 6) [rad or mm].
        locate: points along their hinges and their radii [mm] from the six columns.
        leans: leans of the three points at poses (n, 6), shape (n, 3) [rad].
        rest_radius: stands for the radius where a leg's chain does not close [mm].
        near: expected poses (n, 6), or None; when more than one legal pose is found, the nearest is the answer.
    """
    active = np.atleast_2d(np.asarray(active, dtype=float))
    n, need = len(active), Requirements()
    finite = np.all(np.isfinite(active), axis=-1)
    given = np.where(finite[:, None], active, 0.0)
    with np.errstate(all="ignore"):
        along, radius = locate(tuple(given.T), need)
    closed = finite & np.all(need.stacked((n,)) >= 0.0, axis=-1)
    candidates = Candidates(n, mechanism.home, near)

    def offer(Ts: np.ndarray, residual: np.ndarray) -> None:
        poses = task_from_pose(Ts)
        inverse = mechanism.solve_inverse(poses)
        back = np.max(np.abs(inverse.joints[:, :6] - given), axis=-1)
        candidates.offer(poses, closed & (residual < 1e-9) & inverse.is_reachable & (back < 1e-6), residual)

    search_triad(
        legs,
        np.where(closed[:, None], np.stack(along, axis=-1), 0.0),
        np.where(closed[:, None], np.stack(radius, axis=-1), rest_radius),
        offer,
        None if candidates.near is None else leans(candidates.near),
    )
    return candidates.solution()


def search_triad(
    legs: Sequence[TriadLeg],
    along: np.ndarray,
    radius: np.ndarray,
    offer: Callable[[np.ndarray, np.ndarray], None],
    first: np.ndarray | None = None,
) -> None:
    """Offer the platform poses (n, 4, 4) and residuals [mm] (n,) that Newton finds from every start (and `first`)."""
    starts = [np.tile(start, (len(along), 1)) for start in LEAN_STARTS]
    for start in starts if first is None else [first, *starts]:
        points, residual = close_triad(legs, along, radius, start)
        with np.errstate(all="ignore"):
            Ts = platform_pose(legs, points)
        good = np.all(np.isfinite(Ts), axis=(1, 2))
        offer(np.where(good[:, None, None], Ts, np.eye(4)), np.where(good, residual, np.inf))
