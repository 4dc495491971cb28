"""A design: a mechanism with resolved numbers, and what is asked of it (workspace, clearances, outputs)."""

from __future__ import annotations

import dataclasses
import hashlib
import json
from dataclasses import dataclass
from typing import Any

import numpy as np

from .language.mechanism import Mechanism
from .language.parameters import count, fields_of, flag, length
from .language.units import file_from_inside


@dataclass(frozen=True, slots=True, kw_only=True)
class Clearance:
    """What the checks ask of the solids."""

    minimum: float = length(
        0.5, "least gap between any two bodies over the workspace, contacts of joints excepted", least=0.0
    )
    mesh_deviation: float = length(
        0.02, "largest distance between a solid and the mesh that stands for it in the checks"
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Sampling:
    """How the declared workspace is visited."""

    n_poses: int = count(1000, "poses to visit: half inside the box, half on its faces, edges and corners", least=1)
    seed: int = count(20041, "seed of the poses; the same seed visits the same poses")


@dataclass(frozen=True, slots=True, kw_only=True)
class Outputs:
    """What a release writes besides the design, the findings and the manifest."""

    step: bool = flag(True, "cad/: the assembly and one STEP file per part")
    stl: bool = flag(True, "mesh/: one welded, closed STL per made part, in mm")
    controller: bool = flag(True, "controller/kinematics.json")
    preview: bool = flag(True, "preview.png")
    mesh_deviation: float = length(0.05, "largest distance between a solid and its STL")


@dataclass(frozen=True, slots=True, kw_only=True)
class Allowed:
    """A contact that the designer declares, and why it is one."""

    pair: tuple[str, str]
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Workspace:
    """The box of task coordinates in which the design must work: rows of `Mechanism.task` [mm, rad]."""

    lower: tuple[float, ...]
    upper: tuple[float, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """All that one design file says, resolved.

    Attributes:
        name: of the design; names the files of a release.
        mechanism: with its numbers.
        workspace, sampling, clearance, outputs, allowed: what is asked of it.
        path: file that it came from, empty for a catalogue design.
        lines: dotted key -> line in that file, for findings.
    """

    name: str
    mechanism: Mechanism
    workspace: Workspace
    sampling: Sampling = Sampling()
    clearance: Clearance = Clearance()
    outputs: Outputs = Outputs()
    allowed: tuple[Allowed, ...] = ()
    path: str = ""
    lines: dict[str, int] = dataclasses.field(default_factory=dict, compare=False)

    def resolved(self) -> dict[str, Any]:
        """Every number as a nested table with file keys and file units: what `design.toml` of a release holds."""
        table: dict[str, Any] = {"mechanism": self.mechanism.name, "name": self.name}
        own = {"sampling": self.sampling, "clearance": self.clearance, "outputs": self.outputs}
        for dotted, section in [*self.mechanism.sections.items(), *own.items()]:
            here = table
            for word in dotted.split("."):
                here = here.setdefault(word, {})
            here.update({f.key: _shown(getattr(section, f.name), f.meta.unit) for f in fields_of(section)})
        box = table.setdefault("workspace", {})
        for coordinate, low, high in zip(self.mechanism.task, self.workspace.lower, self.workspace.upper, strict=True):
            box[f"{coordinate.name}_min_{coordinate.unit}"] = file_from_inside(low, coordinate.unit)
            box[f"{coordinate.name}_max_{coordinate.unit}"] = file_from_inside(high, coordinate.unit)
        if self.allowed:
            table["allowed"] = [{"pair": list(a.pair), "reason": a.reason} for a in self.allowed]
        return table

    @property
    def hash(self) -> str:
        """sha256 of the resolved numbers; equal for equal designs, whatever their file looks like."""
        text = json.dumps(self.resolved(), sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode()).hexdigest()

    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Lower and upper corner of the workspace, shape (n_task,) each [mm, rad]."""
        return np.array(self.workspace.lower), np.array(self.workspace.upper)


def _shown(value: Any, unit: str) -> Any:
    if isinstance(value, bool | int | str):
        return value
    return file_from_inside(value, unit)
