"""Whether bodies collide, and how near they come, over a set of poses: on the solids' meshes, faces of joints excepted.

Distances are those of the meshes less what each mesh may lie away from its solid (its deviation, both bodies'), so
they never promise more than the solids keep. A body that swallows a part of another collides although no surfaces
meet. Faces that a joint mates are exempt against each other only (see `mating`): a pin may be near its bore, a bar
beside the pin may not be near the bore's rim.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.design import Design
from linkwright.designs.language.errors import UnknownNameError, VacuousCheckError
from linkwright.designs.language.poses import invert_pose
from linkwright.designs.language.units import file_from_inside
from linkwright.generator.assembly import Assembly

from .contact.bodies import ContactBody, PairScan, build_contact_body, scan_pair
from .findings import CheckResult, Finding, Severity
from .interference import Interference, measure_interference
from .jointed_faces import FaceTable

Array = np.ndarray
Progress = Callable[[int, int, str], None]

#: Rows of the table of nearest pairs.
N_NEAREST = 10
#: Share by which the least distance of a pair may exceed the exact one: at first, and for the pairs of that table.
#: Distances below the required clearance are always exact.
_ROUGH, _FINE = 0.05, 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class _Pair:
    """Two bodies (numbers in the mechanism's order) and what was found."""

    i: int
    j: int
    is_jointed: bool
    allowance: float
    found: PairScan
    interference: Interference | None

    @property
    def clearance(self) -> float:
        """Least distance of the solids that the meshes prove; 0 if they may touch [mm]."""
        if self.interference is not None:
            return 0.0
        return max(0.0, self.found.scan.value - self.allowance)


def check_clearance(assembly: Assembly, poses: Array, *, progress: Progress | None = None) -> CheckResult:
    """Reach, interference and minimum clearance of every pair of bodies over poses.

    Args:
        assembly: the solids.
        poses: task coordinates, shape (n, n_task) [mm, rad].
        progress: told (pairs done, pairs, names) as the work goes on.

    Returns:
        Findings `unreachable` (by requirement), `interference` (exact volume of overlap of the meshes at the worst of
        the colliding poses examined) and `clearance` (nearer than the design asks); facts: the minimum clearance,
        its pair, pose and place, and the nearest pairs.

    Raises:
        VacuousCheckError: no poses, none that can be reached, or no pairs to look at.
        UnknownNameError: a declared contact names a body that does not exist.
    """
    design, mechanism = assembly.design, assembly.design.mechanism
    poses = np.asarray(poses, dtype=float)
    if poses.ndim != 2 or len(poses) == 0:
        raise VacuousCheckError(f"{design.name}: clearance: no poses to look at; ask for at least one")
    reach, findings = _check_reach(design, poses)
    poses = poses[reach]
    pairs = _pairs_to_look_at(design)
    Ts = mechanism.place_bodies(poses)
    scanned = _scan_pairs(assembly, pairs, Ts, progress)
    if all(pair.found.scan.pose < 0 for pair in scanned):
        raise VacuousCheckError(
            f"{design.name}: clearance: every pair of faces is exempt as mating in a joint, so "
            "nothing was looked at; declare runs_in_joint for the running parts alone"
        )
    for pair in scanned:
        findings += _judge(assembly, pair, poses, Ts)
    return CheckResult(
        check="clearance",
        looked_at={"poses": len(poses), "pairs": len(pairs), "bodies": len(assembly.bodies)},
        findings=tuple(findings),
        facts=_facts(assembly, scanned, poses, Ts, n_unreachable=int(len(reach) - reach.sum())),
    )


def _check_reach(design: Design, poses: Array) -> tuple[Array, list[Finding]]:
    """Which poses can be reached, and one finding per requirement that others violate."""
    solution = design.mechanism.solve_inverse(poses)
    reachable = np.asarray(solution.is_reachable, dtype=bool)
    findings = []
    reasons = {int(i): solution.reason(int(i)) for i in np.flatnonzero(~reachable)}
    for reason in dict.fromkeys(reasons.values()):
        of_reason = [i for i, r in reasons.items() if r == reason]
        column = solution.requirements.index(reason)
        worst = min(of_reason, key=lambda i: float(solution.margins[i, column]))
        findings.append(
            Finding(
                rule="unreachable",
                severity=Severity.ERROR,
                subject=(reason,),
                pose=_shown(design, poses[worst]),
                message=f"{len(of_reason)} of {len(poses)} poses of the workspace cannot be reached: {reason} misses "
                f"by {-float(solution.margins[worst, column]):.4g} at the worst",
                measured=float(solution.margins[worst, column]),
                limit=0.0,
                key="workspace",
                suggestion="shrink or move the workspace, or change the lengths that this requirement names",
            )
        )
    if not reachable.any():
        raise VacuousCheckError(
            f"{design.name}: clearance: none of {len(poses)} poses can be reached "
            f"({'; '.join(f.message for f in findings)}); shrink or move the workspace"
        )
    return reachable, findings


def _pairs_to_look_at(design: Design) -> list[tuple[int, int]]:
    names = [body.name for body in design.mechanism.bodies]
    for name in itertools.chain.from_iterable(allowed.pair for allowed in design.allowed):
        if name not in names:
            raise UnknownNameError("body", name, names)
    allowed = {frozenset(a.pair) for a in design.allowed}
    pairs = [
        (i, j)
        for i, j in itertools.combinations(range(len(names)), 2)
        if frozenset((names[i], names[j])) not in allowed
    ]
    if not pairs:
        raise VacuousCheckError(
            f"{design.name}: clearance: no pairs to look at among {len(names)} bodies and "
            f"{len(allowed)} declared contacts"
        )
    return pairs


def _scan_pairs(assembly: Assembly, pairs: list[tuple[int, int]], Ts: Array, progress: Progress | None) -> list[_Pair]:
    """All pairs over all poses, on all cores; the order of the answers is that of the pairs."""
    names = [body.body.name for body in assembly.bodies]
    kinds = {body.body.kind: body for body in assembly.bodies}
    table, done = FaceTable(assembly), itertools.count(1)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        trees = pool.map(lambda body: build_contact_body(body, table.classes(body)), kinds.values())
        built = dict(zip(kinds, trees, strict=True))

        def scan(pair: tuple[int, int]) -> _Pair:
            result = _scan(assembly, built, table, Ts, *pair, _ROUGH)
            if progress is not None:
                progress(next(done), len(pairs), f"{names[pair[0]]} / {names[pair[1]]}")
            return result

        try:
            found = list(pool.map(scan, pairs))
            near = sorted((pair.found.scan.value for pair in found), key=float)[:N_NEAREST][-1]
            doubtful = [k for k, pair in enumerate(found) if 0.0 < pair.found.scan.value * (1.0 - _ROUGH) <= near]
            again = pool.map(lambda k: _scan(assembly, built, table, Ts, *pairs[k], _FINE), doubtful)
            for k, pair in zip(doubtful, again, strict=True):
                found[k] = pair
            return found
        except BaseException:
            pool.shutdown(cancel_futures=True)
            raise


def _scan(
    assembly: Assembly, built: dict[str, ContactBody], table: FaceTable, Ts: Array, i: int, j: int, share: float
) -> _Pair:
    body_i, body_j = assembly.bodies[i], assembly.bodies[j]
    a, b = built[body_i.body.kind], built[body_j.body.kind]
    Ts_ij = invert_pose(Ts[:, i]) @ Ts[:, j]
    faces = table.between(body_i, body_j, Ts_ij)
    allowance = a.deviation + b.deviation
    need = assembly.design.clearance.minimum + allowance
    found = scan_pair(a, b, Ts_ij, need=need, share=share, faces=faces)
    interference = None
    if found.is_colliding.any():
        interference = measure_interference(body_i, body_j, a, b, Ts_ij, found, faces)
    return _Pair(i=i, j=j, is_jointed=faces is not None, allowance=allowance, found=found, interference=interference)


def _judge(assembly: Assembly, pair: _Pair, poses: Array, Ts: Array) -> list[Finding]:
    """The finding of a pair, if there is one."""
    design, least = assembly.design, assembly.design.clearance.minimum
    names = (assembly.bodies[pair.i].body.name, assembly.bodies[pair.j].body.name)
    hit = pair.interference
    if hit is not None and hit.volume > 0.0:
        T = Ts[hit.pose, pair.i]
        return [
            Finding(
                rule="interference",
                severity=Severity.ERROR,
                subject=names,
                pose=_shown(design, poses[hit.pose]),
                message=f"{names[0]} ({hit.parts[0]}) and {names[1]} ({hit.parts[1]}) share {hit.volume:.4g} mm3"
                f"{' (one lies wholly in the other)' if hit.is_swallowed else ''}; the two bodies collide at "
                f"{hit.n_poses} of {len(poses)} poses, this is the worst of {hit.n_examined} examined",
                measured=hit.volume,
                limit=0.0,
                unit="mm3",
                location=_point(T, hit.centre),
                suggestion="move the two apart, make one smaller there, or shrink the workspace",
            )
        ]
    if pair.clearance >= least:
        return []
    # Here surfaces come near: a pair that is exempt throughout has an infinite clearance.
    scan = pair.found.scan
    n_near = int((scan.values < least + pair.allowance).sum())
    return [
        Finding(
            rule="clearance",
            severity=Severity.ERROR,
            subject=names,
            pose=_shown(design, poses[scan.pose]),
            message=f"{names[0]} and {names[1]} come within {pair.clearance:.4g} mm ({scan.value:.4g} mm between "
            f"meshes, less {pair.allowance:g} mm that these may lie off the solids); {least:g} mm are asked for, and "
            f"{n_near} of {len(poses)} poses are nearer",
            measured=pair.clearance,
            limit=least,
            unit="mm",
            location=_location(pair, Ts),
            key="clearance.minimum_mm",
            suggestion=f"widen the gap by {least - pair.clearance:.3g} mm, shrink the workspace, or ask for less; a "
            "contact that is meant is declared under [[allowed]] with its reason",
        )
    ]


def _location(pair: _Pair, Ts: Array) -> tuple[float, float, float] | None:
    """The middle of the shortest way between the two, in the base frame."""
    scan = pair.found.scan
    if scan.point_a is None or scan.point_b is None:
        return None
    return _point(Ts[scan.pose, pair.i], 0.5 * (scan.point_a + scan.point_b))


def _point(T: Array, p: Array | None) -> tuple[float, float, float] | None:
    if p is None:
        return None
    x, y, z = (T[:3, :3] @ p + T[:3, 3]).tolist()
    return x, y, z


def _shown(design: Design, pose: Array) -> dict[str, float]:
    return {c.key: file_from_inside(float(v), c.unit) for c, v in zip(design.mechanism.task, pose, strict=True)}


def _facts(assembly: Assembly, scanned: list[_Pair], poses: Array, Ts: Array, *, n_unreachable: int) -> dict[str, Any]:
    """What is worth keeping even when nothing is wrong; the nearest pairs first."""
    design = assembly.design
    known = [pair for pair in scanned if pair.found.scan.pose >= 0]
    nearest = sorted(known, key=lambda pair: (pair.clearance, -pair.interference.volume if pair.interference else 0.0))
    rows = [
        {
            "pair": [assembly.bodies[pair.i].body.name, assembly.bodies[pair.j].body.name],
            "clearance_mm": pair.clearance,
            "pose": _shown(design, poses[pair.found.scan.pose]),
            "location_mm": _location(pair, Ts),
            "n_colliding": int(pair.found.is_colliding.sum()),
        }
        for pair in nearest[:N_NEAREST]
    ]
    return {
        "minimum_clearance_mm": rows[0]["clearance_mm"],
        "minimum_clearance_pair": rows[0]["pair"],
        "minimum_clearance_pose": rows[0]["pose"],
        "minimum_clearance_location_mm": rows[0]["location_mm"],
        "required_mm": design.clearance.minimum,
        "mesh_allowance_mm": max(pair.allowance for pair in scanned),
        "nearest": rows,
        "poses": len(poses),
        "unreachable_poses": n_unreachable,
        "pairs": len(scanned),
        "colliding_pairs": sum(pair.interference is not None for pair in scanned),
        "jointed_pairs": sum(pair.is_jointed for pair in scanned),
        "allowed": [{"pair": list(a.pair), "reason": a.reason} for a in design.allowed],
    }
