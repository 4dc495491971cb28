"""Whether the written bytes say what the design says: STEP, STL and config are read back and compared."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from linkwright.analysis.findings import CheckResult, Finding, Severity
from linkwright.designs import catalogue
from linkwright.designs.catalogue import Entry
from linkwright.designs.design import Design
from linkwright.designs.language.errors import LinkwrightError, VacuousCheckError
from linkwright.generator.assembly import Assembly

from .controller import declared_numbers, home_numbers, mechanism_from_config, mechanism_numbers, read_config
from .products import Product
from .reread import RereadAssembly, RereadInstance, reread_assembly, reread_volume
from .stl import HEADER_BYTES

#: STEP stores 13 digits and re-meets spheres at their seams: 5e-6 of a volume was seen to move.
VOLUME_SHARE = 1e-5
PLACE_MM = 1e-6
TURN_RAD = 1e-9
#: Numbers of a config come back through a design file's 15 digits.
CONFIG_SHARE = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class Worst:
    """The largest of many deviations, and whose it was."""

    value: float = 0.0
    subject: str = ""

    def or_(self, value: float, subject: str) -> Worst:
        """The larger of the two."""
        return Worst(value=float(value), subject=subject) if value > self.value else self


def check_assembly_step(path: Path, assembly: Assembly, Ts_base_body: np.ndarray) -> tuple[CheckResult, RereadAssembly]:
    """Compare a written assembly with the one in memory: names, counts, volumes and places.

    Args:
        path: the written STEP file.
        assembly: what it should hold.
        Ts_base_body: poses that it was written in, shape (n_bodies, 4, 4) [mm].
    """
    reread = reread_assembly(path)
    found = {instance.path[-2:]: instance for instance in reread.instances}
    wanted = {
        (placed.body.name, part.part.name): (part, T @ part.T_body_part, placed.body.group)
        for placed, T in zip(assembly.bodies, Ts_base_body, strict=True)
        for part in placed.parts
    }
    findings = _named(path, found, {key: group for key, (_, _, group) in wanted.items()}, len(reread.instances))
    volume, place, turn = Worst(), Worst(), Worst()
    for key in sorted(wanted.keys() & found.keys()):
        (part, T, _), instance = wanted[key], found[key]
        subject = "/".join(key)
        centre = T[:3, :3] @ np.asarray(part.solid.centre) + T[:3, 3]
        volume = volume.or_(abs(instance.volume - part.solid.volume) / part.solid.volume, subject)
        place = place.or_(_place_deviation(T, instance), subject)
        turn = turn.or_(float(np.max(np.abs(T[:3, :3] - instance.T_base_part[:3, :3]))), subject)
        if instance.n_solids != 1:
            findings.append(_error("step-reread", path, key, f"{subject} is {instance.n_solids} solids, not one"))
        if np.linalg.norm(centre - instance.centre) > 1e-3:
            findings.append(
                _error(
                    "step-reread",
                    path,
                    key,
                    f"{subject} has its centre of mass at {_shown(instance.centre)} instead of {_shown(centre)} mm",
                )
            )
    findings += _beyond("step-reread", path, "volume", volume, VOLUME_SHARE, "")
    findings += _beyond("step-reread", path, "place", place, PLACE_MM, "mm")
    findings += _beyond("step-reread", path, "direction", turn, TURN_RAD, "rad")
    result = CheckResult(
        check="step-reread",
        looked_at={"instances": len(reread.instances), "bodies": len(reread.bodies)},
        findings=tuple(findings),
        facts={"largest_volume_share": volume.value, "largest_place_mm": place.value, "largest_turn_rad": turn.value},
    )
    return result, reread


def check_part_steps(paths: Mapping[Path, Product]) -> CheckResult:
    """Compare written parts with their solids: one solid each, of the same volume.

    Raises:
        VacuousCheckError: there are no files.
    """
    _refuse_none(paths, "STEP files of made parts")
    findings: list[Finding] = []
    volume = Worst()
    for path, product in paths.items():
        measured, n_solids = reread_volume(path)
        volume = volume.or_(abs(measured - product.solid.volume) / product.solid.volume, product.name)
        if n_solids != 1:
            findings.append(
                _error("step-reread", path, (product.name,), f"{product.name} is {n_solids} solids, not one")
            )
    findings += _beyond("step-reread", path, "volume", volume, VOLUME_SHARE, "")
    return CheckResult(
        check="part-step-reread",
        looked_at={"parts": len(paths)},
        findings=tuple(findings),
        facts={"largest_volume_share": volume.value},
    )


def check_stls(paths: Mapping[Path, Product], deviation: float) -> CheckResult:
    """Read written STL files by trimesh: closed, one way round, of the solid's volume within the deviation.

    Args:
        paths: written file -> the part that it holds.
        deviation: largest distance between mesh and solid that was asked for [mm].

    Raises:
        VacuousCheckError: there are no files.
    """
    _refuse_none(paths, "STL files")
    findings: list[Finding] = []
    volume = Worst()
    for path, product in paths.items():
        broken, share = _stl_findings(path, product, deviation)
        findings += broken
        volume = volume.or_(share, product.name)
    return CheckResult(
        check="stl-reread",
        looked_at={"meshes": len(paths)},
        findings=tuple(findings),
        facts={"largest_volume_share": volume.value},
    )


def _stl_findings(path: Path, product: Product, deviation: float) -> tuple[list[Finding], float]:
    """What is wrong with one file, and by which share its volume differs from the solid's (0 if it has none)."""
    import trimesh

    solid, subject, rule = product.solid, (product.name,), "stl-reread"
    size = _stl_size(path, subject)
    try:
        mesh = trimesh.load_mesh(path, file_type="stl")
    except (ValueError, IndexError, OSError) as error:
        return [*size, _error(rule, path, subject, f"trimesh cannot read it: {error}")], 0.0
    if len(mesh.faces) == 0:
        return [*size, _error(rule, path, subject, f"the mesh of {product.name} is empty")], 0.0
    claims = {
        "closed": mesh.is_watertight,
        "oriented one way": mesh.is_winding_consistent,
        "oriented outwards": mesh.volume > 0.0,
        "free of facets without area": bool(np.all(mesh.area_faces > 0.0)),
    }
    if broken := [claim for claim, holds in claims.items() if not holds]:
        text = f"the mesh of {product.name} is not {', not '.join(broken)}"
        return [*size, _error(rule, path, subject, text)], 0.0
    off = float(abs(mesh.volume - solid.volume))
    # A mesh whose every point lies within the deviation encloses at most area times deviation more or less.
    limit = solid.area * deviation
    if off > limit:
        text = f"the mesh of {product.name} encloses {mesh.volume:.6g} mm3, its solid {solid.volume:.6g} mm3"
        size = [*size, _error(rule, path, subject, text, off, limit, "mm3")]
    return list(size), off / solid.volume


