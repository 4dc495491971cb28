"""How far each joint goes until its two bodies touch, measured on their solids, against what the design declares.

The bodies stand as they do at home and one of them moves. A revolute or prismatic joint goes both ways. A spherical
or universal one starts with its axes aligned and leans towards each azimuth in turn, its twist kept as at home; the
smallest lean is the half angle of its cone. Only the joint's two bodies are looked at; what lies around them is for
the clearance check.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.joints import Joint, JointKind
from linkwright.designs.language.poses import invert_pose, transform_points
from linkwright.designs.language.units import DEG
from linkwright.generator.assembly import AssembledBody, Assembly
from linkwright.generator.store import Store

from .findings import CheckResult, Finding, Severity
from .joint_travel import JointTravel, check_closure, measure_joint
from .notebook import Notebook, evidence_of_body, evidence_of_shape, key_of, rounded
from .travel import Surroundings, Travel, build_passage, build_surroundings

Array = np.ndarray
Progress = Callable[[int, int, str], None]

#: Azimuths towards which a ball joint leans.
N_AZIMUTHS = 24
#: Derived number under which a mechanism says what its ball joints' cone should be by a formula [rad].
CONE_KEY = "cone_half_angle"
#: More than this between formula and solids is worth a word [deg].
FORMULA_SLACK = 0.05


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
        within half a turn either way) and what stops it. facts["cones"]: per ball joint its leans by azimuth [deg], and
        what the mechanism's formula says, if it has one.

    Raises:
        VacuousCheckError: the mechanism has no joints.
        KinematicsError: a joint's axes do not meet at home.
    """
    mechanism = assembly.design.mechanism
    if not mechanism.joints:
        raise VacuousCheckError(f"{assembly.design.name}: no joints to measure; a mechanism has at least one")
    bench = _Bench(assembly, store)
    values = mechanism.solve_inverse(mechanism.home[None]).joints[0]
    derived = mechanism.derived_numbers()
    formula = derived[CONE_KEY][0] / DEG if CONE_KEY in derived else None
    limits: dict[str, Any] = {}
    cones: dict[str, Any] = {}
    findings: list[Finding] = []
    for i, (joint, value) in enumerate(zip(mechanism.joints, values, strict=True)):
        if progress is not None:
            progress(i, len(mechanism.joints), f"turning {joint.name}")
        measured = bench.measure(joint, n_azimuths)
        limits[joint.name] = _limits_of(joint, measured, float(value), assembly)
        if measured.azimuths:
            tilts = [t.extent / DEG for t in measured.travels]
            cones[joint.name] = {"azimuths": [a / DEG for a in measured.azimuths], "tilts": tilts, "formula": formula}
            findings += _formula_findings(joint, min(tilts), formula)
        findings += _findings_of(joint, measured, limits[joint.name], bench)
    if progress is not None:
        progress(len(mechanism.joints), len(mechanism.joints), "")
    looked_at = {"joints": len(limits), "distinct": bench.n_distinct, "azimuths": n_azimuths * len(cones)}
    return CheckResult(
        check="joint-limits", looked_at=looked_at, findings=tuple(findings), facts={"limits": limits, "cones": cones}
    )


class _Bench:
    """The bodies at home, and what has been measured on them; equal joints are measured once."""

    def __init__(self, assembly: Assembly, store: Store | None) -> None:
        self.assembly = assembly
        mechanism = assembly.design.mechanism
        poses = mechanism.place_bodies(mechanism.home[None])[0]
        self.poses = dict(zip((b.name for b in mechanism.bodies), poses, strict=True))
        self._notebook = Notebook(store)
        self._seen: dict[str, Surroundings] = {}
        self._keys: set[str] = set()

    @property
    def n_distinct(self) -> int:
        """How many of the joints differ; equal ones share a measurement, whether taken now or recalled."""
        return len(self._keys)

    def measure(self, joint: Joint, n_azimuths: int) -> JointTravel:
        """What was measured on this joint, or on one that equals it."""
        parent, child = self.assembly.body(joint.parent), self.assembly.body(joint.child)
        T = invert_pose(self.poses[joint.parent]) @ self.poses[joint.child]
        check_closure(joint, T)
        # All is told as the child sees it at home, so that legs around one plate have one measurement.
        T_back = invert_pose(T)
        key = key_of(
            "travel",
            evidence_of_shape(parent, T_back),
            evidence_of_body(child),
            joint.kind.value,
            rounded(joint.p_child),
            rounded(joint.axis_child),
            rounded(T_back[:3, :3] @ joint.axis_parent),
            n_azimuths,
        )
        self._keys.add(key)
        facts = self._notebook.recall(key)
        if facts is None:
            where = f"{self.assembly.design.name}: {joint.name}"
            passage = build_passage(self._look_at(parent), self._look_at(child), joint, where)
            facts = _facts_of(measure_joint(passage, joint, T, n_azimuths), parent, T_back)
            self._notebook.note(key, facts)
        return _travel_of(facts, parent, T)

    def _look_at(self, body: AssembledBody) -> Surroundings:
        if body.body.kind not in self._seen:
            self._seen[body.body.kind] = build_surroundings(body)
        return self._seen[body.body.kind]


