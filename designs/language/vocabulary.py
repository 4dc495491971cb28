"""The functions in which kinematics is written once, for every kind of number.

A formula written in these words runs on floats and on numpy arrays (a batch of poses) today. Another kind of number
(a traced node, an interval) joins by defining `__vocabulary__(name, args)`; no formula changes for it.

Formulas never branch on a value. Where one is legal only on one side of a limit it says so through the `require`
that it is handed: `require(margin, name)`, legal where margin >= 0. Outside, the functions below stay finite
(arguments are clamped to their domain), so that the margin, not a NaN, carries the message.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import numpy as np

#: A float, an array of them, or any number that answers `__vocabulary__`.
Number = Any


class Require(Protocol):
    """What a formula calls to state where it is legal."""

    def __call__(self, margin: Number, name: str) -> None:
        """State one requirement."""


def _word(name: str, on_arrays: Callable[..., Number]) -> Callable[..., Number]:
    def spoken(*args: Number) -> Number:
        for arg in args:
            hook = getattr(type(arg), "__vocabulary__", None)
            if hook is not None:
                return hook(name, args)
        return on_arrays(*args)

    spoken.__name__ = spoken.__qualname__ = name
    return spoken


sin = _word("sin", np.sin)
cos = _word("cos", np.cos)
#: A zero of either sign counts as +0, as in every printed form: rounding must not turn an angle by pi.
atan2 = _word("atan2", lambda y, x: np.arctan2(y + 0.0, x + 0.0))
hypot = _word("hypot", np.hypot)
fabs = _word("fabs", np.abs)
#: NaN stays NaN in both, so that a bad pose cannot become a legal margin.
fmin = _word("fmin", np.minimum)
fmax = _word("fmax", np.maximum)
where = _word("where", np.where)
sqrt = _word("sqrt", lambda x: np.sqrt(np.where(x < 0.0, 0.0, x)))
acos = _word("acos", lambda x: np.arccos(np.clip(x, -1.0, 1.0)))
asin = _word("asin", lambda x: np.arcsin(np.clip(x, -1.0, 1.0)))


class Requirements:
    """Collects the margins of one evaluation; hand an instance to a formula as its `require`."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.margins: list[Number] = []

    def __call__(self, margin: Number, name: str) -> None:
        """Keep the margin and its name."""
        self.names.append(name)
        self.margins.append(margin)

    def stacked(self, shape: tuple[int, ...]) -> np.ndarray:
        """All margins as one array, shape (*shape, n_requirements)."""
        columns = [np.broadcast_to(np.asarray(m, dtype=float), shape) for m in self.margins]
        return np.stack(columns, axis=-1) if columns else np.zeros((*shape, 0))
