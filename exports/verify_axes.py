"""Whether config and CAD file describe one machine: joints predicted by the one, found in the faces of the other."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from linkwright.analysis.findings import CheckResult, Finding, Severity
from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.mechanism import Mechanism

from .reread import RecoveredBody

DISTANCE_MM = 1e-6
DIRECTION_RAD = 1e-9

#: A face this near to a joint is meant to lie on it; one that lies farther off is another face. Fits and eccentric
#: parts are cut on purpose by more than this, and nothing is displaced by so much and still fits.
_CAPTURE_MM = 0.25
_CAPTURE_RAD = 5e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class _Line:
    """A joint in the base frame: a point of its axis (or its centre) and the axis' direction."""

    point: np.ndarray
    direction: np.ndarray


@dataclass(frozen=True, slots=True, kw_only=True)
class _Measure:
    """How far a face lies from the joint."""

    distance: float
    direction: float
    part: str


def check_axes(bodies: Mapping[str, RecoveredBody], mechanism: Mechanism, config: Path) -> CheckResult:
    """Find every joint of a mechanism in the round faces of the bodies that it holds.

    Args:
        bodies: faces of the re-read STEP file, written in the mechanism's home pose.
        mechanism: rebuilt from the written config.
        config: that config, for messages.

    Returns:
        Result "config-axes". A joint of which a body has no face nearby, and a face nearby that is not on the joint,
        are errors.

    Raises:
        VacuousCheckError: the mechanism has no joints.
    """
    if not mechanism.joints:
        raise VacuousCheckError(f"{mechanism.name} has no joints whose axes could be found")
    Ts_base_body = mechanism.place_bodies(np.asarray(mechanism.home, dtype=float)[None])[0]
    index = {body.name: i for i, body in enumerate(mechanism.bodies)}
    findings: list[Finding] = []
    distance, direction, n_faces = 0.0, 0.0, 0
    for joint in mechanism.joints:
        for body, point, axis in _sides(joint):
            T = Ts_base_body[index[body]]
            line = _Line(point=T[:3, :3] @ np.array(point) + T[:3, 3], direction=T[:3, :3] @ np.array(axis))
            near = list(_near(joint.kind, line, bodies.get(body, RecoveredBody())))
            n_faces += len(near)
            distance = max([distance, *(m.distance for m in near)])
            direction = max([direction, *(m.direction for m in near)])
            findings += _judged(joint, body, line, near, config)
    findings += _meeting(mechanism, Ts_base_body, index, config)
    return CheckResult(
        check="config-axes",
        looked_at={"joints": len(mechanism.joints), "faces": n_faces},
        findings=tuple(findings),
        facts={"largest_distance_mm": distance, "largest_direction_rad": direction, "faces": n_faces},
    )


def _sides(joint: Joint) -> Iterator[tuple[str, tuple[float, float, float], tuple[float, float, float]]]:
    yield joint.parent, joint.p_parent, joint.axis_parent
    yield joint.child, joint.p_child, joint.axis_child


def _near(kind: JointKind, line: _Line, body: RecoveredBody) -> Iterator[_Measure]:
    """The faces of a body that are meant to lie on the joint, with their deviations."""
    if kind is JointKind.SPHERICAL:
        for sphere in body.spheres:
            off = float(np.linalg.norm(sphere.centre - line.point))
            if off <= _CAPTURE_MM:
                yield _Measure(distance=off, direction=0.0, part=sphere.part)
        return
    for cylinder in body.cylinders:
        off = _distance_to_line(line.point, cylinder.point, cylinder.direction)
        turn = float(np.linalg.norm(np.cross(cylinder.direction, line.direction)))
        if kind is JointKind.UNIVERSAL:
            # Either pin of the cross may be this body's: its axis passes through the centre in any direction.
            turn = 0.0
        if off <= _CAPTURE_MM and turn <= _CAPTURE_RAD:
            yield _Measure(distance=off, direction=turn, part=cylinder.part)


def _judged(joint: Joint, body: str, line: _Line, near: list[_Measure], config: Path) -> Iterator[Finding]:
    where = tuple(float(c) for c in line.point)
    assert len(where) == 3
    wanted = "spherical" if joint.kind is JointKind.SPHERICAL else "cylindrical"
    if not near:
        yield Finding(
            rule="config-axes",
            severity=Severity.ERROR,
            subject=(joint.name, body),
            location=where,
            limit=_CAPTURE_MM,
            unit="mm",
            message=f"{joint.name}: {body} has no {wanted} face within {_CAPTURE_MM} mm of where {config.name} puts"
            " the joint",
            suggestion="the config and the CAD file do not describe the same machine",
        )
        return
    worst = max(near, key=lambda m: m.distance)
    if worst.distance > DISTANCE_MM:
        yield Finding(
            rule="config-axes",
            severity=Severity.ERROR,
            subject=(joint.name, body, worst.part),
            location=where,
            measured=worst.distance,
            limit=DISTANCE_MM,
            unit="mm",
            message=f"{joint.name}: a {wanted} face of {body}/{worst.part} lies {worst.distance:.3g} mm from where"
            f" {config.name} puts the joint, allowed is {DISTANCE_MM:g}",
        )
    worst = max(near, key=lambda m: m.direction)
    if worst.direction > DIRECTION_RAD:
        yield Finding(
            rule="config-axes",
            severity=Severity.ERROR,
            subject=(joint.name, body, worst.part),
            location=where,
            measured=worst.direction,
            limit=DIRECTION_RAD,
            unit="rad",
            message=f"{joint.name}: the axis of {body}/{worst.part}"
            f" is turned by {worst.direction:.3g} rad against {config.name}, allowed is {DIRECTION_RAD:g}",
        )


def _meeting(
    mechanism: Mechanism, Ts_base_body: np.ndarray, index: Mapping[str, int], config: Path
) -> Iterator[Finding]:
    """The rebuilt mechanism's own two sides of a joint must meet, or the prediction means nothing."""
    for joint in mechanism.joints:
        T_parent, T_child = Ts_base_body[index[joint.parent]], Ts_base_body[index[joint.child]]
        p = T_parent[:3, :3] @ np.array(joint.p_parent) + T_parent[:3, 3]
        q = T_child[:3, :3] @ np.array(joint.p_child) + T_child[:3, 3]
        if joint.kind in (JointKind.SPHERICAL, JointKind.UNIVERSAL):
            apart = float(np.linalg.norm(p - q))
        else:
            apart = _distance_to_line(p, q, T_child[:3, :3] @ np.array(joint.axis_child))
        if apart > DISTANCE_MM:
            yield Finding(
                rule="config-axes",
                severity=Severity.ERROR,
                subject=(joint.name,),
                measured=apart,
                limit=DISTANCE_MM,
                unit="mm",
                message=f"{joint.name}: its two sides lie {apart:.3g} mm apart in {config.name}'s home pose",
            )


def _distance_to_line(p: np.ndarray, point: np.ndarray, direction: np.ndarray) -> float:
    return float(np.linalg.norm(np.cross(p - point, direction)))
