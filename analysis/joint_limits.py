"""How far each joint goes until its two bodies touch, measured on their solids, against what the design declares.

The bodies stand as they do at home and one of them moves. A revolute or prismatic joint goes both ways. A spherical
or universal one starts with its axes aligned and leans towards each azimuth in turn, its twist kept as at home; the
smallest lean is the half angle of its cone. Only the joint's two bodies are looked at; what lies around them is for
the clearance check.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.language.errors import KinematicsError, VacuousCheckError
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.poses import invert_pose, transform_points, turn_about
from linkwright.designs.language.units import DEG
from linkwright.generator.assembly import Assembly, AssembledBody
from linkwright.generator.store import Store

from .findings import CheckResult, Finding, Severity
from .notebook import Notebook, evidence_of_body, evidence_of_joint, key_of, rounded
from .travel import Passage, Surroundings, Travel, build_passage, build_surroundings

Array = np.ndarray
Progress = Callable[[int, int, str], None]

#: To which a contact is found: a hundredth of a degree, and a two-hundredth of a millimetre.
TURN_RESOLUTION, SLIDE_RESOLUTION = 0.01 * DEG, 0.005
#: Azimuths towards which a ball joint leans.
N_AZIMUTHS = 24
#: A mechanism's own joint axes must meet within this at home [mm, and parts of a unit vector].
_CLOSURE = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class JointTravel:
    """What was measured on one joint.

    Attributes:
        travels: revolute, prismatic: down and up from home; else one per azimuth.
        azimuths: of a ball joint's leans, about the parent's axis [rad]; empty for other joints.
    """

    travels: tuple[Travel, ...]
    azimuths: tuple[float, ...] = ()


def measure_joint_limits(
    assembly: Assembly, *, store: Store | None = None, progress: Progress | None = None, n_azimuths: int = N_AZIMUTHS
) -> CheckResult:
    """The limits of every joint by its solids, and a finding for each declared limit that lies beyond.

    Args:
        assembly: of a design.
        store: measurements are kept beside its solids; None keeps nothing.
        progress: is told (done, of how many, joint) before each joint and once at the end.
        n_azimuths: towards which a ball joint leans.

    Returns:
        facts["limits"]: per joint lower, upper [rad or mm], the declared ones, whether it is unlimited (no contact
        within half a turn either way) and what stops it. facts["cones"]: per ball joint its leans by azimuth [deg].

    Raises:
        VacuousCheckError: the mechanism has no joints.
        KinematicsError: a joint's axes do not meet at home.
    """
    mechanism = assembly.design.mechanism
    if not mechanism.joints:
        raise VacuousCheckError(f"{assembly.design.name}: no joints to measure; a mechanism has at least one")
    bench = _Bench(assembly, store)
    values = mechanism.solve_inverse(mechanism.home[None]).joints[0]
    limits: dict[str, Any] = {}
    cones: dict[str, Any] = {}
    findings: list[Finding] = []
    for i, (joint, value) in enumerate(zip(mechanism.joints, values, strict=True)):
        if progress is not None:
            progress(i, len(mechanism.joints), f"turning {joint.name}")
        measured = bench.measure(joint, n_azimuths)
        limits[joint.name] = _limits_of(joint, measured, float(value), assembly)
        if measured.azimuths:
            cones[joint.name] = {"azimuths": [a / DEG for a in measured.azimuths],
                                 "tilts": [t.extent / DEG for t in measured.travels]}
        findings += _findings_of(joint, measured, limits[joint.name], bench)
    if progress is not None:
        progress(len(mechanism.joints), len(mechanism.joints), "")
    looked_at = {"joints": len(limits), "measured": bench.n_measured, "azimuths": n_azimuths * len(cones)}
    return CheckResult(check="joint-limits", looked_at=looked_at, findings=tuple(findings),
                       facts={"limits": limits, "cones": cones})


class _Bench:
    """The bodies at home, and what has been measured on them; equal joints are measured once."""

    def __init__(self, assembly: Assembly, store: Store | None) -> None:
        self.assembly = assembly
        mechanism = assembly.design.mechanism
        poses = mechanism.place_bodies(mechanism.home[None])[0]
        self.poses = dict(zip((b.name for b in mechanism.bodies), poses, strict=True))
        self._notebook = Notebook(store)
        self._seen: dict[str, Surroundings] = {}
        self.n_measured = 0

    def measure(self, joint: Joint, n_azimuths: int) -> JointTravel:
        """What was measured on this joint, or on one that equals it."""
        parent, child = self.assembly.body(joint.parent), self.assembly.body(joint.child)
        T = invert_pose(self.poses[joint.parent]) @ self.poses[joint.child]
        _check_closure(joint, T)
        key = key_of("travel", evidence_of_body(parent), evidence_of_body(child), evidence_of_joint(joint), rounded(T),
                     n_azimuths)
        facts = self._notebook.recall(key)
        if facts is None:
            self.n_measured += 1
            where = f"{self.assembly.design.name}: {joint.name}"
            passage = build_passage(self._look_at(parent), self._look_at(child), joint, where)
            facts = _facts_of(measure_joint(passage, joint, T, n_azimuths))
            self._notebook.note(key, facts)
        return _travel_of(facts)

    def _look_at(self, body: AssembledBody) -> Surroundings:
        if body.body.kind not in self._seen:
            self._seen[body.body.kind] = build_surroundings(body)
        return self._seen[body.body.kind]


def measure_joint(passage: Passage, joint: Joint, T_parent_child: Array, n_azimuths: int = N_AZIMUTHS) -> JointTravel:
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
        return JointTravel(travels=tuple(passage.measure(slide(s), rate=1.0, end=end, resolution=SLIDE_RESOLUTION)
                                         for s in (-1.0, 1.0)))

    def turn(axis: Array, start: Array) -> Callable[[float], Array]:
        return lambda angle: turn_about(at, axis, angle) @ start

    if joint.kind is JointKind.REVOLUTE:
        rate = float(np.linalg.norm(np.cross(corners, along), axis=1).max()) + passage.child.deviation
        return JointTravel(travels=tuple(passage.measure(turn(s * along, T_parent_child), rate=rate, end=math.pi,
                                                         resolution=TURN_RESOLUTION) for s in (-1.0, 1.0)))
    start, azimuths = _aligned(joint, T_parent_child), tuple(k * math.tau / n_azimuths for k in range(n_azimuths))
    rate = float(np.linalg.norm(corners, axis=1).max()) + passage.child.deviation
    axes = [lean_axis(along, azimuth) for azimuth in azimuths]
    return JointTravel(azimuths=azimuths, travels=tuple(
        passage.measure(turn(axis, start), rate=rate, end=math.pi, resolution=TURN_RESOLUTION) for axis in axes))


def lean_axis(along: Array, azimuth: float) -> Array:
    """The axis about which to turn so that `along` leans towards an azimuth [rad], which counts from the parent's x.

    From its y where `along` is its x.
    """
    x = np.array([1.0, 0.0, 0.0]) if abs(along[0]) < 0.9 else np.array([0.0, 1.0, 0.0])
    x = x - np.dot(x, along) * along
    x /= np.linalg.norm(x)
    return -math.sin(azimuth) * x + math.cos(azimuth) * np.cross(along, x)


def _aligned(joint: Joint, T: Array) -> Array:
    """The child's pose with its axis along the parent's, by the shortest turn from home about the ball's centre."""
    along, here = np.array(joint.axis_parent), T[:3, :3] @ np.array(joint.axis_child)
    axis = np.cross(here, along)
    if np.linalg.norm(axis) < 1e-12:
        if np.dot(here, along) > 0.0:
            return T
        axis = lean_axis(along, 0.0)
    angle = math.atan2(float(np.linalg.norm(np.cross(here, along))), float(np.dot(here, along)))
    return turn_about(np.array(joint.p_parent), axis, angle) @ T


