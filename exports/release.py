"""From a design to a folder that can be handed on: built, checked, written, read back, and only then put in place."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from linkwright.analysis.feasibility import check_design
from linkwright.analysis.findings import CheckResult, Finding, Report, Severity
from linkwright.analysis.report import findings_json
from linkwright.designs.catalogue import Entry
from linkwright.designs.design import Design
from linkwright.designs.language.errors import ReleaseError
from linkwright.generator.assembly import Assembly, build_assembly
from linkwright.generator.solids import build_solid
from linkwright.generator.store import Store

from .controller import Limits, mechanism_from_config, write_controller_config
from .folder import prove_writable, refuse_foreign, whole_folder
from .manifest import Manifest, manifest_of, read_manifest, write_manifest
from .preview import check_egl, write_preview
from .products import Product, products_of
from .step import write_assembly_step, write_part_step
from .stl import write_stl
from .verify import check_assembly_step, check_config, check_design_file, check_part_steps, check_stls
from .verify_axes import check_axes

Progress = Callable[[int, int, str], None]

ASSEMBLY_STEP = "cad/assembly.step"
CONFIG = "controller/kinematics.json"
DESIGN_FILE = "design.toml"
FINDINGS = "findings.json"
PREVIEW = "preview.png"


@dataclass(frozen=True, slots=True, kw_only=True)
class ReleaseResult:
    """What came of a release.

    Attributes:
        path: the released folder; nothing was written there if `written` is False.
        report: of the checks, and of the re-reading if it came to that.
        manifest: of the released folder, None if nothing was written.
        written: the design passed and the folder is in place.
    """

    path: Path
    report: Report
    manifest: Manifest | None
    written: bool


def release(
    design: Design,
    out: Path,
    *,
    store: Store | None = None,
    progress: Progress | None = None,
    strict: bool = False,
    entry: Entry | None = None,
) -> ReleaseResult:
    """Build a design, check it, and write it down: all of it or nothing.

    Args:
        design: what to release.
        out: folder to write; an older release there is replaced.
        store: where built solids are kept between runs.
        progress: told (done, total, what) now and then.
        strict: let warnings fail the design too.
        entry: the mechanism's catalogue entry, for one that the catalogue does not hold.

    Returns:
        The result; a design that fails its checks is not written, and an older release stays as it is.

    Raises:
        ReleaseError: the folder cannot be written, or what was written does not say what the design says.
        BuildError: a part cannot be made.
    """
    out = Path(out)
    refuse_foreign(out.resolve(), is_release)
    prove_writable(out)
    if design.outputs.preview:
        check_egl()
    assembly = build_assembly(design, store=store, progress=progress)
    report = check_design(assembly, store=store, progress=progress)
    if not report.passes(strict=strict):
        return ReleaseResult(path=out, report=report, manifest=None, written=False)
    with whole_folder(out, is_release) as draft:
        report = _write_and_reread(_Draft(draft, assembly, report, store, entry), progress)
        _write_json(findings_json(report, design, strict=strict), draft / FINDINGS)
        manifest = manifest_of(assembly, report, draft, strict=strict)
        write_manifest(manifest, draft)
    return ReleaseResult(path=out, report=report, manifest=manifest, written=True)


def is_release(folder: Path) -> bool:
    """The folder holds a release, and may be replaced by another."""
    try:
        read_manifest(folder)
    except ReleaseError:
        return False
    return True


def measured_limits(report: Report) -> Limits:
    """Joint limits as measured on the solids [rad, mm]: joint name -> (lower, upper); those of a report's checks."""
    for result in report.results:
        if result.check == "joint-limits":
            limits: Mapping[str, Mapping[str, float]] = result.facts["limits"]
            return {name: (float(pair["lower"]), float(pair["upper"])) for name, pair in limits.items()}
    return {}


