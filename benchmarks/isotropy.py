"""How long the isotropy index of the haptic pen's Table VII takes on its full grid: 2.4 million poses.

Run: `python benchmarks/isotropy.py`. Asserts nothing; tests/papers/test_stocco_gii.py holds the values.
"""

from __future__ import annotations

import time

import numpy as np

from linkwright.analysis.dexterity.isotropy_index import compute_global_isotropy, trace_isotropy
from linkwright.analysis.dexterity.scaling import Scaling
from linkwright.analysis.pose_sets import PoseSet, grid_positions, pen_turns, ring_tilts
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.haptic_pen.mechanism import HapticPen
from linkwright.designs.haptic_pen.parameters import STOCCO_HAND_FORCE, STOCCO_TABLE_7
from linkwright.designs.language.units import CM, DEG


def main() -> None:
    """Measure and print."""
    positions = grid_positions((0.0, 0.0, 200.0), (80.0, 50.0, 300.0), (17, 11, 21))
    poses = PoseSet(positions=positions, turns=pen_turns(ring_tilts(45.0 * DEG, 14))[:, [0, 2]])
    hand = tuple(np.array(STOCCO_HAND_FORCE) * [1.0, 1.0, 1.0, CM, CM])
    scaling = Scaling(motors=(1.6, 1.0, 1.0) * 2, hand=hand)
    start = time.perf_counter()
    kernel = Kernel(trace_isotropy(HapticPen({"parameters": STOCCO_TABLE_7}), scaling))
    print(f"trace and compile or load  {time.perf_counter() - start:6.2f} s")
    for threads in (1, 2):
        times = []
        for _ in range(3):
            start = time.perf_counter()
            found = compute_global_isotropy(kernel, poses, n_threads=threads)
            times.append(time.perf_counter() - start)
        print(f"{len(poses):,} poses, {threads} thread(s)  {min(times):6.2f} s  index {found.index:.6f}")


if __name__ == "__main__":
    main()
