"""What the machine's controller is told: one flat JSON object in SI units, each key with its unit, and the way back.

Lengths are shifted by decimal digits and never multiplied, so that 150 mm is 0.15 m and comes back as 150 mm.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping
from decimal import Decimal
from pathlib import Path
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, ValidationError

from linkwright.designs import catalogue
from linkwright.designs.catalogue import Entry
from linkwright.designs.design import Design
from linkwright.designs.language.errors import DesignFileError, ReleaseError
from linkwright.designs.language.mechanism import Mechanism
from linkwright.designs.language.parameters import fields_of
from linkwright.designs.language.units import file_from_inside, inside_from_file

FORMAT = "linkwright-kinematics"
FORMAT_VERSION = 1

#: The sections that fix the kinematics; all others shape the parts.
KINEMATIC_SECTIONS = ("parameters", "joint_limits")

Limits = Mapping[str, tuple[float, float]]

#: Unit in a design file -> (suffix in the config, decimal digits from the unit inside to that one).
_SI: dict[str, tuple[str, int]] = {
    "mm": ("m", -3),
    "m": ("m", -3),
    "deg": ("rad", 0),
    "rad": ("rad", 0),
    "kg": ("kg", 0),
    "g": ("kg", 0),
    "n": ("n", 0),
    "nm": ("nm", -3),
    "": ("", 0),
}


class _Head(BaseModel):
    """The keys that every config has; the numbers of the mechanism come beside them."""

    model_config = ConfigDict(extra="allow")

    format: Literal["linkwright-kinematics"]
    format_version: Literal[1]
    mechanism: str
    design: str
    design_hash: str
    branch: str
    assembly_mode: str
    joint_names: list[str]


def write_controller_config(design: Design, measured: Limits, path: Path) -> None:
    """Write the kinematic config of a design.

    Args:
        design: the design.
        measured: joint name -> (lower, upper) as measured on the solids [rad or mm]; joints that were not measured
            have no such keys in the file.
        path: file to write.
    """
    text = json.dumps(config_of(design, measured), indent=2, allow_nan=False, ensure_ascii=True)
    path.write_text(text + "\n", encoding="ascii", newline="\n")


def config_of(design: Design, measured: Limits) -> dict[str, Any]:
    """The config as the flat mapping that is written: who it is, then numbers in SI units.

    Raises:
        ReleaseError: two numbers would share a key, or the home pose cannot be reached.
    """
    mechanism = design.mechanism
    config: dict[str, Any] = {
        "format": FORMAT,
        "format_version": FORMAT_VERSION,
        "mechanism": mechanism.name,
        "design": design.name,
        "design_hash": design.hash,
        "branch": mechanism.branches[0],
        "branches": list(mechanism.branches),
        "assembly_mode": mechanism.assembly_mode,
        "task_names": [c.name for c in mechanism.task],
        "joint_names": [j.name for j in mechanism.joints],
        "joint_kinds": [j.kind.value for j in mechanism.joints],
        "joint_is_active": [j.is_active for j in mechanism.joints],
    }
    for key, value in _numbers(design, measured):
        if key in config:
            raise ReleaseError(
                f"{design.name}: two numbers of the controller's config are called {key}; rename one of them"
            )
        config[key] = value
    return config


def mechanism_numbers(mechanism: Mechanism) -> Iterator[tuple[str, float]]:
    """The controller's parameters in SI units: key with unit -> number."""
    for name, (value, unit) in mechanism.controller_parameters().items():
        yield _si(name, value, unit)


def home_numbers(mechanism: Mechanism) -> Iterator[tuple[str, float]]:
    """The home pose and the joint values there, in SI units.

    Raises:
        ReleaseError: the home pose cannot be reached.
    """
    solution = mechanism.solve_inverse(np.asarray(mechanism.home, dtype=float)[None])
    if not bool(solution.is_reachable[0]):
        raise ReleaseError(
            f"{mechanism.name}: its home pose cannot be reached: {solution.reason(0)}; move the home pose"
        )
    for coordinate, value in zip(mechanism.task, mechanism.home, strict=True):
        yield _si(f"home_pose_{coordinate.name}", float(value), coordinate.unit)
    for joint, value in zip(mechanism.joints, solution.joints[0], strict=True):
        yield _si(f"home_joint_{joint.name}", float(value), joint.unit)


