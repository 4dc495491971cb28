"""The graph of a formula: nothing twice, constants folded, no branch on a traced number, the same text every time."""

from __future__ import annotations

import dataclasses
import subprocess
import sys

import numpy as np
import pytest

from linkwright.designs import catalogue
from linkwright.designs.codegen.emit_c99 import emit_c99
from linkwright.designs.codegen.emit_js import emit_js
from linkwright.designs.codegen.emit_llvm import emit_llvm
from linkwright.designs.codegen.graph import TracedBranchError, order_of
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.passes import eliminated, prepared
from linkwright.designs.codegen.schedule import scheduled
from linkwright.designs.codegen.trace import (
    FixedParametersError,
    parameter_values,
    trace_formula,
    trace_mechanism,
)
from linkwright.designs.hit.mechanism import Hit
from linkwright.designs.language.errors import UnknownNameError
from linkwright.designs.language.vocabulary import acos, atan2, cos, fabs, fmax, fmin, hypot, sin, sqrt, where


def trace(formula, n=2, n_parameters=0):
    names = [f"x{k}" for k in range(n)], [f"p{k}" for k in range(n_parameters)]
    return trace_formula("f", *names, lambda x, p, require: {"y": formula(*x, *p)})


def text_of(program):
    return emit_llvm(program).text, emit_c99(program), emit_js(program)


def test_equal_operations_are_one_node_and_order_of_commuting_arguments_does_not_matter():
    program = trace(lambda x, y: [x * y + 1.0, y * x + 1.0])
    assert program.results[0] is program.results[1]


def test_constants_fold_and_neutral_elements_vanish():
    program = trace(lambda x, y: [x * 1.0 + 0.0 * y, sqrt(4.0 + x * 0.0), x - x, np.float64(2.0) * x])
    assert program.results[0].op == "input"
    assert program.results[1].is_const(2.0)
    assert program.results[2].is_const(0.0)
    assert program.results[3].op == "mul"


@pytest.mark.parametrize(
    "formula",
    [lambda x, y: x if x > y else y, lambda x, y: float(x), lambda x, y: x**0.5, lambda x, y: x * float("nan")],
)
def test_a_formula_that_asks_for_a_value_is_refused(formula):
    with pytest.raises(TracedBranchError, match="formula asked for"):
        trace(formula)


def test_cosines_of_sums_of_arcs_hold_no_trigonometry():
    program = trace(lambda x, y: [cos(atan2(y, x) + acos(x / 9.0)), sin(2.0 * atan2(y, x) - acos(y / 9.0) + 0.3)])
    got = eliminated(program)
    assert not {"cos", "sin", "atan2", "acos"} & {node.op for node in got.order()}
    at = np.array([3.0]), np.array([-4.0])
    for a, b in zip(program.evaluate(at).outputs["y"], got.evaluate(at).outputs["y"], strict=True):
        assert abs(a - b) < 1e-15


def test_an_angle_that_cancels_is_not_computed():
    program = eliminated(trace(lambda x, y: cos((atan2(y, x) + acos(x)) - (atan2(y, x) - acos(y)))))
    assert "hypot" not in {node.op for node in program.order()}


@pytest.mark.parametrize("name", ["fmin", "fmax", "sqrt", "acos", "where", "hypot"])
def test_nan_passes_through_every_guard(name):
    formulas = {
        "fmin": lambda x, y: [fmin(x, y), fmin(y, x), fmin(x, 1.0), fmin(1.0, x)],
        "fmax": lambda x, y: [fmax(x, y), fmax(y, x), fmax(x, -1.0), fmax(-1.0, x)],
        "sqrt": lambda x, y: [sqrt(x), sqrt(x - y)],
        "acos": lambda x, y: [acos(x), acos(x + y)],
        "where": lambda x, y: [where(y > 0.0, x, y)],
        "hypot": lambda x, y: [hypot(x, y)],
    }
    program = prepared(trace(lambda x, y: formulas[name](x / (y - y * 1.0 + (y - 1.0)), y)), is_polynomial=True)
    kernel = Kernel(
        trace_formula(
            "f",
            ["x", "y"],
            [],
            lambda v, p, require: (
                require(formulas[name]((v[0] - v[0] * v[1]) / (v[1] - 1.0), v[1])[0], name) or {"y": v[0]}
            ),
        )
    )
    assert program.results
    # 0/0 for y = 1: the margin is NaN, so the pose is illegal.
    assert kernel(np.array([[3.0, 1.0]])).status[0] == 1.0
    assert kernel(np.array([[3.0, 1.0]])).margins[0, 0] == -np.inf


