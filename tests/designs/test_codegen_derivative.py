"""Derivatives made from the formulas equal the Jacobian that the author wrote, and finite differences."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.designs.codegen.derivative import differentiate, twist_seeds
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.trace import trace_formula, trace_mechanism
from linkwright.designs.language import vocabulary as v


@pytest.fixture
def each_mechanism(each_design):
    """The mechanism of the same design: two fixtures with parameters of their own would mix them."""
    return each_design.mechanism


@pytest.fixture
def poses(each_design, feasible_poses, rng):
    mechanism = each_design.mechanism
    lower, upper = each_design.box()
    near = mechanism.home + 0.3 * (upper - lower) * rng.uniform(-1.0, 1.0, (400, len(lower)))
    return near[mechanism.solve_inverse(near).is_reachable]


def test_the_derived_jacobian_is_the_written_one(each_mechanism, poses):
    program = trace_mechanism(each_mechanism, ("active", "jacobian"))
    if [c.name for c in each_mechanism.task[:6]] == ["x", "y", "z", "rx", "ry", "rz"]:
        seeds = twist_seeds(program)
    elif program.output("jacobian").shape[-1] == len(program.inputs):
        seeds = None
    else:
        pytest.skip("its velocity is neither a twist nor plain rates")
    derived = Kernel(differentiate(program, ["active"], seeds))(poses)
    J, got = derived.outputs["jacobian"], derived.outputs["d_active"]
    assert derived.is_legal.all()
    size = np.abs(J).max(axis=(1, 2), keepdims=True)
    assert np.max(np.abs(got - J) / size) < 1e-10


def test_derivatives_equal_finite_differences(each_mechanism, poses):
    poses = poses[:100]
    program = trace_mechanism(each_mechanism, ("joints",), has_limits=True)
    result = Kernel(differentiate(program, ["joints", "margins"]))(poses)
    plain = Kernel(program)
    for k, coordinate in enumerate(each_mechanism.task):
        h = 1e-2 if coordinate.unit == "mm" else 1e-4
        at = [plain(poses + i * h * np.eye(len(each_mechanism.task))[k]) for i in (-2, -1, 1, 2)]
        for name, of in (("d_joints", lambda r: r.outputs["joints"]), ("d_margins", lambda r: r.margins)):
            values = [of(r) for r in at]
            slope = (values[0] - 8.0 * values[1] + 8.0 * values[2] - values[3]) / (12.0 * h)
            miss = np.abs(slope - result.outputs[name][:, :, k])
            # Cones near their axis and angles near their cut have no derivative to compare with.
            smooth = np.max([np.abs(a - b) for a in values for b in values], axis=0) < 1.0
            size = np.maximum(np.abs(result.outputs[name][:, :, k]), 1e-3 if coordinate.unit == "mm" else 1.0)
            assert np.quantile((miss / size)[smooth], 0.999) < 1e-5


FORMULAS = {
    "quotient": lambda x, y: x / (y + 3.0) - y * x,
    "sqrt": lambda x, y: v.sqrt(x * x + y + 2.0),
    "hypot": lambda x, y: v.hypot(x + 2.0, y),
    "sin": lambda x, y: v.sin(x * y) + v.cos(x - y),
    "atan2": lambda x, y: v.atan2(x + 0.5, y - 2.0),
    "acos": lambda x, y: v.acos(0.5 * x) + v.asin(0.5 * y * x),
    "fabs": lambda x, y: v.fabs(x - 3.0) + v.fabs(y + 3.0),
    "fmin": lambda x, y: v.fmin(x * y, x + 2.0 * y) + v.fmax(x * x, y - 4.0 * x),
    "where": lambda x, y: v.where(x > y, x * x * y, v.sin(y)),
}


@pytest.mark.parametrize("name", FORMULAS)
def test_every_word_of_the_vocabulary_has_its_derivative(name, rng):
    program = trace_formula("f", ["x", "y"], [], lambda x, p, require: {"f": FORMULAS[name](*x)})
    slopes = differentiate(program, ["f"])
    x = rng.uniform(-1.0, 1.0, (2, 200))
    got = np.array([np.broadcast_to(d, 200) for d in slopes.evaluate(x).outputs["d_f"]])
    h = 1e-5
    for k in range(2):
        step = h * np.eye(2)[k][:, None]
        up, down = (program.evaluate(x + s * step).outputs["f"][0] for s in (1.0, -1.0))
        assert np.median(np.abs((up - down) / (2.0 * h) - got[k])) < 1e-9
        assert np.mean(np.abs((up - down) / (2.0 * h) - got[k]) > 1e-6) < 0.02  # kinks
