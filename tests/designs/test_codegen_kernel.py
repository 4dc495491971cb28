"""Kernels as things: batches of any size, threads, wrong shapes, and the cache of machine code."""

from __future__ import annotations

import numpy as np
import pytest

from linkwright.designs.codegen import artefacts
from linkwright.designs.codegen.emit_llvm import emit_llvm
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.trace import trace_formula, trace_mechanism
from linkwright.designs.hit.mechanism import Hit


@pytest.fixture
def cache(tmp_path, monkeypatch):
    monkeypatch.setenv(artefacts.CACHE_VARIABLE, str(tmp_path))
    return tmp_path / "kernels"


@pytest.fixture
def hit():
    return Hit({})


def test_batches_of_any_size_and_any_number_of_threads_agree(hit, rng):
    kernel = Kernel(trace_mechanism(hit, ("active", "jacobian")))
    poses = hit.home + rng.uniform(-1.0, 1.0, (40003, 6)) * [30.0, 30.0, 30.0, 0.2, 0.2, 0.2]
    whole = kernel(poses, n_threads=2)
    for n in (0, 1, 7, 8, 9, 40003):
        part = kernel(poses[:n], n_threads=1)
        assert (part.outputs["jacobian"] == whole.outputs["jacobian"][:n]).all()
        assert (part.status == whole.status[:n]).all()
        assert part.outputs["active"].shape == (n, 6)


def test_a_buffer_can_be_used_again(hit):
    kernel = Kernel(trace_mechanism(hit, ("active",)))
    buffer = kernel.buffer(16)
    poses = np.tile(hit.home, (16, 1))
    assert np.shares_memory(kernel(poses, into=buffer).outputs["active"], buffer)
    with pytest.raises(ValueError, match="buffer"):
        kernel(poses, into=np.zeros((16, 3)))


def test_wrong_shapes_are_refused(hit):
    kernel = Kernel(trace_mechanism(hit, ("active",), has_symbols=True))
    with pytest.raises(ValueError, match=r"needed \(n, 6\)"):
        kernel(np.zeros((3, 5)))
    with pytest.raises(ValueError, match="parameters given"):
        kernel(np.zeros((3, 6)), [1.0])


def test_poses_of_a_slice_are_read_right(hit, rng):
    kernel = Kernel(trace_mechanism(hit, ("active",)))
    poses = hit.home + rng.uniform(-1.0, 1.0, (50, 6)) * 0.1
    assert (kernel(poses[::3]).outputs["active"] == kernel(poses).outputs["active"][::3]).all()


def test_a_result_that_is_not_finite_has_status_minus_one_and_is_cleared():
    program = trace_formula("f", ["x"], [], lambda x, p, require: {"y": [1.0 / x[0], x[0]]})
    result = Kernel(program)(np.array([[0.0], [2.0]]))
    assert result.status.tolist() == [-1.0, 0.0]
    assert result.outputs["y"].tolist() == [[0.0, 0.0], [0.5, 2.0]]


def test_the_second_kernel_of_a_text_comes_from_the_cache(cache, hit):
    program = trace_mechanism(hit, ("active",))
    first, second = Kernel(program), Kernel(program)
    assert (first.is_cached, second.is_cached) == (False, True)
    assert len(list(cache.iterdir())) == 1
    assert (first(hit.home[None]).outputs["active"] == second(hit.home[None]).outputs["active"]).all()


def test_another_text_has_another_key(hit):
    one, other = (emit_llvm(trace_mechanism(hit, ("active",), b)).text for b in ("up-out", "up-in"))
    assert artefacts.artefact_key(one) != artefacts.artefact_key(other)
    assert artefacts.artefact_key(one) == artefacts.artefact_key(one)


@pytest.mark.parametrize(
    "damage", [lambda code: code[: len(code) // 2], lambda code: code[:-1] + b"?", lambda code: b""]
)
def test_a_damaged_file_of_the_cache_is_compiled_anew(cache, hit, damage):
    program = trace_mechanism(hit, ("active",))
    Kernel(program)
    (path,) = cache.iterdir()
    path.write_bytes(damage(path.read_bytes()))
    assert not Kernel(program).is_cached
    assert Kernel(program).is_cached


def test_a_cache_that_cannot_be_written_is_no_failure(tmp_path, monkeypatch, hit):
    (tmp_path / "file").write_text("in the way")
    monkeypatch.setenv(artefacts.CACHE_VARIABLE, str(tmp_path / "file"))
    assert Kernel(trace_mechanism(hit, ("active",)))(hit.home[None]).is_legal.all()


def test_a_kernel_without_margins_has_the_same_results_and_status(hit, rng):
    program = trace_mechanism(hit, ("active",))
    poses = hit.home + rng.uniform(-1.0, 1.0, (4000, 6)) * [300.0, 300.0, 300.0, 2.0, 2.0, 2.0]
    poses[5, 2], poses[6, 0], poses[7, :3] = np.nan, np.inf, 1e200
    whole, bare = Kernel(program)(poses), Kernel(program, has_margins=False)(poses)
    assert bare.margins.shape == (4000, 0)
    assert (bare.status == whole.status).all() and len(set(whole.status)) > 4
    assert (bare.outputs["active"] == whole.outputs["active"])[whole.is_legal].all()


def test_poses_that_cannot_be_written_are_read(hit):
    kernel = Kernel(trace_mechanism(hit, ("active",)))
    poses = np.tile(hit.home, (9, 1))
    poses.flags.writeable = False
    assert kernel(poses).is_legal.all()