def _facts_of(measured: JointTravel, parent: AssembledBody, T_child_parent: Array) -> dict[str, Any]:
    """As the child sees it at home: the parent's part by its middle, for another leg meets a part of another number."""
    rows = []
    for t in measured.travels:
        middle = _middles(parent, T_child_parent)[t.parts[0]].tolist() if t.parts[0] >= 0 else None
        rows.append(
            [
                t.extent,
                t.is_stopped,
                middle,
                t.parts[1],
                transform_points(T_child_parent, np.array(t.point)[None])[0].tolist(),
            ]
        )
    return {"azimuths": list(measured.azimuths), "travels": rows}


def _travel_of(facts: Mapping[str, Any], parent: AssembledBody, T_parent_child: Array) -> JointTravel:
    travels = []
    for extent, is_stopped, middle, part, point in facts["travels"]:
        x, y, z = transform_points(T_parent_child, np.array(point)[None])[0].tolist()
        number = -1
        if middle is not None:
            apart = _middles(parent, invert_pose(T_parent_child)) - np.array(middle)
            number = int(np.argmin(np.linalg.norm(apart, axis=1)))
        travels.append(Travel(extent=extent, is_stopped=is_stopped, parts=(number, part), point=(x, y, z)))
    return JointTravel(travels=tuple(travels), azimuths=tuple(facts["azimuths"]))


def _middles(body: AssembledBody, T_ref_body: Array) -> Array:
    """Centres of a body's parts in a reference frame, shape (n_parts, 3) [mm]."""
    return np.array([(T_ref_body @ a.T_body_part @ [*a.solid.centre, 1.0])[:3] for a in body.parts])


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
    return {
        "lower": lower,
        "upper": upper,
        "declared_lower": joint.lower,
        "declared_upper": joint.upper,
        "unit": "mm" if joint.kind is JointKind.PRISMATIC else "rad",
        "unlimited": unlimited,
        "stopped_below_by": stops[0],
        "stopped_above_by": stops[1],
    }


def _formula_findings(joint: Joint, measured: float, formula: float | None) -> list[Finding]:
    if formula is None or abs(measured - formula) <= FORMULA_SLACK:
        return []
    return [
        Finding(
            rule="cone-formula",
            severity=Severity.WARNING,
            subject=(joint.name, joint.parent, joint.child),
            message=f"{joint.name} leans by {measured:.3f} deg on its solids, but by {formula:.3f} deg according to "
            "the formula",
            measured=measured,
            limit=formula,
            unit="deg",
            suggestion="look at countersink, shoulder, root fillet and ring edge: one stops the bar before the rim",
        )
    ]


def _findings_of(joint: Joint, measured: JointTravel, limits: Mapping[str, Any], bench: _Bench) -> list[Finding]:
    unit = joint.unit
    scale = 1.0 if unit == "mm" else DEG
    ends = (
        [("upper", min(measured.travels, key=lambda t: t.extent), 1.0)]
        if measured.azimuths
        else [("lower", measured.travels[0], -1.0), ("upper", measured.travels[1], 1.0)]
    )
    findings = []
    for end, travel, sign in ends:
        declared, found = limits[f"declared_{end}"], limits[end]
        # Without a contact nothing stops the joint, however far it is declared to go.
        if not travel.is_stopped or sign * declared <= sign * found:
            continue
        by = limits["stopped_above_by" if end == "upper" else "stopped_below_by"]
        point = transform_points(bench.poses[joint.parent], np.array(travel.point)[None])[0]
        findings.append(
            Finding(
                rule="joint-limit",
                severity=Severity.ERROR,
                subject=(joint.name, joint.parent, joint.child),
                message=f"{joint.name} is declared to go {'down' if sign < 0 else 'up'} to {declared / scale:.3f} "
                f"{unit}, but its solids touch at {found / scale:.3f} {unit}" + (f" ({by})" if by else ""),
                measured=found / scale,
                limit=declared / scale,
                unit=unit,
                location=(float(point[0]), float(point[1]), float(point[2])),
                suggestion=f"declare {'at least' if sign < 0 else 'at most'} {found / scale:.2f} {unit}, or take metal "
                "away where they touch",
            )
        )
    return findings
