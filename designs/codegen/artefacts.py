"""Compiles IR to machine code, once for each text and each processor: the object file is kept by its content.

llvmlite is imported on the first kernel, not before, so that a command that answers one pose stays light.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import tempfile
from functools import lru_cache
from pathlib import Path
from typing import Any

#: Environment variable that moves the cache (the same one as for parts).
CACHE_VARIABLE = "LINKWRIGHT_CACHE"

#: Bytes before the code: its SHA-256, since a damaged object file would crash the process.
_DIGEST = 32

Entry = Any


def cache_folder() -> Path:
    """Where object files are kept."""
    root = os.environ.get(CACHE_VARIABLE)
    base = Path(root) if root else Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "linkwright"
    return base / "kernels"


@lru_cache(maxsize=1)
def _machine() -> tuple[Any, Any, str]:
    """The binding of llvmlite, a target machine for this processor, and what an object file's validity hangs on."""
    import llvmlite
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    cpu, features = llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()
    target = llvm.Target.from_default_triple()
    machine = target.create_target_machine(cpu=cpu, features=features, opt=2, reloc="pic", codemodel="default")
    return llvm, machine, f"{target.triple}|{cpu}|{features}|llvmlite {llvmlite.__version__}"


def artefact_key(text: str) -> str:
    """Name of the object file of an IR text on this processor."""
    return hashlib.sha256(f"{_machine()[2]}\n{text}".encode()).hexdigest()


def object_code(text: str) -> tuple[bytes, bool]:
    """The machine code of an IR text, and whether it came from the cache."""
    path = cache_folder() / f"{artefact_key(text)}.o"
    kept = _kept(path)
    if kept is not None:
        return kept, True
    llvm, machine, _ = _machine()
    module = llvm.parse_assembly(text)
    module.verify()
    code = machine.emit_object(module)
    _keep(path, code)
    return code, False


def _kept(path: Path) -> bytes | None:
    """The code in a file of the cache; None if it is not there or not whole."""
    try:
        content = path.read_bytes()
    except OSError:
        return None
    digest, code = content[:_DIGEST], content[_DIGEST:]
    return code if hashlib.sha256(code).digest() == digest else None


def _keep(path: Path, code: bytes) -> None:
    """Write beside and rename, so that no reader meets half a file; a folder that cannot be written is no failure."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent, suffix=".part")
        with os.fdopen(handle, "wb") as file:
            file.write(hashlib.sha256(code).digest() + code)
        Path(name).replace(path)
    except OSError:
        return


def load_kernel(text: str) -> tuple[Entry, Any, bool]:
    """The callable `kernel` of an IR text.

    Returns:
        function: takes three addresses and a count; the call releases the GIL.
        engine: must live as long as the function.
        is_cached: the machine code came from the cache.
    """
    code, is_cached = object_code(text)
    llvm, _, _ = _machine()
    target = llvm.Target.from_default_triple().create_target_machine()
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), target)
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    pointer = ctypes.c_void_p
    function = ctypes.CFUNCTYPE(None, pointer, pointer, pointer, ctypes.c_int64)(engine.get_function_address("kernel"))
    return function, engine, is_cached
