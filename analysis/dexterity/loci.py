"""Curves on which a planar mechanism is singular, for those that state them.

A mechanism states its curves in its own module, or in a module `loci` beside it: functions whose names end in `_locus`,
that take its parameters, a choice of +1 or -1, an angle [rad], and `require` if a curve exists only at some angles. The
choice is called `side` (of an arm) on serial loci, `sheet` on parallel ones. A mechanism outside the catalogue may do
the same.
"""

from __future__ import annotations

import importlib
import importlib.util
import inspect
import sys
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
    """Formulas of the mechanism's own module and of `loci` beside it, which only a package can hold."""
    own = type(mechanism).__module__
    package = own.rpartition(".")[0]
    names = [own]
    if hasattr(sys.modules.get(package), "__path__") and importlib.util.find_spec(f"{package}.loci") is not None:
        names.append(f"{package}.loci")
    found: list[tuple[str, Callable[..., Any]]] = []
    for name in names:
        module = sys.modules.get(name) or importlib.import_module(name)
        for key, function in inspect.getmembers(module, inspect.isfunction):
            if key.endswith("_locus") and function.__module__ == name:
                found.append((key.removesuffix("_locus"), function))
    return found


def _locus(name: str, function: Callable[..., Any], choice: float, parameters: Any, n: int) -> Locus:
    names = list(inspect.signature(function).parameters)
    angles, need = 2.0 * np.pi * np.arange(n) / n, Requirements()
    with np.errstate(all="ignore"):
        columns = function(parameters, choice, angles, *((need,) if "require" in names else ()))
    points = np.stack(np.broadcast_arrays(*columns), axis=-1)
    exists = np.all(need.stacked((n,)) >= 0.0, axis=-1) & np.all(np.isfinite(points), axis=-1)
    return Locus(name=f"{name} {choice:+.0f}", kind=_KIND_OF_CHOICE[names[1]], points=points[exists])