def _shift(p: Array) -> Array:
    T = np.eye(4)
    T[:3, 3] = p
    return T


def _check_closure(joint: Joint, T: Array) -> None:
    apart = float(np.linalg.norm(T[:3, :3] @ np.array(joint.p_child) + T[:3, 3] - np.array(joint.p_parent)))
    if joint.kind is JointKind.PRISMATIC:
        offset = T[:3, :3] @ np.array(joint.p_child) + T[:3, 3] - np.array(joint.p_parent)
        apart = float(np.linalg.norm(np.cross(offset, joint.axis_parent)))
    if apart > _CLOSURE:
        raise KinematicsError(f"{joint.name}: at home {joint.child} misses {joint.parent} by {apart:.4g} mm at this joint; "
                              f"place_bodies and joints must agree within {_CLOSURE:g} mm")
    if joint.kind in (JointKind.REVOLUTE, JointKind.PRISMATIC):
        skew = float(np.linalg.norm(T[:3, :3] @ np.array(joint.axis_child) - np.array(joint.axis_parent)))
        if skew > _CLOSURE:
            raise KinematicsError(f"{joint.name}: at home the axes of {joint.child} and {joint.parent} differ by {skew:.4g} "
                                  f"(sine); they must agree within {_CLOSURE:g}")


