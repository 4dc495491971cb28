"""A compiled program: rows of poses in, rows of results out, eight poses at a time, on all cores."""

from __future__ import annotations

import ctypes
import math
import os
import time
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import accumulate
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
    """Results of a batch of n poses.

    Attributes:
        rows: all results, shape (n, length); what follows are views of it.
        layout: name, shape and first column of each output.
        n_results: numbers of all outputs; margins follow them, then the status.
        n_margins: margins in a row; 0 for a kernel without them.
    """

    rows: Array
    layout: tuple[tuple[str, tuple[int, ...], int], ...]
    n_results: int
    n_margins: int

    @property
    def outputs(self) -> Mapping[str, Array]:
        """By name, shape (n, *shape). Finite always (0 for what is not), meaningless where `status` is not 0."""
        n = len(self.rows)
        return {
            name: self.rows[:, first : first + math.prod(shape)].reshape(n, *shape)
            for name, shape, first in self.layout
        }

    @property
    def margins(self) -> Array:
        """Shape (n, n_margins), legal where >= 0; -inf where not finite."""
        return self.rows[:, self.n_results : self.n_results + self.n_margins]

    @property
    def status(self) -> Array:
        """0, or the number (from 1) of the first margin that is not a finite number >= 0; shape (n,).

        It is -1 where a pose or a result is not finite.
        """
        return self.rows[:, self.n_results + self.n_margins]

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

    def __init__(self, program: Program, *, is_strict: bool = False, has_margins: bool = True) -> None:
        """Compile or load.

        Args:
            program: traced and not yet lowered.
            is_strict: every operation rounds as IEEE 754 says.
            has_margins: margins are written; a kernel for one decision is quicker without, its `status` tells.
        """
        start = time.perf_counter()
        self.program = program
        printed = emit_llvm(program, is_strict=is_strict, has_margins=has_margins)
        self._n_margins, self._length = printed.n_margins, printed.row_length
        self._n_inputs, self._n_parameters = len(program.inputs), len(program.parameters)
        self._n_results = printed.n_results
        first = accumulate((len(o.nodes) for o in program.outputs), initial=0)
        self._layout = tuple((o.name, o.shape, at) for o, at in zip(program.outputs, first, strict=False))
        self._function, self._engine, self.is_cached = load_kernel(printed.text)
        self.seconds = time.perf_counter() - start

    def buffer(self, n: int) -> Array:
        """Room for the results of n poses, to be handed to several calls: fresh memory costs as much as the kernel."""
        return _aligned(n, self._length)

    def __call__(
        self,
        poses: Array,
        parameters: Sequence[float] | Array = (),
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
        rows, numbers = _as_rows(poses), _as_rows(parameters)
        if rows.ndim != 2 or rows.shape[1] != self._n_inputs:
            raise ValueError(f"{self.program.name}: poses have shape {rows.shape}, needed (n, {self._n_inputs})")
        if numbers.shape != (self._n_parameters,):
            raise ValueError(f"{self.program.name}: {numbers.size} parameters given, needed {self._n_parameters}")
        n = len(rows)
        out = self.buffer(n) if into is None else into
        if out.shape != (n, self._length) or (n and _address(out) % (8 * WIDTH)):
            raise ValueError(f"{self.program.name}: `into` must be buffer({n}) of this kernel")
        whole = n // WIDTH * WIDTH
        self._run(rows, numbers, out, whole // WIDTH, n_threads or os.cpu_count() or 1)
        if whole < n:
            padded, last = np.zeros((WIDTH, self._n_inputs)), _aligned(WIDTH, self._length)
            padded[: n - whole] = rows[whole:]
            self._run(padded, numbers, last, 1, 1)
            out[whole:] = last[: n - whole]
        return KernelResult(rows=out, layout=self._layout, n_results=self._n_results, n_margins=self._n_margins)

    def _run(self, rows: Array, numbers: Array, out: Array, n_blocks: int, n_threads: int) -> None:
        n_parts = max(1, min(n_threads, n_blocks * WIDTH // _WORTH_A_THREAD))
        source, constants, target = _address(rows), _address(numbers), _address(out)
        if n_parts == 1:
            if n_blocks:
                self._function(source, constants, target, n_blocks)
            return

        def part(k: int) -> None:
            first, last = n_blocks * k // n_parts, n_blocks * (k + 1) // n_parts
            here, there = (8 * WIDTH * first * width for width in (self._n_inputs, self._length))
            self._function(source + here, constants, target + there, last - first)

        with ThreadPoolExecutor(n_parts) as pool:
            list(pool.map(part, range(n_parts)))


def _as_rows(numbers: Any) -> Array:
    """The same array if it is contiguous float64 already."""
    if type(numbers) is np.ndarray and numbers.dtype == np.float64 and numbers.flags.c_contiguous:
        return numbers
    return np.ascontiguousarray(numbers, dtype=float)


def _address(array: Array) -> int:
    """Where the numbers lie; for arrays that can be written, at a sixth of the price of `array.ctypes.data`."""
    if not array.size:
        return 0
    if array.flags.writeable and array.flags.c_contiguous:
        return ctypes.addressof(ctypes.c_char.from_buffer(array.data))
    return int(array.ctypes.data)


def _aligned(n: int, length: int) -> Array:
    """Rows that begin on cache lines: a vector stored across two of them costs half the kernel's time again."""
    room = np.empty(n * length + WIDTH)
    skip = -(_address(room) // 8) % WIDTH
    return room[skip : skip + n * length].reshape(n, length)
