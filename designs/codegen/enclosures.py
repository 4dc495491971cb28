"""What a program yields over whole boxes of poses: certificates instead of samples."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..language.errors import LinkwrightError
from .affine import Affine
from .intervals import Array, Interval
from .program import Program


class UnboundedLoopError(LinkwrightError):
    """A program with a loop cannot be enclosed."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(
            f"{name}: a program that repeats until it settles cannot be enclosed; enclose what it works on (the "
            "Jacobian) or the threshold form instead"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Enclosure:
    """Bounds over n boxes.

    Attributes:
        outputs: by name, lower and upper bounds, each of shape (n, *shape).
        margins_lower, margins_upper: bounds of the margins, shape (n, n_margins).
    """

    outputs: Mapping[str, tuple[Array, Array]]
    margins_lower: Array
    margins_upper: Array

    @property
    def is_inside(self) -> Array:
        """Every pose of the box is legal, shape (n,)."""
        return np.all(self.margins_lower >= 0.0, axis=-1)

    @property
    def is_outside(self) -> Array:
        """No pose of the box is legal, shape (n,)."""
        return np.any(self.margins_upper < 0.0, axis=-1)


def enclose(
    program: Program, lower: Array, upper: Array, parameters: Sequence[float] = (), *, is_affine: bool = True
) -> Enclosure:
    """Bounds of all outputs and margins over boxes with corners `lower`, `upper`, shape (n, n_inputs).

    Args:
        program: traced and not lowered; eliminating trigonometry would loosen the bounds.
        lower, upper: corners, finite, lower <= upper.
        parameters: values of the program's parameters.
        is_affine: affine forms (narrow boxes: about exact) or plain intervals (three times faster, wider).

    Raises:
        UnboundedLoopError: the program repeats something.
    """
    lower, upper = (np.atleast_2d(np.asarray(a, dtype=float)) for a in (lower, upper))
    if lower.shape != upper.shape or not np.all(lower <= upper) or not np.all(np.isfinite([lower, upper])):
        raise ValueError(f"{program.name}: boxes need finite corners of one shape with lower <= upper")
    if any(node.op == "loop" for node in program.order()):
        raise UnboundedLoopError(program.name)
    inputs: list[Any] = (
        list(Affine.box(lower, upper))
        if is_affine
        else [Interval(lower[:, k], upper[:, k]) for k in range(lower.shape[1])]
    )
    with np.errstate(all="ignore"):
        values = program.evaluate(inputs, parameters)
    n = len(lower)
    outputs = {}
    for output in program.outputs:
        low, high = _ends(values.outputs[output.name], n)
        outputs[output.name] = low.reshape(n, *output.shape), high.reshape(n, *output.shape)
    low, high = _ends(values.margins, n)
    return Enclosure(outputs=outputs, margins_lower=low, margins_upper=high)


def _ends(values: Sequence[Any], n: int) -> tuple[Array, Array]:
    intervals = [v.interval if isinstance(v, Affine) else Interval.lift(v) for v in values]
    if not intervals:
        return np.empty((n, 0)), np.empty((n, 0))
    lower, upper = (
        np.stack([np.broadcast_to(getattr(i, end), (n,)) for i in intervals], axis=-1) for end in ("lower", "upper")
    )
    return lower, upper
