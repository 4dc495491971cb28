"""Extreme singular values and the threshold test against numpy's SVD."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.singular import exceeds, singular_values, with_singular_values, with_threshold
from linkwright.designs.codegen.trace import trace_formula, trace_mechanism

SHAPES = [(6, 6), (6, 5), (5, 6), (3, 3), (2, 2), (3, 6), (1, 3)]


def kernel_of(shape, formula, parameters=()):
    m, n = shape

    def rows(x, p, require):
        return {"y": formula([x[n * i : n * i + n] for i in range(m)], *p)}

    return Kernel(trace_formula("f", [f"a{k}" for k in range(m * n)], parameters, rows))


def extremes(matrices):
    return np.linalg.svd(matrices, compute_uv=False)[:, [-1, 0]]


@pytest.mark.parametrize("shape", SHAPES)
def test_both_ends_equal_those_of_the_svd(shape, rng):
    A = rng.normal(size=(4000, *shape)) * np.exp(rng.normal(size=(4000, 1, 1)) * 4.0)
    want = extremes(A)
    got = kernel_of(shape, lambda rows: list(singular_values(rows)))(A.reshape(len(A), -1)).outputs["y"]
    relative = np.abs(got / want - 1.0)
    assert relative[:, 1].max() < 1e-13
    # The Gram matrix squares the condition number.
    assert np.max(relative[:, 0] / (1.0 + (want[:, 1] / want[:, 0]) ** 2)) < 1e-14


@pytest.mark.parametrize("multiplicity", [2, 3, 4, 5, 6])
@pytest.mark.parametrize("spread", [0.0, 1e-12, 1e-8, 1e-4, 1e-2])
def test_clustered_singular_values_are_found_too(multiplicity, spread, rng):
    U, V = np.linalg.qr(rng.normal(size=(2, 200, 6, 6)))[0]
    sigma = np.tile(np.linspace(2.0, 3.0, 6), (200, 1))
    sigma[:, :multiplicity] = 1.0 + spread * rng.uniform(size=(200, multiplicity))
    for values in (sigma, 4.0 - sigma):
        A = U * values[:, None, :] @ V
        got = kernel_of((6, 6), lambda rows: list(singular_values(rows)))(A.reshape(200, 36)).outputs["y"]
        assert np.abs(got - np.stack([values.min(-1), values.max(-1)], -1)).max() < 1e-12


def test_singular_and_zero_matrices_give_zero(rng):
    kernel = kernel_of((6, 6), lambda rows: list(singular_values(rows)))
    A = rng.normal(size=(64, 6, 6))
    A[:, 5] = A[:, 4] - 2.0 * A[:, 0]
    A[0] = 0.0
    A[1] = np.diag([1.0, 2.0, 3.0, 0.0, 5.0, 6.0])
    A[2] = np.outer(A[2, 0], A[2, 1])
    result = kernel(A.reshape(64, 36))
    assert result.is_legal.all()
    assert result.outputs["y"][:, 0].max() < 1e-6
    assert np.abs(result.outputs["y"][:, 1] - extremes(A)[:, 1]).max() < 1e-12


def test_a_pose_is_answered_alike_in_any_company(rng):
    A = np.concatenate([rng.normal(size=(60, 36)), np.tile(np.eye(6).ravel(), (4, 1))])
    kernel = kernel_of((6, 6), lambda rows: list(singular_values(rows)))
    whole = kernel(A).outputs["y"]
    alone = np.concatenate([kernel(A[k : k + 1]).outputs["y"] for k in range(len(A))])
    assert (whole == alone).all()


@pytest.mark.parametrize("shape", [s for s in SHAPES if s != (1, 3)])
def test_the_threshold_form_decides_like_the_svd(shape, rng):
    A = rng.normal(size=(4000, *shape))
    low = extremes(A)[:, 0]
    kernel = kernel_of(shape, exceeds, ["t"])
    for t in np.quantile(low, [0.05, 0.5, 0.95]):
        result = kernel(A.reshape(len(A), -1), [t])
        assert result.is_legal.all()
        decided = np.abs(low / t - 1.0) > 1e-10
        assert ((result.outputs["y"] > 0.0) == (low > t))[decided].all()
        assert 0.02 < np.mean(result.outputs["y"] > 0.0) < 0.98


def test_factors_of_rows_do_not_change_the_decision(rng):
    A = rng.normal(size=(4000, 6, 7))

    def rows(x, p, require):
        plain = [[x[7 * i + j] for j in range(6)] for i in range(6)]
        scaled = [[v / (x[7 * i + 6] * 0.5) if i % 2 else -(v * x[7 * i + 6]) for v in r] for i, r in enumerate(plain)]
        return {"jacobian": scaled}

    program = with_threshold(trace_formula("f", [f"a{k}" for k in range(42)], [], rows)).keep("above")
    factor = A[:, :, 6:]
    low = extremes(A[:, :, :6] * np.where(np.arange(6)[:, None] % 2, 2.0 / factor, factor))[:, 0]
    for t in np.quantile(low, [0.1, 0.5, 0.9]):
        above = Kernel(program)(A.reshape(4000, 42), [t]).outputs["above"]
        decided = np.abs(low / t - 1.0) > 1e-9
        assert ((above > 0.0) == (low > t))[decided].all()


def test_a_matrix_that_is_not_finite_is_no_decision():
    kernel = kernel_of((2, 2), exceeds, ["t"])
    result = kernel(np.array([[1.0, 0.0, 0.0, 1e200], [1.0, 0.0, 0.0, 2.0]]), [0.5])
    assert result.status.tolist() == [-1.0, 0.0]
    assert result.outputs["y"].tolist() == [0.0, 1.0]


def test_the_same_formula_runs_on_batches_of_numbers(rng):
    A = rng.normal(size=(50, 6, 6))
    low, high = singular_values([[A[:, i, j] for j in range(6)] for i in range(6)])
    assert np.abs(np.stack([low, high], -1) - extremes(A)).max() < 1e-9


def test_fused_with_the_jacobian_of_every_mechanism(each_design, feasible_poses):
    mechanism = each_design.mechanism
    poses = feasible_poses(each_design, 500)
    program = trace_mechanism(mechanism, ("active", "jacobian"))
    J = mechanism.compute_jacobian(poses)
    scale = [1.0] * J.shape[-1] if J.shape[-1] < 6 else [1.0] * 3 + [1.0 / 120.0] * (J.shape[-1] - 3)
    if min(J.shape[1:]) > 6:
        pytest.skip("more than six singular values")
    want = extremes(J * np.array(scale))
    got = Kernel(with_singular_values(program, scale))(poses).outputs["sigma"]
    kappa2 = (want[:, 1] / want[:, 0]) ** 2
    assert np.max(np.abs(got / want - 1.0) / (1.0 + kappa2[:, None])) < 1e-13
    t = float(np.median(want[:, 0]))
    above = Kernel(with_threshold(program, scale).keep("above"))(poses, [t]).outputs["above"] > 0.0
    decided = np.abs(want[:, 0] / t - 1.0) > 1e-9
    assert (above == (want[:, 0] > t))[decided].all()
