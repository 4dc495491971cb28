"""Everything that is asked of a design before it may be released, in one report."""

from __future__ import annotations

import hashlib
from collections.abc import Callable

import numpy as np

from linkwright.generator.assembly import Assembly
from linkwright.generator.store import Store

from .clearance import check_clearance
from .findings import CheckResult, Report, facts_from_result, result_from_facts
from .fits import check_fits
from .joint_limits import measure_joint_limits
from .notebook import Notebook, evidence_of_body, evidence_of_joint, key_of
from .sampling import sample_box

Progress = Callable[[int, int, str], None]


def declared_poses(assembly: Assembly) -> np.ndarray:
    """The poses that the checks visit, shape (n + 1, n_task): home, then the sample of the declared workspace."""
    design = assembly.design
    lower, upper = design.box()
    sample = sample_box(lower, upper, design.sampling.n_poses, design.sampling.seed)
    return np.concatenate([design.mechanism.home[None], sample])


def check_design(assembly: Assembly, *, store: Store | None = None, progress: Progress | None = None) -> Report:
    """Fits and joint limits on the solids, reach and clearance over the declared workspace.

    Raises:
        VacuousCheckError: a check found nothing to look at.
    """
    return Report(
        results=(
            check_fits(assembly, store=store, progress=progress),
            measure_joint_limits(assembly, store=store, progress=progress),
            _clearance(assembly, declared_poses(assembly), store, progress),
        )
    )


def _clearance(assembly: Assembly, poses: np.ndarray, store: Store | None, progress: Progress | None) -> CheckResult:
    """The clearance check, recalled if the very same solids were moved through the very same poses before."""
    notebook, design = Notebook(store), assembly.design
    moves = hashlib.sha256(np.ascontiguousarray(design.mechanism.place_bodies(poses)).tobytes()).hexdigest()
    bodies = [[body.body.name, evidence_of_body(body)] for body in assembly.bodies]
    joints = [[joint.parent, joint.child, evidence_of_joint(joint)] for joint in design.mechanism.joints]
    key = key_of("clearance", design.hash, moves, bodies, joints)
    known = notebook.recall(key)
    if known is not None:
        return result_from_facts(known)
    result = check_clearance(assembly, poses, progress=progress)
    notebook.note(key, facts_from_result(result))
    return result
