"""Solids kept on disk by the hash of their numbers, so that a part is built once and read ever after."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import os
import struct
import tempfile
import warnings
from collections.abc import Iterator
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.designs.language.features import Feature

from .mesh import Mesh
from .solids import Solid
from .surfaces import Surface, SurfaceKind

_MAGIC = b"linkwright solid 1\n"
_SUFFIX = ".solid"
_ARRAYS = ("vertices", "triangles", "faces")


def content_key(feature: Feature, deviation: float) -> str:
    """sha256 of all that a solid depends on: numbers, mesh deviation [mm], this storey's code, the kernel's version."""
    text = json.dumps(
        [_canonical(feature), repr(float(deviation)), code_hash(__package__), _kernel_version()], separators=(",", ":")
    )
    return hashlib.sha256(text.encode()).hexdigest()


def _canonical(value: Any) -> Any:
    """Plain JSON of frozen numbers: type names and fields, floats by their shortest exact text; 2 equals 2.0."""
    if dataclasses.is_dataclass(value):
        fields = {f.name: _canonical(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return [type(value).__name__, fields]
    if isinstance(value, tuple | list):
        return [_canonical(v) for v in value]
    if value is None or isinstance(value, bool | str):
        return value
    # A number's type must not matter, and -0.0 is 0.0.
    return repr(float(value) + 0.0)


@cache
def code_hash(package: str) -> str:
    """sha256 of a package's Python sources, sub-packages included: what was computed by other code is not recalled."""
    digest = hashlib.sha256()
    for name, content in sorted(_sources(files(package), "")):
        digest.update(name.encode() + b"\0" + content + b"\0")
    return digest.hexdigest()


def _sources(folder: Traversable, prefix: str) -> Iterator[tuple[str, bytes]]:
    for entry in folder.iterdir():
        if entry.is_dir() and entry.name != "__pycache__":
            yield from _sources(entry, f"{prefix}{entry.name}/")
        elif entry.name.endswith(".py"):
            yield prefix + entry.name, entry.read_bytes()


@cache
def _kernel_version() -> str:
    for wheel in ("cadquery-ocp", "cadquery-ocp-novtk"):
        try:
            return f"{wheel} {version(wheel)}"
        except PackageNotFoundError:
            continue
    return "unknown"


def default_root() -> Path:
    """Where solids are kept: $LINKWRIGHT_CACHE, else linkwright/ in $XDG_CACHE_HOME or ~/.cache."""
    if own := os.environ.get("LINKWRIGHT_CACHE"):
        return Path(own)
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "linkwright"


class Store:
    """Solids on disk by content key.

    An entry is written aside and renamed, so a reader sees all of it or none. Each holds its own checksum: a damaged
    one counts as absent and is built again. A folder that cannot be written costs speed only, and says so once.
    """

    def __init__(self, root: Path | None = None) -> None:
        self.root = (root if root is not None else default_root()) / "solids"
        self._is_writable = True

    def path(self, key: str) -> Path:
        """File of an entry."""
        return self.root / key[:2] / f"{key}{_SUFFIX}"

    def load(self, key: str) -> Solid | None:
        """The solid of this key; None if it is absent or damaged."""
        try:
            data = self.path(key).read_bytes()
        except OSError:
            return None
        return solid_from_bytes(data, key)

    def save(self, solid: Solid) -> None:
        """Keeps a solid."""
        if not self._is_writable:
            return
        target = self.path(solid.key)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            handle, aside = tempfile.mkstemp(dir=target.parent, suffix=".part")
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(bytes_from_solid(solid))
                Path(aside).replace(target)
            except BaseException:
                Path(aside).unlink(missing_ok=True)
                raise
        except OSError as error:
            self._is_writable = False
            warnings.warn(f"solids are not kept for the next run: {error}", stacklevel=2)


def bytes_from_solid(solid: Solid) -> bytes:
    """A solid as one block: magic, checksum of the rest, length of the head, head as JSON, arrays, boundary."""
    arrays = [np.ascontiguousarray(getattr(solid.mesh, name)) for name in _ARRAYS]
    head = json.dumps(
        {
            "key": solid.key,
            "arrays": [[name, a.dtype.str, a.shape] for name, a in zip(_ARRAYS, arrays, strict=True)],
            "deviation": solid.mesh.deviation,
            "surfaces": [[s.kind.value, s.point, s.axis, s.radius] for s in solid.surfaces],
            "numbers": [solid.volume, solid.area],
            "rows": [getattr(solid, name).tolist() for name in ("centre", "inertia", "lower", "upper")],
        }
    ).encode()
    body = b"".join([struct.pack("<Q", len(head)), head, *(a.tobytes() for a in arrays), solid.brep])
    return _MAGIC + hashlib.sha256(body).digest() + body


def solid_from_bytes(data: bytes, key: str) -> Solid | None:
    """The solid in a block that `bytes_from_solid` made for this key; None if a single bit of it is wrong."""
    start = len(_MAGIC) + 32
    body = memoryview(data)[start:]
    if data[: len(_MAGIC)] != _MAGIC or hashlib.sha256(body).digest() != data[len(_MAGIC) : start]:
        return None
    (length,) = struct.unpack("<Q", body[:8])
    head = json.loads(bytes(body[8 : 8 + length]))
    if head["key"] != key:
        return None
    at, arrays = 8 + length, {}
    for name, dtype, shape in head["arrays"]:
        count = int(np.prod(shape))
        # Views of immutable bytes: locked without a copy; the copy below only restores alignment.
        arrays[name] = np.frombuffer(body, dtype=dtype, count=count, offset=at).reshape(shape).copy()
        arrays[name].setflags(write=False)
        at += count * np.dtype(dtype).itemsize
    rows = [np.array(row) for row in head["rows"]]
    for row in rows:
        row.setflags(write=False)
    surfaces = tuple(
        Surface(kind=SurfaceKind(k), point=tuple(p), axis=tuple(a), radius=r) for k, p, a, r in head["surfaces"]
    )
    return Solid(
        key=key,
        brep=bytes(body[at:]),
        mesh=Mesh(**arrays, deviation=head["deviation"]),
        surfaces=surfaces,
        volume=head["numbers"][0],
        area=head["numbers"][1],
        centre=rows[0],
        inertia=rows[1],
        lower=rows[2],
        upper=rows[3],
    )
