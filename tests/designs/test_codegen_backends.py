"""One table of poses through every form of a mechanism's formulas: numpy, LLVM, C, JavaScript say the same."""

from __future__ import annotations

import ctypes
import shutil
import subprocess

import numpy as np
import pytest

from linkwright.designs.codegen.emit_c99 import emit_c99
from linkwright.designs.codegen.emit_js import emit_js
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.trace import trace_mechanism
from linkwright.designs.language.vocabulary import Requirements

STRICT = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic"]


def least_margins(mechanism, poses):
    """Of the formulas alone, and the status by the house's rule."""
    need = Requirements()
    with np.errstate(all="ignore"):
        mechanism.solve_state(tuple(np.moveaxis(poses, -1, 0)), mechanism.read_branch(None), need)
    margins = need.stacked((len(poses),))
    legal = np.isfinite(margins) & (margins >= 0.0)
    status = np.where(legal.all(-1), 0, np.argmin(legal, axis=-1) + 1)
    return margins, np.where(np.isfinite(poses).all(-1), status, -1)


def cases(mechanism, box, rng):
    """Home, in and out of reach, either side of every limit met on the way, and what is no number."""
    lower, upper = box
    size = upper - lower
    inside = mechanism.home + size * rng.uniform(-1.5, 1.5, (150, len(size)))
    way = rng.normal(size=(60, len(size)))
    far = size * way / np.linalg.norm(way, axis=-1, keepdims=True) * 30.0
    low, high = np.zeros(len(far)), np.ones(len(far))
    for _ in range(60):
        middle = 0.5 * (low + high)
        is_in = least_margins(mechanism, mechanism.home + middle[:, None] * far)[1] == 0
        low, high = np.where(is_in, middle, low), np.where(is_in, high, middle)
    shares = (0.9, 1.0 - 1e-4, 1.0 - 1e-7, 1.0 + 1e-7, 1.0 + 1e-4, 1.3)
    near = [mechanism.home + (low * share)[:, None] * far for share in shares]
    bad = np.tile(mechanism.home, (4, 1))
    bad[0, 0], bad[1, -1], bad[2, 1], bad[3, 0] = np.nan, np.nan, np.inf, -np.inf
    return np.concatenate([mechanism.home[None], inside, *near, mechanism.home[None] + 50.0 * size, bad])


def run_c(program, poses, folder):
    source, library = folder / "k.c", folder / "k.so"
    source.write_text(emit_c99(program), encoding="utf-8")
    subprocess.run(["gcc", *STRICT, "-O1", "-shared", "-fPIC", "-o", library, source, "-lm"], check=True)
    function = getattr(ctypes.CDLL(str(library)), program.name)
    function.argtypes = [ctypes.c_void_p] * 3
    out = np.full((len(poses), len(program.results)), 7.0)
    status = [function(poses[k:].ctypes.data, None, out[k:].ctypes.data) for k in range(len(poses))]
    return np.array(status), out


def run_js(program, poses, folder):
    poses.tofile(folder / "in.bin")
    script = folder / "k.js"
    n, m = poses.shape[1], len(program.results)
    script.write_text(
        emit_js(program)
        + "const fs = require('fs');\n"
        + f"const b = fs.readFileSync('{folder}/in.bin');\n"
        + "const x = new Float64Array(b.buffer, b.byteOffset, b.length / 8);\n"
        + f"const rows = x.length / {n}, all = new Float64Array(rows * {m + 1}).fill(7);\n"
        + f"for (let k = 0; k < rows; ++k) {{ all[k * {m + 1}] = {program.name}(x.subarray(k * {n}, k * {n} + {n}), "
        + f"[], all.subarray(k * {m + 1} + 1, (k + 1) * {m + 1})); }}\n"
        + f"fs.writeFileSync('{folder}/out.bin', new Uint8Array(all.buffer));\n",
        encoding="utf-8",
    )
    subprocess.run(["node", script], check=True)
    all_ = np.fromfile(folder / "out.bin").reshape(len(poses), m + 1)
    return all_[:, 0], all_[:, 1:]


@pytest.fixture
def each_mechanism(each_design):
    """The mechanism of the same design: two fixtures with parameters of their own would mix them."""
    return each_design.mechanism


@pytest.fixture
def table(each_design, rng):
    return cases(each_design.mechanism, each_design.box(), rng)


