"""All that `linkwright dexterity` says about a design, and the same as plain values for a file."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.design import Design
from linkwright.designs.language.errors import KinematicsError, ParameterError
from linkwright.designs.language.formulas import FormulaMechanism
from linkwright.designs.language.joints import Joint
from linkwright.designs.language.mechanism import Coordinate, Mechanism
from linkwright.designs.language.units import file_from_inside

from ..pose_sets import PoseSet, grid_positions, pen_turns, plate_turns, ring_tilts
from ..sampling import sample_box
from .isotropy_index import GlobalIsotropy, compute_global_isotropy, trace_isotropy
from .loci import Locus, compute_loci
from .measures import MEASURES, Ellipsoid, compute_ellipsoids, measure_poses, unit_lines
from .scaling import N_MOVES, Scaling, compute_hand_jacobian, hand_columns, natural_length, with_length
from .singularity import NearestSingularity, find_nearest_singularities
from .survey import Survey, survey_poses

Array = np.ndarray
Progress = Callable[[int, int, str], None]

#: Poses of a larger set that the survey visits, evenly spread; the index always visits all.
MOST_SURVEYED = 50_000

#: Places per coordinate of a grid, if only rings are asked for.
_PLACES = 5

#: How far to look for singular poses, in half diagonals of the workspace.
_LOOK = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseRequest:
    """Which poses to visit; with neither grid nor cone, the design's own sampling of its box.

    Attributes:
        grid: places per coordinate of position; one number for all, empty for none asked.
        cone: half angle of the tilts [rad], or None.
        n_rings, rolls: of the cone; rolls [rad].
        tool: hand axis that is tilted, "y" or "z"; empty for z, of a task without ry for y.
    """

    grid: tuple[int, ...] = ()
    cone: float | None = None
    n_rings: int = 3
    rolls: tuple[float, ...] = (0.0,)
    tool: str = ""


@dataclass(frozen=True, slots=True, kw_only=True)
class DexterityReport:
    """Dexterity of a design.

    Attributes:
        design: measured.
        length: millimetres per radian of turn.
        pose: where the single values hold, shape (n_task,) [mm, rad].
        values: in the order of `MEASURES`.
        levers: of the motors there, in their order; the least is the serial margin. Infinite of a motor (a grip's)
            that does not move the hand [mm/rad, of a slide mm/mm].
        ellipsoids: of moves, and of turns if there are any.
        singularities: the nearest of each kind from the pose.
        survey: over the workspace (of a large set, over a part of it).
        isotropy: over all poses of the set.
        loci: singular curves that the mechanism states.
    """

    design: Design
    length: float
    pose: Array
    values: tuple[float, ...]
    levers: tuple[float, ...]
    ellipsoids: tuple[Ellipsoid, ...]
    singularities: tuple[NearestSingularity, ...]
    survey: Survey
    isotropy: GlobalIsotropy
    loci: tuple[Locus, ...]


def build_report(
    design: Design,
    pose: Array | None = None,
    request: PoseRequest | None = None,
    *,
    length: float | None = None,
    scaling: Scaling | None = None,
    progress: Progress | None = None,
) -> DexterityReport:
    """The report of a design.

    Args:
        design: of a mechanism written as formulas.
        pose: for the single values; None for home, shape (n_task,) [mm, rad].
        request: which poses to visit.
        length: millimetres per radian; None for the length at which moves and turns weigh alike at home.
        scaling: of the index; None weighs turns by the length and all motors alike.
        progress: told what is done.

    Raises:
        KinematicsError: the pose cannot be reached.
        ParameterError: scales or grid do not fit the task.
        VacuousCheckError: no pose of the set can be reached.
    """
    mechanism = design.mechanism
    if not isinstance(mechanism, FormulaMechanism):
        raise KinematicsError(f"{mechanism.name}: dexterity needs a mechanism that is written as formulas")
    length = length or natural_length(mechanism)
    pose = mechanism.home if pose is None else np.asarray(pose, dtype=float)
    inverse = mechanism.solve_inverse(pose[None])
    if not inverse.is_reachable[0]:
        raise KinematicsError(f"{mechanism.name}: the pose to measure cannot be reached: {inverse.reason(0)}")
    poses = choose_poses(design, request or PoseRequest())
    kernel = Kernel(trace_isotropy(mechanism, scaling or _plain_scaling(mechanism, length), has_limits=True))
    G = with_length(compute_hand_jacobian(mechanism, pose[None]), length)
    at = measure_poses(mechanism, pose[None], length)
    return DexterityReport(
        design=design,
        length=length,
        pose=pose,
        values=tuple(float(getattr(at, name)[0]) for name in MEASURES),
        levers=tuple(float(v) for v in unit_lines(G)[1][0]),
        ellipsoids=compute_ellipsoids(mechanism, pose),
        singularities=find_nearest_singularities(
            mechanism, pose, length, within=_LOOK * _half_diagonal(design, length)
        ),
        survey=survey_poses(mechanism, _thinned(poses), length, progress),
        isotropy=compute_global_isotropy(kernel, poses, progress=progress),
        loci=compute_loci(mechanism),
    )


def _plain_scaling(mechanism: Mechanism, length: float) -> Scaling:
    n = hand_columns(mechanism)
    return Scaling(hand=(1.0,) * min(n, N_MOVES) + (length,) * max(n - N_MOVES, 0))


def _half_diagonal(design: Design, length: float) -> float:
    lower, upper = design.box()
    lengths = np.array([length if c.unit == "deg" else 1.0 for c in design.mechanism.task])
    return 0.5 * float(np.linalg.norm((upper - lower) * lengths))


def _thinned(poses: PoseSet) -> Array:
    if len(poses) <= MOST_SURVEYED:
        return poses.poses()
    chosen = np.linspace(0, len(poses) - 1, MOST_SURVEYED).astype(int)
    at, turn = np.divmod(chosen, len(poses.turns))
    return np.concatenate([poses.positions[at], poses.turns[turn]], axis=-1)


def choose_poses(design: Design, request: PoseRequest) -> PoseSet:
    """The set of poses that a request means for a design.

    Raises:
        ParameterError: the grid or the cone does not fit the task.
    """
    lower, upper = design.box()
    task, home = design.mechanism.task, design.mechanism.home
    if not request.grid and request.cone is None:
        poses = sample_box(lower, upper, design.sampling.n_poses, design.sampling.seed)
        return PoseSet(positions=poses, turns=np.zeros((1, 0)))
    n = sum(c.name in ("x", "y", "z") for c in task)
    counts = request.grid or (_PLACES,)
    counts = counts * n if len(counts) == 1 else counts
    if len(counts) != n or min(counts) < 1:
        raise ParameterError("grid", request.grid, f"must be one number, or {n}, each 1 or more")
    turns = home[None, n:] if request.cone is None else _turns(task, home, request, request.cone)
    return PoseSet(positions=grid_positions(list(lower[:n]), list(upper[:n]), counts), turns=turns)


def _turns(task: tuple[Coordinate, ...], home: Array, request: PoseRequest, cone: float) -> Array:
    names = ("rx", "ry", "rz")
    held = [k for k, name in enumerate(names) if name in [c.name for c in task]]
    if len(held) < 2:
        raise ParameterError("rings", math.degrees(cone), "needs a task with turns")
    tool = request.tool or ("z" if len(held) == 3 else "y")
    if len(held) == 2 and (tool != "y" or held != [0, 2] or any(request.rolls)):
        raise ParameterError("tool", tool, "a task without ry tilts its y, and has no roll")
    make = pen_turns if tool == "y" else plate_turns
    turns = make(ring_tilts(cone, request.n_rings), request.rolls)[:, held]
    rest = home[N_MOVES + len(held) :]
    return np.concatenate([turns, np.tile(rest, (len(turns), 1))], axis=1)


def active_joints(mechanism: Mechanism) -> tuple[Joint, ...]:
    """The driven joints, in the order of the Jacobian's rows."""
    return mechanism.joints[: mechanism.n_active]


def report_facts(report: DexterityReport) -> dict[str, Any]:
    """The report as plain values with the unit in every key; a value that is infinite is None."""
    mechanism, survey, isotropy = report.design.mechanism, report.survey, report.isotropy

    def place(pose: Array) -> dict[str, float]:
        return {c.key: file_from_inside(float(v), c.unit) for c, v in zip(mechanism.task, pose, strict=True)}

    return {
        "name": report.design.name,
        "design_hash": report.design.hash,
        "length_mm": report.length,
        "pose": place(report.pose),
        "at_pose": {key: _plain(v) for key, v in zip(MEASURES, report.values, strict=True)},
        "levers": {joint.name: _plain(v) for joint, v in zip(active_joints(mechanism), report.levers, strict=True)},
        "ellipsoids": [
            {"of": of, "semi_axes": e.semi_axes.tolist(), "directions": e.directions.T.tolist()}
            for of, e in zip(("moves", "turns"), report.ellipsoids, strict=False)
        ],
        "nearest_singularities": [
            {"kind": s.kind.value, "distance_mm": s.distance, "pose": place(s.pose)} for s in report.singularities
        ],
        "workspace": {
            "n_poses": len(survey.poses),
            "n_unreachable": int(np.sum(~survey.is_reachable)),
            "n_other_assembly": survey.n_other_assembly,
            "measures": {s.name: _spread_facts(s, place) for s in survey.spreads},
            "margins": [
                {"requirement": m.requirement, "margin": _plain(m.margin), "pose": place(m.pose)}
                for m in survey.margins
            ],
        },
        "global_isotropy": {
            "index": isotropy.index,
            "index_of_reachable": isotropy.index_of_reachable,
            "least": isotropy.least,
            "greatest": isotropy.greatest,
            "n_poses": isotropy.n_poses,
            "n_unreachable": isotropy.n_unreachable,
            "pose_of_least": place(isotropy.pose_of_least),
            "pose_of_greatest": place(isotropy.pose_of_greatest),
        },
        "loci": [{"name": q.name, "kind": q.kind.value, "points_mm": q.points.tolist()} for q in report.loci],
    }


def _spread_facts(spread: Any, place: Callable[[Array], Mapping[str, float]]) -> dict[str, Any]:
    return {
        "least": _plain(spread.least),
        "median": _plain(spread.median),
        "greatest": _plain(spread.greatest),
        "pose_of_least": place(spread.pose_of_least),
        "pose_of_greatest": place(spread.pose_of_greatest),
    }


def _plain(value: float) -> float | None:
    return value if math.isfinite(value) else None
