"""The five-bar on a waist hinge: two driven upper arms, two forearms that meet in a tip, the whole plane on a hinge.

Frame of the chain at rest, seen from the base: origin in the waist point, x along the waist axis, z away from the base.
The waist turns the plane about x; `radial` is its z. Angles in the plane are measured from x towards radial, so they
turn right-handed about `normal` = x cross radial. Every link has x along itself and z along the normal.

Source: Stocco, Salcudean, Sassani, Fig. 11; the paper prints no kinematic equation.
"""

from __future__ import annotations

from typing import NamedTuple

from ..language.errors import UnknownNameError
from ..language.vectors import Rot, Vec, rot_x
from ..language.vocabulary import Number, Require, acos, atan2, cos, fabs, hypot, sin, sqrt

#: Least distance [mm] from stretched, folded and on the waist axis at which the chain still counts as reachable.
REACH_MARGIN = 1e-6

#: Elbow signs (left, right): +1 with the elbow on its own side of the tip.
ELBOWS: dict[str, tuple[float, float]] = {
    "out": (1.0, 1.0),
    "in": (-1.0, -1.0),
    "left": (1.0, -1.0),
    "right": (-1.0, 1.0),
}


def read_elbows(branch: str | None, known: tuple[str, ...], n_arms: int) -> tuple[tuple[float, float], ...]:
    """Elbow signs of all arms from one name for all, or one per arm joined by /; None is the working branch.

    Raises:
        UnknownNameError: lists the branches.
    """
    names = (branch or known[0]).split("/")
    names = names * n_arms if len(names) == 1 else names
    for name in names:
        if name not in ELBOWS:
            raise UnknownNameError("branch", name, known)
    if len(names) != n_arms:
        raise UnknownNameError("branch", branch or "", (*known, f"{n_arms} of these joined by /"))
    return tuple(ELBOWS[name] for name in names)


class FiveBarLinks(NamedTuple):
    """Lengths [mm]: half the distance of the shoulders l_1, upper arm l_2, forearm l_3."""

    half_spacing: float
    upper_arm: float
    forearm: float


class Side(NamedTuple):
    """One side of the chain: directions of its upper arm and forearm in the plane [rad]."""

    upper_arm: Number
    forearm: Number


class FiveBarState(NamedTuple):
    """The chain at a tip: tip [mm], axes of the waist body, hinge angle [rad], tip in the plane [mm], both sides."""

    tip: Vec
    axes: Rot
    waist: Number
    x: Number
    radius: Number
    left: Side
    right: Side

    @property
    def normal(self) -> Vec:
        """Axis of all pins of the plane."""
        return -self.axes.y

    def direction(self, angle: Number) -> Vec:
        """The unit vector at an angle in the plane."""
        return self.axes.x * cos(angle) + self.axes.z * sin(angle)

    def link_axes(self, angle: Number) -> Rot:
        """Axes of a link at an angle in the plane: x along it, z along the pins."""
        return Rot(self.direction(angle), self.axes.z * cos(angle) - self.axes.x * sin(angle), self.normal)


def solve_hinged_five_bar(
    tip: Vec, foot: Vec, still: Rot, links: FiveBarLinks, elbows: tuple[float, float], require: Require
) -> FiveBarState:
    """Hinge and link directions for a tip.

    Args:
        tip, foot: tip and waist point in the base [mm].
        still: axes of the chain at rest in the base.
        links: its lengths.
        elbows: signs of `ELBOWS`.
        require: told "on the waist axis", "left/right stretched", "left/right folded" and, with both elbows out,
            "forearms in line": the tip must stay beyond the line of the elbows.

    Source: Stocco et al., section V; the text's rules l_1 > l_2 and l_3 > l_1 + l_2 hold when l_1 is half the spacing.
    """
    local = still.inverse_apply(tip - foot)
    radius = hypot(local.y, local.z)
    require(radius - REACH_MARGIN, "on the waist axis")
    waist = atan2(-local.y, local.z)
    left, right = (
        _solve_side(local.x, radius, side, links, elbow, name, require)
        for side, elbow, name in ((-1.0, elbows[0], "left"), (1.0, elbows[1], "right"))
    )
    if elbows == ELBOWS["out"]:
        require(sin(right.forearm - left.forearm) - 1e-9, "forearms in line")
    axes = still @ rot_x(waist)
    assert isinstance(axes, Rot)
    return FiveBarState(tip, axes, waist, local.x, radius, left, right)


