"""Whether parts of one body lie beside each other, and with how much play the faces run that each joint mates."""

from __future__ import annotations

from collections.abc import Callable
from itertools import combinations
from typing import Any

import numpy as np

from linkwright.designs.language.errors import VacuousCheckError
from linkwright.designs.language.joints import Joint
from linkwright.designs.language.poses import invert_pose, transform_points
from linkwright.generator.assembly import AssembledBody, AssembledPart, Assembly
from linkwright.generator.store import Store

from .brep import TOUCH, BodyFaces, build_body_faces, compute_common_volume, compute_least_gap
from .findings import CheckResult, Finding, Severity
from .mating import mating_faces
from .notebook import Notebook, evidence_of_body, evidence_of_joint, key_of, rounded

Array = np.ndarray
Progress = Callable[[int, int, str], None]

#: Common volumes up to this are the kernel's rounding where faces coincide [mm3].
LEAST_OVERLAP = 1e-3


def check_fits(assembly: Assembly, *, store: Store | None = None, progress: Progress | None = None) -> CheckResult:
    """Parts that overlap within a body, and joints without play, both on the exact solids.

    Args:
        assembly: of a design. Bodies of one kind are looked at once.
        store: measurements are kept beside its solids; None keeps nothing.
        progress: is told (done, of how many, what) before each body and joint and once at the end.

    Returns:
        facts["running_clearances_mm"]: per joint the least distance between the faces that it mates.

    Raises:
        VacuousCheckError: there is neither a pair of parts nor a joint.
    """
    kinds = {b.body.kind: b for b in assembly.bodies}
    joints = assembly.design.mechanism.joints
    n_pairs = sum(len(b.parts) * (len(b.parts) - 1) // 2 for b in kinds.values())
    if n_pairs + len(joints) == 0:
        raise VacuousCheckError(f"{assembly.design.name}: no two parts and no joint to look at")
    notebook, total = Notebook(store), len(kinds) + len(joints)
    findings: list[Finding] = []
    for i, body in enumerate(kinds.values()):
        _tell(progress, i, total, f"parts of {body.body.kind}")
        findings += _overlaps(assembly, body, notebook)
    play = _Play(assembly, notebook)
    clearances: dict[str, float | None] = {}
    for i, joint in enumerate(joints):
        _tell(progress, len(kinds) + i, total, f"fit of {joint.name}")
        clearances[joint.name] = play.measure(joint)
        findings += _fit_findings(joint, clearances[joint.name])
    _tell(progress, total, total, "")
    return CheckResult(
        check="fits",
        looked_at={"body kinds": len(kinds), "part pairs": n_pairs, "joints": len(joints)},
        findings=tuple(findings),
        facts={"running_clearances_mm": clearances},
    )


def _tell(progress: Progress | None, done: int, total: int, what: str) -> None:
    if progress is not None:
        progress(done, total, what)


def _overlaps(assembly: Assembly, body: AssembledBody, notebook: Notebook) -> list[Finding]:
    findings = []
    boxes = [_box(assembled) for assembled in body.parts]
    poses = assembly.design.mechanism.place_bodies(assembly.design.mechanism.home[None])[0]
    T_base = poses[[b.body.name for b in assembly.bodies].index(body.body.name)]
    for (a, box_a), (b, box_b) in combinations(zip(body.parts, boxes, strict=True), 2):
        lower, upper = np.maximum(box_a[0], box_b[0]), np.minimum(box_a[1], box_b[1])
        if np.any(upper - lower <= TOUCH):
            continue
        volume = _common(a, b, notebook, f"{assembly.design.name}: {body.body.kind}: {a.part.name} and {b.part.name}")
        if volume <= LEAST_OVERLAP:
            continue
        point = transform_points(T_base, 0.5 * (lower + upper)[None])[0]
        findings.append(
            Finding(
                rule="part-overlap",
                severity=Severity.ERROR,
                subject=(body.body.kind, a.part.name, b.part.name),
                message=f"{body.body.kind}: {a.part.name} and {b.part.name} share {volume:.4g} mm3; parts of one body "
                "may touch, not overlap",
                measured=volume,
                limit=LEAST_OVERLAP,
                unit="mm3",
                location=(float(point[0]), float(point[1]), float(point[2])),
                suggestion="move one of them, or cut the room for it out of the other",
            )
        )
    return findings


def _box(assembled: AssembledPart) -> tuple[Array, Array]:
    """A box around a part in its body's axes: that of its mesh, which the solid passes by less than the deviation."""
    points = transform_points(assembled.T_body_part, assembled.solid.mesh.vertices)
    return points.min(axis=0), points.max(axis=0)


def _common(a: AssembledPart, b: AssembledPart, notebook: Notebook, where: str) -> float:
    """The volume that two parts share [mm3]; equal pairs in equal position are computed once."""
    T = invert_pose(a.T_body_part) @ b.T_body_part
    key = key_of("common", a.solid.key, b.solid.key, rounded(T))
    volume = notebook.recall(key)
    if volume is None:
        volume = compute_common_volume(a.solid.shape, b.solid.shape, T, where=where)
        notebook.note(key, volume)
    return float(volume)


class _Play:
    """Running clearances at home; equal joints are measured once."""

    def __init__(self, assembly: Assembly, notebook: Notebook) -> None:
        self._assembly, self._notebook = assembly, notebook
        mechanism = assembly.design.mechanism
        poses = mechanism.place_bodies(mechanism.home[None])[0]
        self._poses = dict(zip((b.name for b in mechanism.bodies), poses, strict=True))
        self._seen: dict[str, BodyFaces] = {}

    def measure(self, joint: Joint) -> float | None:
        """The least exact distance between the joint's mating faces [mm]; None if one body has none."""
        parent, child = self._assembly.body(joint.parent), self._assembly.body(joint.child)
        T = invert_pose(self._poses[joint.parent]) @ self._poses[joint.child]
        key = key_of("play", evidence_of_body(parent), evidence_of_body(child), evidence_of_joint(joint), rounded(T))
        facts = self._notebook.recall(key)
        if facts is None:
            facts = {"gap": self._gap(joint, parent, child, T)}
            self._notebook.note(key, facts)
        return facts["gap"]

    def _gap(self, joint: Joint, parent: AssembledBody, child: AssembledBody, T: Array) -> float | None:
        of_parent, of_child = mating_faces(parent, joint, as_parent=True), mating_faces(child, joint, as_parent=False)
        if not of_parent.any() or not of_child.any():
            return None
        a, b = self._faces(parent), self._faces(child)
        where = f"{self._assembly.design.name}: {joint.name}"
        return compute_least_gap(a, np.flatnonzero(of_parent), b, np.flatnonzero(of_child), T, where=where)

    def _faces(self, body: AssembledBody) -> BodyFaces:
        if body.body.kind not in self._seen:
            self._seen[body.body.kind] = build_body_faces(body)
        return self._seen[body.body.kind]


def _fit_findings(joint: Joint, gap: float | None) -> list[Finding]:
    subject: tuple[str, ...] = (joint.name, joint.parent, joint.child)
    common: dict[str, Any] = {"rule": "fit", "severity": Severity.ERROR, "subject": subject, "unit": "mm"}
    if gap is None:
        return [
            Finding(
                message=f"{joint.name}: {joint.parent} or {joint.child} has no face that runs in this joint, "
                "so nothing holds it",
                suggestion="mark the pin, bearing, ball or seat with runs_in_joint, and place it on the joint's axis",
                **common,
            )
        ]
    if gap > TOUCH:
        return []
    return [
        Finding(
            message=f"{joint.name}: the faces of {joint.parent} and {joint.child} that run on each other "
            "touch; a running fit needs play",
            measured=gap,
            limit=TOUCH,
            suggestion="make the bore larger or the pin smaller",
            **common,
        )
    ]
