"""What a release consists of: every file with its checksum, the tools that wrote it, what was found, what it weighs."""

from __future__ import annotations

import hashlib
import importlib.metadata
import platform
from collections.abc import Iterable
from pathlib import Path
from typing import Literal

from pydantic import BaseModel, ConfigDict, ValidationError

from linkwright.analysis.findings import Report, Severity
from linkwright.designs.language.errors import ReleaseError
from linkwright.generator.assembly import Assembly
from linkwright.generator.mass import compute_part_mass

from .products import products_of

MANIFEST = "manifest.json"
_FORMAT: Literal["linkwright-release"] = "linkwright-release"

#: Distributions whose version can change a byte of a release.
_TOOLS = ("linkwright", "build123d", "cadquery", "cadquery-ocp", "manifold3d", "numpy", "trimesh", "vtk")


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class FileRow(_Row):
    """One file of a release."""

    path: str
    sha256: str
    n_bytes: int


class PartRow(_Row):
    """One line of the bill of materials."""

    name: str
    count: int
    material: str
    purchased: str
    mass_kg: float


class BodyRow(_Row):
    """One body: what it weighs, with all its parts."""

    name: str
    mass_kg: float


class FindingsRow(_Row):
    """How many findings of each severity the release was made with."""

    passes: bool
    n_errors: int
    n_warnings: int
    n_notes: int


class Manifest(_Row):
    """The whole manifest."""

    format: Literal["linkwright-release"] = _FORMAT
    format_version: Literal[1] = 1
    design: str
    mechanism: str
    design_hash: str
    tools: dict[str, str]
    findings: FindingsRow
    mass_kg: float
    bodies: list[BodyRow]
    parts: list[PartRow]
    files: list[FileRow]


def manifest_of(assembly: Assembly, report: Report, folder: Path, *, strict: bool = False) -> Manifest:
    """The manifest of the files that lie in a folder, read back from their bytes.

    Args:
        assembly: that was released.
        report: what was found.
        folder: holds the release, without its manifest.
        strict: whether warnings would have failed it.
    """
    design = assembly.design
    return Manifest(
        design=design.name,
        mechanism=design.mechanism.name,
        design_hash=design.hash,
        tools=tool_versions(),
        findings=FindingsRow(
            passes=report.passes(strict=strict),
            n_errors=report.count(Severity.ERROR),
            n_warnings=report.count(Severity.WARNING),
            n_notes=report.count(Severity.NOTE),
        ),
        mass_kg=_kg(sum(placed.mass for placed in assembly.bodies)),
        bodies=[BodyRow(name=placed.body.name, mass_kg=_kg(placed.mass)) for placed in assembly.bodies],
        parts=list(_part_rows(assembly)),
        files=[file_row(path, folder) for path in files_below(folder)],
    )


def write_manifest(manifest: Manifest, folder: Path) -> None:
    """Write the manifest into its release."""
    (folder / MANIFEST).write_text(manifest.model_dump_json(indent=2) + "\n", encoding="utf-8", newline="\n")


def read_manifest(folder: Path) -> Manifest:
    """The manifest of a released folder.

    Raises:
        ReleaseError: the folder has no manifest of ours.
    """
    path = folder / MANIFEST
    try:
        return Manifest.model_validate_json(path.read_bytes())
    except FileNotFoundError as error:
        raise ReleaseError(f"{folder} is no release: it has no {MANIFEST}") from error
    except (ValidationError, OSError) as error:
        raise ReleaseError(f"{path} is no manifest of a release: {str(error).splitlines()[0]}") from error


def changed_files(manifest: Manifest, folder: Path) -> tuple[str, ...]:
    """Files of a release that are missing, changed, or not in its manifest; none if it is whole."""
    stated = {row.path: row for row in manifest.files}
    found = {row.path: row for row in (file_row(path, folder) for path in files_below(folder)) if row.path != MANIFEST}
    return tuple(sorted(path for path in stated.keys() | found.keys() if stated.get(path) != found.get(path)))


def files_below(folder: Path) -> Iterable[Path]:
    """All files of a folder in the order of their paths."""
    return sorted((path for path in folder.rglob("*") if path.is_file()), key=lambda path: path.as_posix())


def file_row(path: Path, folder: Path) -> FileRow:
    """Checksum and size of a file from its bytes."""
    content = path.read_bytes()
    return FileRow(
        path=path.relative_to(folder).as_posix(), sha256=hashlib.sha256(content).hexdigest(), n_bytes=len(content)
    )


def tool_versions() -> dict[str, str]:
    """Versions of whatever could change a byte."""
    installed = {d.name.lower(): d.version for d in importlib.metadata.distributions() if d.name}
    return {"python": platform.python_version()} | {name: installed[name] for name in _TOOLS if name in installed}


def _part_rows(assembly: Assembly) -> Iterable[PartRow]:
    for product in sorted(products_of(assembly).values(), key=lambda p: (not p.is_made, p.name)):
        part = product.part
        mass = compute_part_mass(part, product.solid, product.name).mass
        yield PartRow(
            name=product.name,
            count=len(product.uses),
            material=part.material,
            purchased=part.purchased,
            mass_kg=_kg(mass),
        )


def _kg(mass: float) -> float:
    """To the microgram: what lies below is rounding of the kernel's integrals."""
    return round(float(mass), 9)
