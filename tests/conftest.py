"""Shared fixtures: one seeded generator, every mechanism of the catalogue, and the default design's solids."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.designs import catalogue


@pytest.fixture
def rng():
    return np.random.default_rng(20041)


@pytest.fixture(params=catalogue.names())
def each_mechanism(request):
    return catalogue.entry(request.param).default_design().mechanism


@pytest.fixture(params=catalogue.names())
def each_design(request):
    return catalogue.entry(request.param).default_design()


@pytest.fixture
def feasible_poses(rng):
    """Reachable poses of a mechanism from far beyond its declared workspace, so that every region is visited."""

    def draw(design, n):
        lower, upper = design.box()
        middle, half = (lower + upper) / 2.0, (upper - lower) / 2.0
        # Beyond the declared box in every coordinate: positions 5 times, turns 4 times as far.
        stretch = np.where([c.unit == "mm" for c in design.mechanism.task], 5.0, 4.0)
        kept = np.empty((0, len(lower)))
        while len(kept) < n:
            poses = middle + rng.uniform(-1.0, 1.0, (20 * n, len(lower))) * half * stretch
            kept = np.concatenate([kept, poses[design.mechanism.solve_inverse(poses).is_reachable]])
        return kept[:n]

    return draw
