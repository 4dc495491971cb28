"""A loop inside a formula: repeated on numbers, one node with a body of its own on symbols."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..language.vocabulary import Number, where
from .graph import Graph, Node
from .program import Output, Program

Step = Callable[[list[Any], list[Any]], tuple[Any, list[Any]]]


@dataclass(frozen=True, eq=False, slots=True)
class Loop:
    """What a "loop" node repeats.

    Attributes:
        n_carried: how many of the body's inputs are carried from turn to turn; the others stay.
        n_most: turns at most.
        body: outputs "again" (yes or no, asked before each turn) and "next" (the carried numbers after it).
    """

    n_carried: int
    n_most: int
    body: Program

    def rebuilt(self, change: Callable[[Program], Program]) -> Loop:
        """The loop with its body changed."""
        return replace(self, body=change(self.body))


def repeat_while(carried: Sequence[Number], fixed: Sequence[Number], step: Step, n_most: int) -> list[Number]:
    """The carried numbers after as many steps as they ask for; in a batch each pose stops for itself.

    Args:
        carried: numbers to start from.
        fixed: numbers that the step uses and the loop does not change.
        step: of (carried, fixed) gives whether to go on, and the next carried numbers.
        n_most: steps at most.
    """
    node = next((x for x in (*carried, *fixed) if isinstance(x, Node)), None)
    if node is None:
        return _repeated(list(carried), list(fixed), step, n_most)
    graph, inner = node.graph, Graph()
    n, inputs = len(carried), [inner.input(k) for k in range(len(carried) + len(fixed))]
    again, following = step(inputs[:n], inputs[n:])
    body = Program(
        name="body",
        inputs=tuple(f"x{k}" for k in range(len(inputs))),
        parameters=(),
        outputs=(
            Output(name="again", shape=(), nodes=(inner.lift(again),)),
            Output(name="next", shape=(n,), nodes=tuple(inner.lift(x) for x in following)),
        ),
        margins=(),
    )
    loop = graph.loop(Loop(n, n_most, body), tuple(graph.lift(x) for x in (*carried, *fixed)))
    return [graph.pick(loop, k) for k in range(n)]


def _repeated(carried: list[Any], fixed: list[Any], step: Step, n_most: int) -> list[Any]:
    for _ in range(n_most):
        again, following = step(carried, fixed)
        if not np.any(again):
            break
        carried = [where(again, new, old) for new, old in zip(following, carried, strict=True)]
    return carried


def evaluated_loop(loop: Loop, numbers: Sequence[Any]) -> list[Any]:
    """The carried numbers of a loop node after its turns, on numbers of any kind but nodes."""

    def step(carried: list[Any], fixed: list[Any]) -> tuple[Any, list[Any]]:
        values = loop.body.evaluate([*carried, *fixed]).outputs
        return values["again"][0], values["next"]

    return _repeated(list(numbers[: loop.n_carried]), list(numbers[loop.n_carried :]), step, loop.n_most)