def check_config(path: Path, design: Design, entry: Entry | None = None) -> CheckResult:
    """Rebuild the mechanism from a written config: every kinematic number that the file states follows from it.

    Args:
        path: the written config.
        design: that it was written from.
        entry: see `mechanism_from_config`.
    """
    config = read_config(path)
    findings: list[Finding] = []
    if config["design_hash"] != design.hash:
        text = f"design_hash is {config['design_hash']}, the design's is {design.hash}"
        findings.append(_error("config-reread", path, (design.name,), text))
    stated: list[tuple[str, float]] = []
    try:
        mechanism = mechanism_from_config(path, entry)
        stated = [*mechanism_numbers(mechanism), *declared_numbers(mechanism), *home_numbers(mechanism)]
    except LinkwrightError as error:
        findings.append(_error("config-reread", path, (design.name,), f"no mechanism can be made from it: {error}"))
    deviation = Worst()
    for key, value in stated:
        written = config.get(key)
        if not isinstance(written, int | float):
            findings.append(_error("config-reread", path, (key,), f"{key} is missing"))
            continue
        # Next to zero (an angle of zero, say) a share means nothing: a millimetre and a milliradian are the floor.
        share = abs(written - value) / max(abs(value), 1e-3)
        deviation = deviation.or_(share, key)
        if share > CONFIG_SHARE:
            text = f"{key} = {written!r} does not follow from the parameters in the same file: {value!r}"
            findings.append(_error("config-reread", path, (key,), text, share, CONFIG_SHARE))
    return CheckResult(
        check="config-reread",
        looked_at={"numbers": len(config)},
        findings=tuple(findings),
        facts={"largest_share": deviation.value},
    )