@pytest.fixture
def reference(each_mechanism, table):
    margins, status = least_margins(each_mechanism, table)
    with np.errstate(all="ignore"):
        finite = np.where(np.isfinite(table), table, 0.0)
        joints = each_mechanism.solve_inverse(finite).joints
        rows = each_mechanism.compute_jacobian(finite).reshape(len(table), -1)
        frames = each_mechanism.place_bodies(finite)[:, :, :3].reshape(len(table), -1)
    home = np.abs(margins[0])
    # A set distance from every limit: two percent of the distance at home. Nearer, Jacobians amplify rounding.
    is_clear = (status == 0) & np.all(margins > 0.02 * home, axis=-1)
    assert is_clear.sum() > 40
    assert (status == 0).sum() > is_clear.sum()
    assert (status > 0).sum() > 100
    return margins, status, is_clear, (joints, rows, frames)


def agree(each_mechanism, reference, status, values):
    margins, want, is_clear, (joints, rows, frames) = reference
    # At a limit to the last bit either answer is right.
    decided = ~np.any(np.isfinite(margins) & (np.abs(margins) < 1e-11), axis=-1)
    assert (status == want)[decided].all(), np.flatnonzero((status != want) & decided)
    n, m = joints.shape[1], joints.shape[1] + rows.shape[1]
    angular = np.array([joint.unit == "deg" for joint in each_mechanism.joints])
    miss = values[:, :n] - joints
    miss = np.where(angular, np.mod(miss + np.pi, 2.0 * np.pi) - np.pi, miss)
    scale = np.where(angular, 1.0, np.maximum(np.abs(joints), 1.0))
    assert np.abs(miss / scale)[is_clear].max() < 1e-12
    for got, good in ((values[:, n:m], rows), (values[:, m:], frames)):
        size = np.abs(good).max(axis=-1, keepdims=True)
        assert np.max(np.abs(got - good)[is_clear] / size[is_clear]) < 1e-12
    legal = status == 0
    assert np.isfinite(values[legal]).all()


@pytest.mark.parametrize("is_strict", [False, True])
def test_llvm_says_what_numpy_says(each_mechanism, table, reference, is_strict):
    result = Kernel(trace_mechanism(each_mechanism), is_strict=is_strict)(table)
    values = np.concatenate([v.reshape(len(table), -1) for v in result.outputs.values()], axis=-1)
    assert np.isfinite(values).all()
    assert not np.isnan(result.margins).any()
    agree(each_mechanism, reference, result.status, values)


@pytest.mark.skipif(shutil.which("gcc") is None, reason="no gcc")
def test_strict_c_says_what_numpy_says_and_leaves_out_untouched_otherwise(each_mechanism, table, reference, tmp_path):
    status, values = run_c(trace_mechanism(each_mechanism), table, tmp_path)
    agree(each_mechanism, reference, status, values)
    assert (values[status != 0] == 7.0).all()


@pytest.mark.skipif(shutil.which("node") is None, reason="no node")
def test_javascript_says_what_numpy_says_and_leaves_out_untouched_otherwise(each_mechanism, table, reference, tmp_path):
    status, values = run_js(trace_mechanism(each_mechanism), table, tmp_path)
    agree(each_mechanism, reference, status, values)
    assert (values[status != 0] == 7.0).all()


def test_the_formulas_on_plain_floats_say_the_same(each_mechanism, table, reference):
    program = trace_mechanism(each_mechanism)
    clear = np.flatnonzero(reference[2])[:20]
    for k in clear:
        values = program.evaluate([float(x) for x in table[k]])
        flat = np.array([float(v) for part in values.outputs.values() for v in part])
        agree_one = np.abs(flat - np.concatenate([part[k] for part in reference[3]]))
        assert agree_one.max() < 1e-12 * max(1.0, np.abs(flat).max())


def test_all_branches_agree_with_numpy(each_mechanism, rng):
    poses = each_mechanism.home + 1e-2 * rng.uniform(-1.0, 1.0, (40, len(each_mechanism.task)))
    for branch in each_mechanism.branches:
        result = Kernel(trace_mechanism(each_mechanism, ("joints",), branch))(poses)
        joints = each_mechanism.solve_inverse(poses, branch).joints
        miss = np.mod(result.outputs["joints"] - joints + np.pi, 2.0 * np.pi) - np.pi
        assert np.abs(miss[result.is_legal]).max(initial=0.0) < 1e-10


def test_limits_make_the_status_of_solve_inverse(each_mechanism, table):
    program = trace_mechanism(each_mechanism, ("joints",), has_limits=True)
    inverse = each_mechanism.solve_inverse(table)
    assert tuple(m.name for m in program.margins) == inverse.requirements
    decided = ~np.any(np.abs(inverse.margins) < 1e-11, axis=-1)
    assert (Kernel(program)(table).is_legal == inverse.is_reachable)[decided].all()
