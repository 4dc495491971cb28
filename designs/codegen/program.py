"""A program: named outputs and margins over inputs and parameters; what all printers and passes take."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..language import vocabulary
from .graph import Graph, Node, order_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Output:
    """An array of results: its name, its shape and its nodes in row-major order."""

    name: str
    shape: tuple[int, ...]
    nodes: tuple[Node, ...]


@dataclass(frozen=True, slots=True, kw_only=True)
class Margin:
    """A requirement: legal where the node is >= 0."""

    name: str
    node: Node


@dataclass(frozen=True, slots=True, kw_only=True)
class Values:
    """Results of one evaluation in any kind of number: outputs by name as flat lists, margins in order."""

    outputs: Mapping[str, list[Any]]
    margins: list[Any]


@dataclass(frozen=True, slots=True, kw_only=True)
class Program:
    """A traced formula.

    Attributes:
        name: becomes the name of the printed function.
        inputs, parameters: names, in the order of the numbers that nodes carry.
        outputs: what is computed.
        margins: where it is legal. The status of an evaluation is 0, or k where the k-th margin (from 1) is the first
            that is not a finite number >= 0, or -1 where an input or a result is not finite; in every printed form.
    """

    name: str
    inputs: tuple[str, ...]
    parameters: tuple[str, ...]
    outputs: tuple[Output, ...]
    margins: tuple[Margin, ...]

    @property
    def graph(self) -> Graph:
        """The table that its nodes live in."""
        return (*(o.nodes[0] for o in self.outputs), *(m.node for m in self.margins))[0].graph

    @property
    def results(self) -> tuple[Node, ...]:
        """Nodes of all outputs, one after the other."""
        return tuple(node for output in self.outputs for node in output.nodes)

    def output(self, name: str) -> Output:
        """The output of this name."""
        return next(o for o in self.outputs if o.name == name)

    def order(self) -> list[Node]:
        """All nodes that are needed, margins first."""
        return order_of([*(m.node for m in self.margins), *self.results])

    def keep(self, *names: str) -> Program:
        """The same with these outputs only; what they do not need is not printed."""
        return replace(self, outputs=tuple(self.output(name) for name in names))

    def add(self, *outputs: Output, parameters: Sequence[str] = ()) -> Program:
        """The same with more outputs (and parameters)."""
        return replace(self, outputs=(*self.outputs, *outputs), parameters=(*self.parameters, *parameters))

    def rebuild(self, rule: Callable[[Graph, Node, tuple[Node, ...]], Node]) -> Program:
        """The program with every node made anew, in a fresh graph, by a rule of (graph, old node, new arguments)."""
        graph, new = Graph(), dict[Node, Node]()
        for node in self.order():
            args = tuple(new[a] for a in node.args)
            if node.op == "loop":
                new[node] = graph.loop(node.value.rebuilt(lambda body: body.rebuild(rule)), args)
            elif node.op == "pick":
                new[node] = graph.pick(args[0], node.value)
            else:
                new[node] = rule(graph, node, args)
        return replace(
            self,
            outputs=tuple(replace(o, nodes=tuple(new[n] for n in o.nodes)) for o in self.outputs),
            margins=tuple(replace(m, node=new[m.node]) for m in self.margins),
        )

    def evaluate(self, inputs: Sequence[Any], parameters: Sequence[Any] = ()) -> Values:
        """Run it on any numbers of the vocabulary: floats, arrays, enclosures."""
        from .loops import evaluated_loop

        values: dict[Node, Any] = {}
        for node in self.order():
            if node.op == "const":
                values[node] = node.value
            elif node.op == "input":
                values[node] = inputs[node.value]
            elif node.op == "parameter":
                values[node] = parameters[node.value]
            elif node.op == "loop":
                values[node] = evaluated_loop(node.value, [values[a] for a in node.args])
            elif node.op == "pick":
                values[node] = values[node.args[0]][node.value]
            else:
                values[node] = OPERATIONS[node.op](*(values[a] for a in node.args))
        return Values(
            outputs={o.name: [values[n] for n in o.nodes] for o in self.outputs},
            margins=[values[m.node] for m in self.margins],
        )


def copied(graph: Graph, node: Node, args: tuple[Node, ...]) -> Node:
    """The rule that changes nothing."""
    if node.op == "const":
        return graph.const(node.value)
    if node.op == "input":
        return graph.input(node.value)
    if node.op == "parameter":
        return graph.parameter(node.value)
    return graph.make(node.op, *args)


#: What each operation does to numbers of any kind.
OPERATIONS: dict[str, Callable[..., Any]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "lt": lambda a, b: a < b,
    "le": lambda a, b: a <= b,
    "eq": lambda a, b: a == b,
    "and": lambda a, b: a & b,
    "or": lambda a, b: a | b,
    "not": lambda a: ~a,
    "floor": np.floor,
    **{
        name: getattr(vocabulary, name)
        for name in ("sin", "cos", "atan2", "acos", "asin", "hypot", "sqrt", "fabs", "fmin", "fmax", "where")
    },
}