@pytest.fixture
def traced(each_mechanism):
    return trace_mechanism(each_mechanism)


def test_tracing_again_or_after_another_mechanism_gives_the_same_text(each_mechanism, traced):
    trace_mechanism(Hit({}), ("joints",), "down-in")
    assert text_of(trace_mechanism(each_mechanism)) == text_of(traced)


def test_another_process_with_another_hash_seed_prints_the_same_text():
    code = (
        "import hashlib; from linkwright.designs.hit.mechanism import Hit;"
        "from linkwright.designs.codegen.trace import trace_mechanism; from linkwright.designs.codegen import singular;"
        "from linkwright.designs.codegen.emit_llvm import emit_llvm; from linkwright.designs.codegen.emit_c99 import *;"
        "p = singular.with_singular_values(trace_mechanism(Hit({}), has_symbols=True));"
        "print(hashlib.sha256((emit_llvm(p).text + emit_c99(p)).encode()).hexdigest())"
    )
    runs = [
        subprocess.run([sys.executable, "-c", code], env={"PYTHONHASHSEED": seed}, capture_output=True, check=True)
        for seed in ("1", "2")
    ]
    assert runs[0].stdout == runs[1].stdout
    assert len(runs[0].stdout) == 65


def test_outputs_that_are_not_asked_for_are_not_printed(traced):
    assert len(traced.keep("joints").order()) < len(traced.order())


def test_an_unknown_output_is_refused_with_the_known_ones(each_mechanism):
    with pytest.raises(UnknownNameError, match="frames"):
        trace_mechanism(each_mechanism, ("torques",))


def test_a_program_with_symbols_serves_other_dimensions():
    kernel = Kernel(trace_mechanism(Hit({}), has_symbols=True))
    section = dataclasses.replace(
        Hit({}).parameters, upper_link_length=171.0, base_radius=131.0, pivot_height=31.0, lower_offset_angle=0.4
    )
    other = Hit({"parameters": section})
    poses = other.home + np.random.default_rng(5).uniform(-0.1, 0.1, (20, 6)) * [300.0, 300.0, 300.0, 3.0, 3.0, 3.0]
    result = kernel(poses, parameter_values(other))
    assert result.is_legal.all()
    assert np.abs(result.outputs["joints"] - other.solve_inverse(poses).joints).max() < 1e-13
    assert np.abs(result.outputs["frames"] - other.place_bodies(poses)[:, :, :3]).max() < 1e-11


@pytest.mark.parametrize("name", ["inoue", "stewart"])
def test_symbols_are_refused_for_outputs_that_hang_on_numbers_fixed_at_building(name):
    mechanism = catalogue.entry(name).default_design().mechanism
    with pytest.raises(FixedParametersError, match="home_distance") as caught:
        trace_mechanism(mechanism, ("joints",), has_symbols=True)
    assert caught.value.mechanism == name


def test_a_program_with_symbols_follows_every_parameter_of_every_mechanism(each_mechanism):
    m, section = each_mechanism, each_mechanism.sections["parameters"]
    program = trace_mechanism(m, ("active", "jacobian", "frames"), has_symbols=True)
    changed = {name: getattr(section, name) * (1.0 + 1e-3 * k) for k, name in enumerate(program.parameters, start=-3)}
    other = type(m)({**m.sections, "parameters": dataclasses.replace(section, **changed)})
    pose = [float(v) for v in m.home]
    got, want = program.evaluate(pose, parameter_values(other)), trace_mechanism(other).evaluate(pose)
    for name in ("active", "jacobian", "frames"):
        size = len(got.outputs[name])
        assert (
            np.abs(np.subtract(got.outputs[name], want.outputs.get(name, want.outputs["joints"])[:size])).max() < 1e-9
        )


def test_scheduled_nodes_are_those_of_the_order_with_arguments_first(traced):
    program = prepared(traced, is_polynomial=True)
    nodes = scheduled(program.results)
    assert set(nodes) == set(order_of(program.results)) and len(nodes) == len(set(nodes))
    place = {node: k for k, node in enumerate(nodes)}
    assert all(place[a] < place[node] for node in nodes for a in node.args)


def test_the_longest_chain_starts_first():
    program = trace(lambda x, y: [x * 2.0, sqrt(fabs(y)) / 3.0])
    nodes = [node.op for node in scheduled(program.results) if node.args]
    assert nodes.index("fabs") < nodes.index("mul")


def test_the_command_line_imports_no_compiler():
    code = "import sys, linkwright.app.cli; assert not {'llvmlite', 'numba'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