def _solve_side(
    x: Number, radius: Number, side: float, links: FiveBarLinks, elbow: float, name: str, require: Require
) -> Side:
    """Cosine law in the triangle shoulder, elbow, tip; `side` is -1 left, +1 right."""
    upper, fore = links.upper_arm, links.forearm
    reach_x = x - side * links.half_spacing
    reach = hypot(reach_x, radius)
    require(upper + fore - reach - REACH_MARGIN, f"{name} stretched")
    require(reach - fabs(upper - fore) - REACH_MARGIN, f"{name} folded")
    bend = acos((upper * upper + reach * reach - fore * fore) / (2.0 * upper * reach))
    q = atan2(radius, reach_x) - side * elbow * bend
    return Side(q, atan2(radius - upper * sin(q), reach_x - upper * cos(q)))


def locate_hinged_tip(
    left: Number, right: Number, links: FiveBarLinks, require: Require
) -> tuple[Number, Number, Side, Side]:
    """Tip (x, radius) [mm] and both sides from the two driven directions [rad]; the tip lies beyond the elbows.

    Told "closed": the forearms must reach each other.
    """
    l_1, l_2, l_3 = links
    across_x, across_r = 2.0 * l_1 + l_2 * (cos(right) - cos(left)), l_2 * (sin(right) - sin(left))
    gap = hypot(across_x, across_r)
    require(2.0 * l_3 - gap - REACH_MARGIN, "closed")
    require(gap - REACH_MARGIN, "elbows apart")
    height = sqrt(l_3 * l_3 - 0.25 * gap * gap) / gap
    elbow_x, elbow_r = l_2 * cos(left) - l_1, l_2 * sin(left)
    fore_x, fore_r = 0.5 * across_x - height * across_r, 0.5 * across_r + height * across_x
    return (
        elbow_x + fore_x,
        elbow_r + fore_r,
        Side(left, atan2(fore_r, fore_x)),
        Side(right, atan2(fore_r - across_r, fore_x - across_x)),
    )


def shoulder_rates(state: FiveBarState, links: FiveBarLinks) -> tuple[Vec, Vec]:
    """d(left, right upper arm)/d(tip) [rad/mm]: the forearm's line over the upper arm's lever."""
    return (_rate(state, state.left, links), _rate(state, state.right, links))


def _rate(state: FiveBarState, side: Side, links: FiveBarLinks) -> Vec:
    return state.direction(side.forearm) * (1.0 / (links.upper_arm * sin(side.forearm - side.upper_arm)))


def waist_rate(state: FiveBarState) -> Vec:
    """d(waist)/d(tip) [rad/mm]."""
    return state.normal * (1.0 / state.radius)


def forearm_rate(state: FiveBarState, side: Side, links: FiveBarLinks) -> Vec:
    """d(direction of a forearm in the plane)/d(tip) [rad/mm]."""
    across = state.link_axes(side.forearm).y
    lever = links.upper_arm * cos(side.forearm - side.upper_arm)
    return (across - _rate(state, side, links) * lever) * (1.0 / links.forearm)


def five_bar_values(state: FiveBarState) -> tuple[Number, ...]:
    """Passive values in the plane: elbow left, elbow right, tip pin (right forearm against left)."""
    left, right = state.left, state.right
    return left.forearm - left.upper_arm, right.forearm - right.upper_arm, right.forearm - left.forearm


def five_bar_frames(state: FiveBarState, foot: Vec, links: FiveBarLinks) -> list[tuple[Rot, Vec]]:
    """Waist body (origin in the waist point), upper arms (in the shoulders), forearms (in the elbows)."""
    uppers, fores = [], []
    for side, sign in ((state.left, -1.0), (state.right, 1.0)):
        shoulder = foot + state.axes.x * (sign * links.half_spacing)
        uppers.append((state.link_axes(side.upper_arm), shoulder))
        fores.append((state.link_axes(side.forearm), shoulder + state.direction(side.upper_arm) * links.upper_arm))
    return [(state.axes, foot), *uppers, *fores]