def check_design_file(path: Path, design: Design, entry: Entry | None = None) -> CheckResult:
    """Read a written design file: it must give a design of the same hash."""
    from linkwright.designs.file.reader import read_design

    findings = []
    try:
        reread = read_design(path, find_entry=catalogue.entry if entry is None else lambda _: entry)
        if reread.hash != design.hash:
            text = f"it reads as design {reread.hash}, not {design.hash}"
            findings.append(_error("design-reread", path, (design.name,), text))
    except LinkwrightError as error:
        findings.append(_error("design-reread", path, (design.name,), f"it cannot be read back: {error}"))
    return CheckResult(check="design-reread", looked_at={"files": 1}, findings=tuple(findings))


def _refuse_none(paths: Mapping[Path, Product], what: str) -> None:
    if not paths:
        raise VacuousCheckError(f"there are no {what} to read back: the design makes no part")


def _named(
    path: Path,
    found: Mapping[tuple[str, ...], RereadInstance],
    groups: Mapping[tuple[str, ...], str],
    n_instances: int,
) -> list[Finding]:
    findings = [
        _error("step-reread", path, key, f"{'/'.join(key)} is missing") for key in sorted(groups.keys() - found.keys())
    ]
    findings += [
        _error("step-reread", path, key, f"{'/'.join(key)} does not belong to it")
        for key in sorted(found.keys() - groups.keys())
    ]
    for key in sorted(groups.keys() & found.keys()):
        above = found[key].path[:-2]
        if above != ((groups[key],) if groups[key] else ()):
            findings.append(
                _error(
                    "step-reread",
                    path,
                    key,
                    f"{'/'.join(key)} is filed under {'/'.join(above) or 'the top'!r}, not {groups[key]!r}",
                )
            )
    if n_instances != len(found):
        doubled = Counter(found)
        findings.append(
            _error("step-reread", path, (), f"{n_instances} instances, of which {len(doubled)} have names of their own")
        )
    return findings


def _place_deviation(T: np.ndarray, instance: RereadInstance) -> float:
    return float(np.linalg.norm(T[:3, 3] - instance.T_base_part[:3, 3]))


def _stl_size(path: Path, subject: tuple[str, ...]) -> Sequence[Finding]:
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(HEADER_BYTES)
    n = int.from_bytes(head[80:84], "little") if len(head) == HEADER_BYTES else -1
    if size != HEADER_BYTES + 50 * n:
        return [_error("stl-reread", path, subject, f"{size} bytes do not hold the {n} facets that its header states")]
    return []


def _beyond(rule: str, path: Path, what: str, worst: Worst, limit: float, unit: str) -> list[Finding]:
    if worst.value <= limit:
        return []
    text = (
        f"the {what} of {worst.subject} is off by {worst.value:.3g}{' ' + unit if unit else ''}, allowed is {limit:g}"
    )
    return [_error(rule, path, (worst.subject,), text, worst.value, limit, unit)]


def _error(
    rule: str,
    path: Path,
    subject: tuple[str, ...],
    message: str,
    measured: float | None = None,
    limit: float | None = None,
    unit: str = "",
) -> Finding:
    return Finding(
        rule=rule,
        severity=Severity.ERROR,
        subject=subject,
        message=f"{path.name}: {message}",
        measured=measured,
        limit=limit,
        unit=unit,
        suggestion="this is a fault of the release, not of the design: report it",
    )


def _shown(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{c:.4f}" for c in point) + ")"