def declared_numbers(mechanism: Mechanism) -> Iterator[tuple[str, float]]:
    """The declared limits of all joints, in SI units."""
    for joint in mechanism.joints:
        yield _si(f"{joint.name}_min", joint.lower, joint.unit)
        yield _si(f"{joint.name}_max", joint.upper, joint.unit)


def mechanism_from_config(path: Path, entry: Entry | None = None) -> Mechanism:
    """The mechanism that a written config describes; equal in its kinematics to the one that was written.

    Args:
        path: the written config.
        entry: the catalogue entry that builds it; None looks it up by the mechanism's name.

    Raises:
        DesignFileError: the file is no config of this format, or a number that the mechanism needs is not in it.
        UnknownNameError: the catalogue has no such mechanism.
    """
    config = read_config(path)
    entry = entry or catalogue.entry(config["mechanism"])
    sections: dict[str, Any] = {}
    for name in KINEMATIC_SECTIONS:
        if name not in entry.sections:
            continue
        numbers: dict[str, Any] = {}
        for field in fields_of(entry.sections[name]):
            key = f"{name}_{si_key(field.name, field.meta.unit)}"
            if key not in config:
                raise DesignFileError(str(path), None, key, None, "is missing")
            numbers[field.name] = _inside_number(config[key], field.meta.unit)
        sections[name] = entry.sections[name](**numbers)
    return entry.build(sections)


def read_config(path: Path) -> dict[str, Any]:
    """The flat mapping of a written config.

    Raises:
        DesignFileError: the file is no config of this format and version.
    """
    try:
        config = json.loads(path.read_text(encoding="ascii"))
        _Head.model_validate(config)
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"]) or "the file"
        raise DesignFileError(str(path), None, key, first.get("input"), first["msg"]) from error
    except ValueError as error:
        raise DesignFileError(str(path), None, "the file", None, f"is no JSON: {error}") from error
    return dict(config)


def si_key(name: str, unit: str) -> str:
    """Key of a number in the config, from its name and its unit in a design file."""
    suffix = _SI[unit][0]
    return f"{name}_{suffix}" if suffix else name


def _numbers(design: Design, measured: Limits) -> Iterator[tuple[str, Any]]:
    mechanism = design.mechanism
    yield from mechanism_numbers(mechanism)
    yield from declared_numbers(mechanism)
    for joint in mechanism.joints:
        if joint.name in measured:
            lower, upper = measured[joint.name]
            yield _si(f"{joint.name}_measured_min", float(lower), joint.unit)
            yield _si(f"{joint.name}_measured_max", float(upper), joint.unit)
    yield from home_numbers(mechanism)
    yield from _section_numbers(mechanism)


def _section_numbers(mechanism: Mechanism) -> Iterator[tuple[str, Any]]:
    for name in KINEMATIC_SECTIONS:
        section = mechanism.sections.get(name)
        for field in fields_of(section) if section is not None else ():
            value, unit = getattr(section, field.name), field.meta.unit
            key, written = f"{name}_{si_key(field.name, unit)}", value
            if isinstance(value, float):
                _, written = _si(field.name, value, unit)
                back = file_from_inside(_inside_number(written, unit), unit)
                if back != file_from_inside(value, unit):
                    raise ReleaseError(f"{mechanism.name}: {key} = {written!r} comes back as {field.key} = {back!r}")
            yield key, written


def _si(name: str, value: float, unit: str) -> tuple[str, float]:
    """Key and number in SI units of a number in the unit inside that a design file writes in `unit`."""
    return si_key(name, unit), _shifted(float(value), _SI[unit][1])


def _inside_number(value: Any, unit: str) -> Any:
    """The number inside that a config's number came from, by way of the design file's, as a design is read."""
    if not unit or isinstance(value, bool | str):
        return value
    return inside_from_file(file_from_inside(_shifted(float(value), -_SI[unit][1]), unit), unit)


def _shifted(value: float, digits: int) -> float:
    """The number with its decimal point moved: exact in decimal, unlike a multiplication."""
    if digits == 0 or not math.isfinite(value):
        return value
    return float(Decimal(repr(value)).scaleb(digits))
