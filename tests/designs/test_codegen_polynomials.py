"""The polynomials that stand for sin, cos, atan2, acos and asin in the kernels."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.trace import trace_formula
from linkwright.designs.language import vocabulary as v


def values(word, *columns, is_strict=False):
    names = [f"x{k}" for k in range(len(columns))]
    program = trace_formula("f", names, [], lambda x, p, require: {"f": getattr(v, word)(*x)})
    return Kernel(program, is_strict=is_strict)(np.stack(columns, axis=-1)).outputs["f"]


@pytest.mark.parametrize("is_strict", [False, True])
@pytest.mark.parametrize("word", ["sin", "cos"])
def test_sine_and_cosine_are_right_in_the_last_digit(word, is_strict, rng):
    x = np.concatenate(
        [rng.uniform(-np.pi, np.pi, 40000), rng.uniform(-1e4, 1e4, 20000), np.arange(-64, 65) * np.pi / 4]
    )
    assert np.abs(values(word, x, is_strict=is_strict) - getattr(np, word)(x)).max() < 3e-16


@pytest.mark.parametrize("is_strict", [False, True])
def test_arctangent_is_right_in_all_quadrants(is_strict, rng):
    y, x = rng.normal(size=(2, 60000)) * np.exp(rng.normal(size=(2, 60000)) * 5.0)
    want = np.arctan2(y, x)
    assert np.max(np.abs(values("atan2", y, x, is_strict=is_strict) - want) / np.abs(want)) < 6e-16


def test_arctangent_on_the_axes_and_at_the_origin():
    y, x = np.array([[0.0, 0.0], [0.0, 2.0], [0.0, -2.0], [3.0, 0.0], [-3.0, 0.0], [1.0, 1.0], [-1.0, -1.0]]).T
    want = [0.0, 0.0, math.pi, math.pi / 2, -math.pi / 2, math.pi / 4, -3 * math.pi / 4]
    assert np.abs(values("atan2", y, x) - want).max() < 5e-16


@pytest.mark.parametrize("is_strict", [False, True])
@pytest.mark.parametrize(("word", "name"), [("acos", "arccos"), ("asin", "arcsin")])
def test_arccosine_and_arcsine_are_right_up_to_the_ends(word, name, is_strict, rng):
    u = np.concatenate([rng.uniform(-1.0, 1.0, 40000), 1.0 - 10.0 ** rng.uniform(-16, 0, 20000), [-1.0, 0.0, 1.0, 0.5]])
    u = np.concatenate([u, -u])
    want = getattr(np, name)(u)
    got = values(word, u, is_strict=is_strict)
    assert np.max(np.abs(got - want) / np.maximum(np.abs(want), 1e-300)) < 9e-16


def test_beyond_the_ends_the_arguments_are_clamped():
    assert values("acos", np.array([1.5, -1.5])) == pytest.approx([0.0, math.pi], abs=1e-15)
    assert values("sqrt", np.array([-4.0, 4.0])) == pytest.approx([0.0, 2.0], abs=1e-15)