@dataclass(frozen=True, slots=True)
class _Draft:
    """A release in the making."""

    folder: Path
    assembly: Assembly
    report: Report
    store: Store | None
    entry: Entry | None

    @property
    def design(self) -> Design:
        return self.assembly.design

    def home(self) -> np.ndarray:
        mechanism = self.design.mechanism
        return mechanism.place_bodies(np.asarray(mechanism.home, dtype=float)[None])[0]

    def place(self, name: str) -> Path:
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        return path

    def made(self) -> tuple[Product, ...]:
        return tuple(product for product in products_of(self.assembly).values() if product.is_made)


def _write_and_reread(draft: _Draft, progress: Progress | None) -> Report:
    """All files but findings and manifest, each read back; the report with what the reading found."""
    outputs = draft.design.outputs
    steps: list[tuple[str, bool, Callable[[_Draft], list[CheckResult]]]] = [
        (DESIGN_FILE, True, _design_file),
        (CONFIG, outputs.controller, _config),
        ("cad", outputs.step, _cad),
        ("mesh", outputs.stl, _meshes),
        (PREVIEW, outputs.preview, _preview),
    ]
    wanted = [(name, step) for name, is_wanted, step in steps if is_wanted]
    results: list[CheckResult] = []
    for i, (name, step) in enumerate(wanted):
        if progress is not None:
            progress(i, len(wanted), f"write {name}")
        results += step(draft)
    broken = [f for result in results for f in result.findings if f.severity is Severity.ERROR]
    if broken:
        raise ReleaseError(_told(draft.design, broken))
    return Report(results=(*draft.report.results, *results))


def _told(design: Design, broken: list[Finding]) -> str:
    shown = "\n".join(f"  {finding.rule}: {finding.message}" for finding in broken[:5])
    more = f"\n  and {len(broken) - 5} more" if len(broken) > 5 else ""
    return f"{design.name}: what was written does not say what the design says; nothing is released:\n{shown}{more}"


def _design_file(draft: _Draft) -> list[CheckResult]:
    from linkwright.designs.file.writer import text_of

    path = draft.place(DESIGN_FILE)
    path.write_text(text_of(draft.design, entry=draft.entry), encoding="utf-8", newline="\n")
    return [check_design_file(path, draft.design, draft.entry)]


def _config(draft: _Draft) -> list[CheckResult]:
    path = draft.place(CONFIG)
    write_controller_config(draft.design, measured_limits(draft.report), path)
    return [check_config(path, draft.design, draft.entry)]


def _cad(draft: _Draft) -> list[CheckResult]:
    assembly, Ts_base_body = draft.assembly, draft.home()
    path = draft.place(ASSEMBLY_STEP)
    write_assembly_step(assembly, Ts_base_body, path)
    result, reread = check_assembly_step(path, assembly, Ts_base_body)
    parts = {draft.place(f"cad/parts/{product.name}.step"): product for product in draft.made()}
    for part_path, product in parts.items():
        write_part_step(product, part_path, assembly.design.hash)
    results = [result, check_part_steps(parts)]
    if assembly.design.outputs.controller:
        config = draft.folder / CONFIG
        results.append(check_axes(reread.bodies, mechanism_from_config(config, draft.entry), config))
    return results


def _meshes(draft: _Draft) -> list[CheckResult]:
    design = draft.design
    deviation = design.outputs.mesh_deviation
    paths = {draft.place(f"mesh/{product.name}.stl"): product for product in draft.made()}
    for path, product in paths.items():
        mesh = product.solid.mesh
        if mesh.deviation > deviation:
            use = product.uses[0]
            where = f"{design.name}: {use.body}: {use.part}"
            mesh = build_solid(product.part.feature, deviation, where=where, store=draft.store).mesh
        write_stl(mesh, path, product.name, design.hash)
    return [check_stls(paths, deviation)]


def _preview(draft: _Draft) -> list[CheckResult]:
    write_preview(draft.assembly, draft.home(), draft.place(PREVIEW))
    return []


def _write_json(content: object, path: Path) -> None:
    text = json.dumps(content, indent=2, allow_nan=False, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8", newline="\n")
