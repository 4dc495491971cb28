"""Forward kinematics derived from a mechanism's inverse: Newton from a nearby pose, as one program.

A controller knows the pose of a moment ago; so does a path. For starts from nowhere and all assemblies see
`language/forward.py`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from ..language.errors import LinkwrightError
from ..language.formulas import FormulaMechanism
from ..language.vocabulary import Number, Require, fabs, fmax, fmin, where
from .derivative import differentiate
from .linear import solve_linear
from .loops import repeat_while
from .program import Program
from .trace import trace_formula, trace_mechanism

#: Largest change of a driven joint in one step [rad; times 100 in mm].
_STEP_CAP = 0.3
#: Differences of driven joints that count as reached [rad; times 100 in mm], and steps at most.
TOLERANCE, MOST_STEPS = 1e-11, 30


class NotSquareError(LinkwrightError):
    """A mechanism whose driven joints are not as many as its task coordinates."""

    def __init__(self, name: str, n_active: int, n_task: int) -> None:
        self.name, self.n_active, self.n_task = name, n_active, n_task
        super().__init__(
            f"{name}: forward kinematics by Newton needs as many driven joints ({n_active}) as task coordinates "
            f"({n_task}); use the mechanism's own solve_forward"
        )


def trace_forward(mechanism: FormulaMechanism, branch: str | None = None, *, has_limits: bool = False) -> Program:
    """The program `<name>_forward`: inputs are driven joint values, then the pose to start from.

    Output "pose". First margin "converged"; the others are those of the inverse at the answer.

    Raises:
        NotSquareError: for a redundant mechanism.
    """
    n, joints = len(mechanism.task), mechanism.joints[: mechanism.n_active]
    if len(joints) != n:
        raise NotSquareError(mechanism.name, len(joints), n)
    inverse = trace_mechanism(mechanism, ("active",), branch, has_limits=has_limits)
    slopes = differentiate(inverse, ["active"])
    sizes = [1.0 if joint.unit == "deg" else 100.0 for joint in joints]

    def miss(goal: Sequence[Number], active: Sequence[Number]) -> list[Number]:
        return [
            _wrapped(want - got) if joint.unit == "deg" else want - got
            for joint, want, got in zip(joints, goal, active, strict=True)
        ]

    def largest(misses: Sequence[Number]) -> Number:
        worst: Number = fabs(misses[0] * (1.0 / sizes[0]))
        for value, size in zip(misses[1:], sizes[1:], strict=True):
            worst = fmax(worst, fabs(value * (1.0 / size)))
        return worst

    def step(pose: list[Number], goal: list[Number]) -> tuple[Number, list[Number]]:
        at = slopes.evaluate(pose).outputs
        misses = miss(goal, at["active"])
        worst = largest(misses)
        share = fmin(_STEP_CAP / fmax(worst, 1e-300), 1.0)
        rows = [at["d_active"][n * i : n * i + n] for i in range(n)]
        change = solve_linear(rows, [m * share for m in misses])
        return worst > TOLERANCE * 1e-3, [x + d for x, d in zip(pose, change, strict=True)]

    def formula(inputs: Sequence[Number], _: Sequence[Number], require: Require) -> dict[str, Any]:
        goal, start = list(inputs[:n]), list(inputs[n:])
        pose = repeat_while(start, goal, step, MOST_STEPS)
        there = inverse.evaluate(pose)
        require(TOLERANCE - largest(miss(goal, there.outputs["active"])), "converged")
        for margin, value in zip(inverse.margins, there.margins, strict=True):
            require(value, margin.name)
        return {"pose": pose}

    names = [*(joint.name for joint in joints), *(f"start_{c.name}" for c in mechanism.task)]
    return trace_formula(f"{mechanism.name}_forward", names, (), formula)


def _wrapped(angle: Number) -> Number:
    """An angle less whole turns, for angles within two turns."""
    turn = 2.0 * math.pi
    return where(angle > math.pi, angle - turn, where(angle < -math.pi, angle + turn, angle))
