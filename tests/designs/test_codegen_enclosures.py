"""Enclosures hold every sample, inside reach, across its limits and outside, and are not much wider than needed."""

from __future__ import annotations

import itertools

import numpy as np
import pytest

from linkwright.designs.codegen.enclosures import UnboundedLoopError, enclose
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.singular import with_singular_values
from linkwright.designs.codegen.trace import trace_formula, trace_mechanism
from linkwright.designs.language import vocabulary as v

#: What the float evaluation itself may be off.
SLACK = 1e-12


def half_sides(mechanism):
    return np.array([5.0 if c.unit == "mm" else np.radians(1.0) for c in mechanism.task])


def corners_and_samples(lower, upper, rng, n):
    k = lower.shape[1]
    for corner in itertools.islice(itertools.product((0.0, 1.0), repeat=k), 64):
        yield lower + np.array(corner) * (upper - lower)
    for _ in range(n):
        yield lower + rng.uniform(size=lower.shape) * (upper - lower)


def check(program, lower, upper, rng, is_affine, n):
    bounds = enclose(program, lower, upper, is_affine=is_affine)
    kernel = Kernel(program)
    least, most = {}, {}
    for poses in corners_and_samples(lower, upper, rng, n):
        result = kernel(poses)
        legal = result.is_legal
        assert not (bounds.is_inside & ~legal).any()
        assert not (bounds.is_outside & legal).any()
        assert (result.margins >= bounds.margins_lower - SLACK * (1.0 + np.abs(result.margins))).all()
        assert (result.margins <= bounds.margins_upper + SLACK * (1.0 + np.abs(result.margins))).all()
        for name, values in result.outputs.items():
            low, high = bounds.outputs[name]
            slack = SLACK * (1.0 + np.abs(values))
            held = (values >= low - slack) & (values <= high + slack)
            assert held[legal].all(), name
            least[name] = np.minimum(least.get(name, np.inf), values)
            most[name] = np.maximum(most.get(name, -np.inf), values)
    widths = {
        name: float(np.median((high - low) / np.maximum(most[name] - least[name], 1e-9)))
        for name, (low, high) in bounds.outputs.items()
    }
    return bounds, widths


@pytest.mark.parametrize("is_affine", [False, True])
def test_enclosures_inside_reach_hold_all_samples_and_certify(each_design, rng, is_affine):
    mechanism = each_design.mechanism
    # A determinant among the margins needs smaller boxes than lengths do.
    half = 0.2 * half_sides(mechanism)
    centres = mechanism.home + half * rng.uniform(-4.0, 4.0, (40, len(half)))
    program = trace_mechanism(mechanism, ("active", "jacobian"))
    bounds, widths = check(program, centres - half, centres + half, rng, is_affine, 100)
    if is_affine:
        assert bounds.is_inside.mean() > 0.9
        assert widths["active"] < 1.6
        assert widths["jacobian"] < 3.0


@pytest.mark.parametrize("is_affine", [False, True])
def test_enclosures_across_the_limits_are_sound(each_design, rng, is_affine):
    mechanism = each_design.mechanism
    half = half_sides(mechanism)
    lower, upper = each_design.box()
    centres = mechanism.home + 4.0 * (upper - lower) * rng.uniform(-1.0, 1.0, (600, len(half)))
    program = trace_mechanism(mechanism, ("active", "jacobian"))
    bounds, _ = check(program, centres - half, centres + half, rng, is_affine, 40)
    undecided = ~bounds.is_inside & ~bounds.is_outside
    assert undecided.any(), "no box lies across a limit: the test looks at nothing"
    assert bounds.is_outside.any()


@pytest.mark.parametrize("is_affine", [False, True])
def test_a_box_of_no_size_holds_the_value_and_little_else(each_mechanism, is_affine):
    pose = each_mechanism.home[None] + 0.01
    program = trace_mechanism(each_mechanism, ("joints", "jacobian"))
    bounds, value = enclose(program, pose, pose, is_affine=is_affine), Kernel(program)(pose)
    for name, (low, high) in bounds.outputs.items():
        assert (low <= value.outputs[name] + 1e-14).all()
        assert (high >= value.outputs[name] - 1e-14).all()
        assert (high - low).max() < 1e-9


FORMULAS = {
    "arithmetic": lambda x, y: x * y - y / (x + 0.3) + x * x - 2.0 / y,
    "roots": lambda x, y: v.sqrt(x) + v.sqrt(x * x - y) + v.hypot(x, y),
    "waves": lambda x, y: v.sin(3.0 * x) * v.cos(4.0 * y) + v.sin(x * y),
    "atan2": v.atan2,
    "arcs": lambda x, y: v.acos(x) + v.asin(y * 0.9) + v.acos(x * y),
    "ends": lambda x, y: v.fmin(x, y) + v.fmax(x * y, 0.3) + v.fabs(x - y),
    "where": lambda x, y: v.where((x > y) & (y > -1.0) | ~(x < 2.0), x * y, v.where(y < 0.0, 1.0, 2.0)),
}


@pytest.mark.parametrize("is_affine", [False, True])
@pytest.mark.parametrize("name", FORMULAS)
def test_every_word_is_enclosed_across_its_domain(name, is_affine, rng):
    program = trace_formula("f", ["x", "y"], [], lambda x, p, require: {"f": FORMULAS[name](*x)})
    centres, half = rng.uniform(-3.0, 3.0, (2000, 2)), np.exp(rng.uniform(-6.0, 0.5, (2000, 2)))
    lower, upper = centres - half, centres + half
    low, high = enclose(program, lower, upper, is_affine=is_affine).outputs["f"]
    assert not np.isnan(low).any()
    for poses in corners_and_samples(lower, upper, rng, 200):
        with np.errstate(all="ignore"):
            got = np.broadcast_to(program.evaluate(poses.T).outputs["f"][0], low.shape)
        fine = np.isfinite(got)
        slack = 1e-14 * (1.0 + np.abs(got))
        assert ((got >= low - slack) & (got <= high + slack))[fine].all()


def test_a_loop_is_refused(each_mechanism):
    program = with_singular_values(trace_mechanism(each_mechanism, ("jacobian",)))
    if min(program.output("jacobian").shape) < 3:
        pytest.skip("two singular values need no loop")
    with pytest.raises(UnboundedLoopError, match="cannot be enclosed"):
        enclose(program, each_mechanism.home[None], each_mechanism.home[None])


def test_corners_the_wrong_way_round_are_refused(each_mechanism):
    program = trace_mechanism(each_mechanism, ("joints",))
    with pytest.raises(ValueError, match="lower <= upper"):
        enclose(program, each_mechanism.home[None], each_mechanism.home[None] - 1.0)
