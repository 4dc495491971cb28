"""Measurements kept on disk beside the solids that they were taken from, by the hash of all that they depend on."""

from __future__ import annotations

import hashlib
import json
import os
import tempfile
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from linkwright.designs.language.joints import Joint
from linkwright.generator.assembly import AssembledBody
from linkwright.generator.store import Store, code_hash
from linkwright.generator.surfaces import Surface, SurfaceKind

Array = np.ndarray

#: Places are compared at this grain [mm, and parts of a unit vector]; far below any tolerance of a machine.
_GRAIN = 1e-9


class Notebook:
    """Facts as plain JSON values by key. Without a store it remembers for as long as it lives.

    An entry is written aside and renamed; one that cannot be read, or whose checksum is wrong, counts as absent.
    """

    def __init__(self, store: Store | None = None) -> None:
        self._root = store.root.parent / "measured" if store is not None else None
        self._known: dict[str, Any] = {}

    def recall(self, key: str) -> Any | None:
        """What was noted under a key, or None."""
        if key in self._known or self._root is None:
            return self._known.get(key)
        try:
            entry = json.loads(self._path(key).read_text(encoding="utf-8"))
            facts, is_sound = entry["facts"], entry["sum"] == _checksum(key, entry["facts"])
        except (OSError, ValueError, KeyError, TypeError):
            return None
        return facts if is_sound else None

    def note(self, key: str, facts: Any) -> None:
        """Keeps facts under a key. A folder that cannot be written costs speed only, and says so once."""
        self._known[key] = facts
        if self._root is None:
            return
        target = self._path(key)
        try:
            target.parent.mkdir(parents=True, exist_ok=True)
            handle, aside = tempfile.mkstemp(dir=target.parent, suffix=".part")
            try:
                with os.fdopen(handle, "w", encoding="utf-8") as file:
                    json.dump({"sum": _checksum(key, facts), "facts": facts}, file, allow_nan=False)
                Path(aside).replace(target)
            except BaseException:
                Path(aside).unlink(missing_ok=True)
                raise
        except OSError as error:
            self._root = None
            warnings.warn(f"measurements are not kept for the next run: {error}", stacklevel=2)

    def _path(self, key: str) -> Path:
        assert self._root is not None
        return self._root / key[:2] / f"{key}.json"


def _checksum(key: str, facts: Any) -> str:
    return hashlib.sha256(f"{key} {json.dumps(facts, sort_keys=True)}".encode()).hexdigest()


def key_of(what: str, *evidence: Any) -> str:
    """Key of a measurement: its name, plain JSON values that it depends on, and this storey's code."""
    text = json.dumps([what, evidence, code_hash(__package__)], separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()


def evidence_of_body(body: AssembledBody, T_ref_body: Array | None = None) -> list[Any]:
    """What a body looks like from a reference frame: solids, places and roles of its parts, without any names."""
    T = np.eye(4) if T_ref_body is None else T_ref_body
    return [[a.solid.key, rounded(T @ a.T_body_part), a.part.runs_in_joint] for a in body.parts]


def evidence_of_shape(body: AssembledBody, T_ref_body: Array) -> list[Any]:
    """What a body looks like from a reference frame whatever its own frame is: equal for a body turned into itself.

    A part is told by its volume, area, centre and inertia, and by the surfaces that its faces lie on, so a plate with
    three equal arms looks the same from each of them, which its place and its numbers do not say.
    """
    parts = []
    for a in body.parts:
        T = T_ref_body @ a.T_body_part
        R, solid = T[:3, :3], a.solid
        centre, inertia = R @ solid.centre + T[:3, 3], R @ solid.inertia @ R.T
        surfaces = sorted(_evidence_of_surface(surface, T) for surface in solid.surfaces)
        scale = max(1.0, float(np.abs(inertia).max()))  # rounding of a large inertia must not look like a change
        parts.append([_coarse([solid.volume, solid.area, scale]), _coarse(centre), _coarse(inertia / scale), surfaces])
    return sorted(parts)


def _evidence_of_surface(surface: Surface, T: Array) -> list[Any]:
    """A surface without what is arbitrary in its description: the point on a line, the sense of an axis."""
    axis, point = T[:3, :3] @ np.array(surface.axis), T[:3, :3] @ np.array(surface.point) + T[:3, 3]
    along = np.outer(axis, axis)
    if surface.kind is SurfaceKind.PLANE:
        return [surface.kind.value, _coarse([*axis, float(axis @ point)])]
    if surface.kind in (SurfaceKind.CYLINDER, SurfaceKind.CONE):
        return [surface.kind.value, _coarse([surface.radius, *along.reshape(-1), *(point - along @ point)])]
    if surface.kind is SurfaceKind.SPHERE:
        return [surface.kind.value, _coarse([surface.radius, *point])]
    return [surface.kind.value, _coarse([surface.radius, *along.reshape(-1), *point])]


def _coarse(numbers: Any) -> list[int]:
    """Numbers in whole grains of 1e-6, to which solids that were turned and turned back agree."""
    return [round(float(x) * 1e6) for x in np.asarray(numbers, dtype=float).reshape(-1)]


def evidence_of_joint(joint: Joint) -> list[Any]:
    """Where a joint sits in both bodies; its declared limits are no part of a measurement."""
    places = (joint.p_parent, joint.axis_parent, joint.p_child, joint.axis_child)
    return [joint.kind.value, *(rounded(place) for place in places)]


def rounded(numbers: Any) -> list[float]:
    """Numbers at the grain at which places are compared, flat; -0.0 is 0.0."""
    grains = np.round(np.asarray(numbers, dtype=float).reshape(-1) / _GRAIN)
    return [float(g) * _GRAIN + 0.0 for g in grains]
