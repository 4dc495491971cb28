"""Forward kinematics derived from the inverse, and the linear solver in it."""

from __future__ import annotations

import shutil

import numpy as np
import pytest
from numpy.linalg import cond, solve

from linkwright.designs.codegen.forward import NotSquareError, trace_forward
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.linear import solve_linear
from linkwright.designs.codegen.trace import trace_formula, trace_mechanism


@pytest.fixture
def paths(each_design, rng):
    """Poses and where the mechanism was a moment before."""
    mechanism = each_design.mechanism
    if mechanism.n_active != len(mechanism.task):
        with pytest.raises(NotSquareError, match="as many driven joints"):
            trace_forward(mechanism)
        pytest.skip("redundant")
    lower, upper = each_design.box()
    poses = rng.uniform(lower, upper, (400, len(lower)))
    start = poses + rng.normal(size=poses.shape) * [1.5 if c.unit == "mm" else 0.01 for c in mechanism.task]
    active = Kernel(trace_mechanism(mechanism, ("active",)))(poses)
    return mechanism, poses, np.concatenate([active.outputs["active"], start], axis=-1)


def test_the_derived_forward_returns_the_pose(paths):
    mechanism, poses, inputs = paths
    result = Kernel(trace_forward(mechanism))(inputs)
    assert result.is_legal.mean() > 0.99
    assert np.abs(result.outputs["pose"] - poses)[result.is_legal].max() < 1e-8


def test_the_answer_keeps_the_joint_values_whatever_the_start(paths, rng):
    mechanism, poses, inputs = paths
    n = poses.shape[1]
    inputs = inputs.copy()
    inputs[:, n:] = mechanism.home + rng.normal(size=poses.shape) * [
        40.0 if c.unit == "mm" else 0.5 for c in mechanism.task
    ]
    inputs[:5, 0] = np.nan
    inputs[5:10, n] = 1e9
    result = Kernel(trace_forward(mechanism))(inputs)
    assert (result.status[:5] == -1.0).all()
    assert np.isfinite(result.outputs["pose"]).all()
    back = Kernel(trace_mechanism(mechanism, ("active",)))(result.outputs["pose"][result.is_legal]).outputs["active"]
    angular = np.array([joint.unit == "deg" for joint in mechanism.joints[:n]])
    miss = back - inputs[result.is_legal, :n]
    miss = np.where(angular, np.mod(miss + np.pi, 2.0 * np.pi) - np.pi, miss / 100.0)
    assert result.is_legal.sum() > 10
    assert np.abs(miss).max() < 1e-10


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
def test_the_loop_in_c_gives_the_same_poses(paths, tmp_path):
    import ctypes
    import subprocess

    from linkwright.designs.codegen.emit_c99 import emit_c99

    mechanism, _, inputs = paths
    program = trace_forward(mechanism)
    source, library = tmp_path / "f.c", tmp_path / "f.so"
    source.write_text(emit_c99(program), encoding="utf-8")
    strict = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]
    subprocess.run(["gcc", *strict, "-O1", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
    function = getattr(ctypes.CDLL(str(library)), program.name)
    function.argtypes = [ctypes.c_void_p] * 3
    out = np.zeros((len(inputs), len(program.results)))
    status = np.array([function(inputs[k:].ctypes.data, None, out[k:].ctypes.data) for k in range(len(inputs))])
    batch = Kernel(program)(inputs)
    assert (status == batch.status).mean() > 0.99
    both = (status == 0) & batch.is_legal
    assert np.abs(out - batch.outputs["pose"])[both].max() < 1e-8


@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_linear_equations_are_solved_with_pivots(n, rng):
    A, b = rng.normal(size=(2000, n, n)), rng.normal(size=(2000, n))
    A[:200, 0, 0] = 0.0
    names = [f"x{k}" for k in range(n * n + n)]
    kernel = Kernel(
        trace_formula(
            "f", names, [], lambda x, p, r: {"x": solve_linear([x[n * i : n * i + n] for i in range(n)], x[n * n :])}
        )
    )
    if n == 1:
        A[:200] += 1.0
    got = kernel(np.concatenate([A.reshape(2000, -1), b], axis=-1)).outputs["x"]
    want = solve(A, b[..., None])[..., 0]
    error = np.linalg.norm(got - want, axis=-1) / np.linalg.norm(want, axis=-1)
    assert np.max(error / cond(A)) < 1e-14
