"""A compiled program: rows of poses in, rows of results out, eight poses at a time, on all cores."""

from __future__ import annotations

import os
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

import numpy as np

from .artefacts import load_kernel
from .emit_llvm import WIDTH, emit_llvm
from .program import Program

Array = np.ndarray

#: Poses below which a second thread costs more than it brings.
_WORTH_A_THREAD = 16384


@dataclass(frozen=True, slots=True, kw_only=True)
class KernelResult:
    """Results of a batch of n poses; views of one array.

    Attributes:
        outputs: by name, shape (n, *shape). Finite always (0 for what is not), meaningless where `status` is not 0.
        margins: shape (n, n_margins), legal where >= 0; -inf where not finite.
        status: 0, or the number (from 1) of the first margin that is not >= 0, or -1 where a pose or a result is not
            finite, shape (n,).
    """

    outputs: Mapping[str, Array]
    margins: Array
    status: Array

    @property
    def is_legal(self) -> Array:
        """Status 0, shape (n,)."""
        return self.status == 0.0


class Kernel:
    """A program compiled for this processor, or loaded from the cache of compiled programs.

    Attributes:
        program: what it computes.
        is_cached: the machine code was there already.
        seconds: what printing, compiling and loading took.
    """

    def __init__(self, program: Program, *, is_strict: bool = False) -> None:
        start = time.perf_counter()
        self.program = program
        printed = emit_llvm(program, is_strict=is_strict)
        self._n_results, self._length = printed.n_results, printed.row_length
        self._function, self._engine, self.is_cached = load_kernel(printed.text)
        self.seconds = time.perf_counter() - start

    def buffer(self, n: int) -> Array:
        """Room for the results of n poses, to be handed to several calls: fresh memory costs as much as the kernel."""
        return _aligned(n, self._length)

    def __call__(
        self,
        poses: Array,
        parameters: Sequence[float] = (),
        *,
        n_threads: int | None = None,
        into: Array | None = None,
    ) -> KernelResult:
        """Results for poses (n, n_inputs).

        Args:
            poses: inputs, one pose a row.
            parameters: values of the program's parameters.
            n_threads: at most so many threads; None for as many as there are cores.
            into: a `buffer` of this kernel for as many poses, which the results then are views of.
        """
        rows = np.ascontiguousarray(poses, dtype=float)
        n_inputs = len(self.program.inputs)
        if rows.ndim != 2 or rows.shape[1] != n_inputs:
            raise ValueError(f"{self.program.name}: poses have shape {rows.shape}, needed (n, {n_inputs})")
        numbers = np.ascontiguousarray(parameters, dtype=float)
        if numbers.shape != (len(self.program.parameters),):
            raise ValueError(
                f"{self.program.name}: {numbers.size} parameters given, needed {len(self.program.parameters)}"
            )
        n = len(rows)
        out = self.buffer(n) if into is None else into
        if out.shape != (n, self._length) or (n and out.ctypes.data % (8 * WIDTH)):
            raise ValueError(f"{self.program.name}: `into` must be buffer({n}) of this kernel")
        whole = n // WIDTH * WIDTH
        self._run(rows[:whole], numbers, out[:whole], n_threads or os.cpu_count() or 1)
        if whole < n:
            padded, last = np.zeros((WIDTH, n_inputs)), _aligned(WIDTH, self._length)
            padded[: n - whole] = rows[whole:]
            self._run(padded, numbers, last, 1)
            out[whole:] = last[: n - whole]
        return self._read(out)

    def _run(self, rows: Array, numbers: Array, out: Array, n_threads: int) -> None:
        n_blocks = len(rows) // WIDTH
        n_parts = max(1, min(n_threads, len(rows) // _WORTH_A_THREAD))
        edges = [WIDTH * (n_blocks * k // n_parts) for k in range(n_parts + 1)]

        def part(k: int) -> None:
            first, last = edges[k], edges[k + 1]
            if last > first:
                addresses = rows[first:].ctypes.data, numbers.ctypes.data, out[first:].ctypes.data
                self._function(*addresses, (last - first) // WIDTH)

        if n_parts == 1:
            part(0)
        else:
            with ThreadPoolExecutor(n_parts) as pool:
                list(pool.map(part, range(n_parts)))

    def _read(self, out: Array) -> KernelResult:
        outputs: dict[str, Any] = {}
        at = 0
        for output in self.program.outputs:
            outputs[output.name] = out[:, at : at + len(output.nodes)].reshape(len(out), *output.shape)
            at += len(output.nodes)
        n_margins = len(self.program.margins)
        return KernelResult(outputs=outputs, margins=out[:, at : at + n_margins], status=out[:, at + n_margins])


def _aligned(n: int, length: int) -> Array:
    """Rows that begin on cache lines: a vector stored across two of them costs half the kernel's time again."""
    room = np.empty(n * length + WIDTH)
    skip = -(room.ctypes.data // 8) % WIDTH
    return room[skip : skip + n * length].reshape(n, length)
