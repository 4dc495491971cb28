"""How fast the compiled kinematics are, beside numpy in the same process, on one core.

Run: `python benchmarks/kinematics.py [MECHANISM ...]`. All rows of a table take turns within each round, so that a busy
neighbour slows all of them; the figure is the best round, the ratio is that of the medians. Asserts nothing.
"""

from __future__ import annotations

import os

# Before numpy: its peers must not take a second core, and must run what OpenBLAS chooses for this processor.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.pop("OPENBLAS_CORETYPE", None)
os.environ.pop("OPENBLAS_L2_SIZE", None)

import sys
import tempfile
import time
from collections.abc import Callable

import numpy as np

from linkwright.designs import catalogue
from linkwright.designs.codegen.artefacts import CACHE_VARIABLE
from linkwright.designs.codegen.enclosures import enclose
from linkwright.designs.codegen.forward import NotSquareError, trace_forward
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.program import Program
from linkwright.designs.codegen.singular import with_singular_values, with_threshold
from linkwright.designs.codegen.trace import trace_mechanism
from linkwright.designs.language.formulas import FormulaMechanism

#: Poses a call: poses and decisions stay in the second-level cache, as in a loop over a workspace.
N_POSES = 4096
N_ROUNDS = 60
#: numpy.linalg.svd, batched, as the targets of 100 (both values) and 250 times (threshold) assume it [ns a pose].
ASSUMED_SVD = 1e9 / 0.15e6
#: Peers are slow: they take a part of the poses, every so many rounds.
N_PEER, PEER_EVERY = 512, 3


def main() -> None:
    """Measure and print, mechanism by mechanism."""
    with tempfile.TemporaryDirectory() as folder:
        os.environ[CACHE_VARIABLE] = folder
        print(f"numpy {np.__version__}, {blas_kernel()}")
        for name in sys.argv[1:] or ["hit"]:
            measure(name)


def measure(name: str) -> None:
    """All tables of one mechanism."""
    design = catalogue.entry(name).default_design()
    mechanism = design.mechanism
    assert isinstance(mechanism, FormulaMechanism)
    rng = np.random.default_rng(7)
    poses = rng.uniform(*design.box(), (N_POSES, len(mechanism.task)))
    J = mechanism.compute_jacobian(poses)
    scale = [1.0] * 3 + [1.0 / 120.0] * (J.shape[-1] - 3) if J.shape[-1] > 3 else [1.0] * J.shape[-1]
    J = J * np.array(scale)
    base = trace_mechanism(mechanism, ("active", "jacobian"))
    threshold = [float(np.median(np.linalg.svd(J, compute_uv=False)[:, -1]))]
    # Without angles: what only the Jacobian needs of the inverse kinematics, and no joint limits.
    bare = trace_mechanism(mechanism, ("jacobian",))
    programs: dict[str, tuple[Program, list[float], bool]] = {
        "IK": (base.keep("active"), [], True),
        "IK + J": (base, [], True),
        "J -> sigma min, max": (with_singular_values(bare, scale).keep("sigma"), [], False),
        "IK + J -> sigma min, max": (with_singular_values(base, scale).keep("active", "sigma"), [], False),
        "J -> sigma min < t": (with_threshold(bare, scale).keep("above"), threshold, False),
    }
    rows: dict[str, tuple[Callable[[], object], int]] = {}
    print(f"{name}: kernels, first compiled, then loaded")
    for label, (program, numbers, has_margins) in programs.items():
        first, kernel = (Kernel(program, has_margins=has_margins) for _ in range(2))
        print(f"  {label:<28} {first.seconds * 1e3:7.0f} ms {kernel.seconds * 1e3:7.1f} ms (printing included)")
        rows[label] = call_of(kernel, poses, numbers), N_POSES
    part, flat = J[:N_PEER], poses[:N_PEER]
    random = rng.normal(size=(N_PEER, *J.shape[1:]))
    rows["numpy svd of J"] = lambda: np.linalg.svd(part, compute_uv=False), N_PEER
    rows["numpy svd of random matrices"] = lambda: np.linalg.svd(random, compute_uv=False), N_PEER
    rows["numpy IK + J"] = lambda: (mechanism.solve_inverse(flat), mechanism.compute_jacobian(flat)), N_PEER
    show(rows, "numpy svd of J")
    enclosing(mechanism, base, poses[:200])
    forward(mechanism, poses)


def blas_kernel() -> str:
    """The BLAS that numpy runs, and which of its kernels, if threadpoolctl is there to tell."""
    try:
        from threadpoolctl import threadpool_info
    except ImportError:
        return "BLAS kernel unknown (install threadpoolctl)"
    return ", ".join(f"{i['internal_api']} {i['version']} {i.get('architecture', '?')}" for i in threadpool_info())


def call_of(kernel: Kernel, poses: np.ndarray, numbers: list[float]) -> Callable[[], object]:
    """A call that reuses its memory, on one thread."""
    buffer, array = kernel.buffer(len(poses)), np.array(numbers)
    return lambda: kernel(poses, array, n_threads=1, into=buffer)


def show(rows: dict[str, tuple[Callable[[], object], int]], peer: str) -> None:
    """Time all rows in turns and print them."""
    times: dict[str, list[float]] = {label: [] for label in rows}
    for turn in range(N_ROUNDS):
        for label, (call, n) in rows.items():
            if label.startswith("numpy") and turn % PEER_EVERY:
                continue
            start = time.perf_counter()
            call()
            times[label].append((time.perf_counter() - start) / n * 1e9)
    usual = {label: float(np.median(t)) for label, t in times.items()}
    print(f"  {'':<28} {'best':>9} {'median':>9}   {peer} is slower by (best, median); 0.15 M/s is, by best")
    for label, t in times.items():
        ratios = f"{min(times[peer]) / min(t):8.1f} {usual[peer] / usual[label]:8.1f} {ASSUMED_SVD / min(t):8.1f}"
        print(f"  {label:<28} {min(t):6.1f} ns {usual[label]:6.1f} ns   {ratios}")


def enclosing(mechanism, base: Program, poses: np.ndarray) -> None:
    """Enclosures a box."""
    half = np.array([5.0 if c.unit == "mm" else np.radians(1.0) for c in mechanism.task])
    for is_affine in (False, True):
        start = time.perf_counter()
        enclose(base, poses - half, poses + half, is_affine=is_affine)
        took = (time.perf_counter() - start) / len(poses) * 1e6
        print(f"  {'affine' if is_affine else 'interval':<28} {took:6.1f} us a box of 10 mm, 2 deg (numpy)")


def forward(mechanism, poses: np.ndarray) -> None:
    """Warm-started forward kinematics."""
    try:
        kernel = Kernel(trace_forward(mechanism))
    except NotSquareError as error:
        print(f"  {error}")
        return
    active = Kernel(trace_mechanism(mechanism, ("active",)))(poses).outputs["active"]
    inputs = np.concatenate([active, poses + 1e-3 * np.abs(poses)], axis=-1)
    show({"FK from a near pose": (call_of(kernel, inputs, []), len(poses))}, "FK from a near pose")


if __name__ == "__main__":
    main()