def _facts_of(measured: JointTravel) -> dict[str, Any]:
    return {"azimuths": list(measured.azimuths),
            "travels": [[t.extent, t.is_stopped, list(t.parts), list(t.point)] for t in measured.travels]}


def _travel_of(facts: Mapping[str, Any]) -> JointTravel:
    return JointTravel(azimuths=tuple(facts["azimuths"]), travels=tuple(
        Travel(extent=extent, is_stopped=stopped, parts=(parts[0], parts[1]), point=(point[0], point[1], point[2]))
        for extent, stopped, parts, point in facts["travels"]))


def _limits_of(joint: Joint, measured: JointTravel, value: float, assembly: Assembly) -> dict[str, Any]:
    """The row of facts["limits"] for one joint."""
    parent, child = assembly.body(joint.parent).body, assembly.body(joint.child).body

    def stop(travel: Travel) -> str:
        if travel.parts[0] < 0:
            return ""
        return f"{parent.name}/{parent.parts[travel.parts[0]].name} - {child.name}/{child.parts[travel.parts[1]].name}"

    if measured.azimuths:
        least = min(measured.travels, key=lambda t: t.extent)
        lower, upper, stops = 0.0, least.extent, ("", stop(least))
        unlimited = not least.is_stopped
    else:
        down, up = measured.travels
        lower, upper, stops = value - down.extent, value + up.extent, (stop(down), stop(up))
        unlimited = not (down.is_stopped or up.is_stopped)
    return {"lower": lower, "upper": upper, "declared_lower": joint.lower, "declared_upper": joint.upper,
            "unit": "mm" if joint.kind is JointKind.PRISMATIC else "rad", "unlimited": unlimited,
            "stopped_below_by": stops[0], "stopped_above_by": stops[1]}


def _findings_of(joint: Joint, measured: JointTravel, limits: Mapping[str, Any], bench: _Bench) -> list[Finding]:
    unit = joint.unit
    scale = 1.0 if unit == "mm" else DEG
    ends = [("upper", min(measured.travels, key=lambda t: t.extent), 1.0)] if measured.azimuths else [
        ("lower", measured.travels[0], -1.0), ("upper", measured.travels[1], 1.0)]
    findings = []
    for end, travel, sign in ends:
        declared, found = limits[f"declared_{end}"], limits[end]
        # Without a contact nothing stops the joint, however far it is declared to go.
        if not travel.is_stopped or sign * declared <= sign * found:
            continue
        by = limits["stopped_above_by" if end == "upper" else "stopped_below_by"]
        point = transform_points(bench.poses[joint.parent], np.array(travel.point)[None])[0]
        findings.append(Finding(
            rule="joint-limit", severity=Severity.ERROR, subject=(joint.name, joint.parent, joint.child),
            message=f"{joint.name} is declared to go {'down' if sign < 0 else 'up'} to {declared / scale:.3f} {unit}, but its "
                    f"solids touch at {found / scale:.3f} {unit}" + (f" ({by})" if by else ""),
            measured=found / scale, limit=declared / scale, unit=unit,
            location=(float(point[0]), float(point[1]), float(point[2])),
            suggestion=f"declare {'at least' if sign < 0 else 'at most'} {found / scale:.2f} {unit}, or take metal away "
                       "where they touch",
        ))
    return findings
