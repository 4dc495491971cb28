"""The one way in which this room compiles a function, so that no stale machine code is ever loaded."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba


def _fingerprint() -> str:
    """sha256 over every source of this folder."""
    text = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*.py")):
        text.update(path.name.encode() + path.read_bytes())
    return text.hexdigest()


_SOURCES = _fingerprint()


def kernel(function: Callable[..., Any]) -> Any:
    """Compile without the interpreter lock, in IEEE arithmetic, with the result kept on disk.

    numba ties a cached kernel to the file that holds it. Kernels here call kernels of other files of this folder,
    whose code is compiled into theirs, so the stamp is widened to all sources of the folder. Where a version of
    numba hides its stamp the kernel is compiled afresh in each process: slow, but right.
    """
    dispatcher = numba.njit(nogil=True, cache=True, error_model="numpy")(function)
    file = getattr(getattr(dispatcher, "_cache", None), "_cache_file", None)
    if file is not None and hasattr(file, "_source_stamp"):
        file._source_stamp = (file._source_stamp, _SOURCES)
        return dispatcher
    return numba.njit(nogil=True, error_model="numpy")(function)
