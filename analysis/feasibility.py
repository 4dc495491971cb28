"""Everything that is asked of a design before it may be released, in one report."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from linkwright.generator.assembly import Assembly
from linkwright.generator.store import Store

from .clearance import check_clearance
from .findings import Report
from .fits import check_fits
from .joint_limits import measure_joint_limits
from .sampling import sample_box

Progress = Callable[[int, int, str], None]


def declared_poses(assembly: Assembly) -> np.ndarray:
    """The poses that the checks visit: home, then the seeded sample of the declared workspace, shape (n + 1, n_task)."""
    design = assembly.design
    lower, upper = design.box()
    sample = sample_box(lower, upper, design.sampling.n_poses, design.sampling.seed)
    return np.concatenate([design.mechanism.home[None], sample])


def check_design(assembly: Assembly, *, store: Store | None = None, progress: Progress | None = None) -> Report:
    """Joint limits and fits on the solids, reach and clearance over the declared workspace.

    Raises:
        VacuousCheckError: a check found nothing to look at.
    """
    return Report(
        results=(
            check_fits(assembly, store=store, progress=progress),
            measure_joint_limits(assembly, store=store, progress=progress),
            check_clearance(assembly, declared_poses(assembly), progress=progress),
        )
    )
