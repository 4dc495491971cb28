"""Curves on which a planar mechanism is singular, for those that state them.

A mechanism states its curves in a module `loci` beside its own: functions whose names end in `_locus`, that take its
parameters, a choice of +1 or -1, an angle [rad], and `require` if a curve exists only at some angles. The choice is
called `side` (of an arm) on serial loci, `sheet` on parallel ones. A mechanism outside the catalogue may do the same.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from linkwright.designs.language.mechanism import Mechanism
from linkwright.designs.language.vocabulary import Requirements

from .singularity import Kind

Array = np.ndarray

_KIND_OF_CHOICE = {"side": Kind.SERIAL, "sheet": Kind.PARALLEL}


@dataclass(frozen=True, slots=True, kw_only=True)
class Locus:
    """A singular curve.

    Attributes:
        name: of the formula, and the choice: "stretched +1".
        kind: see `Kind`.
        points: of the hand, in order along the curve, shape (n, n_task) [mm].
    """

    name: str
    kind: Kind
    points: Array


def compute_loci(mechanism: Mechanism, n: int = 720) -> tuple[Locus, ...]:
    """All stated singular curves, at n angles each where they exist; none if the mechanism states none."""
    return tuple(
        _locus(name, function, choice, mechanism.sections["parameters"], n)
        for name, function in _stated(mechanism)
        for choice in (1.0, -1.0)
    )


def _stated(mechanism: Mechanism) -> list[tuple[str, Callable[..., Any]]]:
    package = type(mechanism).__module__.rpartition(".")[0]
    name = f"{package}.loci"
    if not package or importlib.util.find_spec(name) is None:
        return []
    module = importlib.import_module(name)
    found = inspect.getmembers(module, inspect.isfunction)
    return [(key.removesuffix("_locus"), f) for key, f in found if key.endswith("_locus") and f.__module__ == name]


def _locus(name: str, function: Callable[..., Any], choice: float, parameters: Any, n: int) -> Locus:
    names = list(inspect.signature(function).parameters)
    angles, need = 2.0 * np.pi * np.arange(n) / n, Requirements()
    with np.errstate(all="ignore"):
        columns = function(parameters, choice, angles, *((need,) if "require" in names else ()))
    points = np.stack(np.broadcast_arrays(*columns), axis=-1)
    exists = np.all(need.stacked((n,)) >= 0.0, axis=-1) & np.all(np.isfinite(points), axis=-1)
    return Locus(name=f"{name} {choice:+.0f}", kind=_KIND_OF_CHOICE[names[1]], points=points[exists])
