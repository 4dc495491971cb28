"""Exact derivatives of a program: tangents carried through every node, zeros never written."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from ..language.vocabulary import Number, cos, hypot, sin, sqrt, where
from .graph import Graph, Node
from .program import Output, Program, copied


def differentiate(program: Program, names: Sequence[str], seeds: Sequence[Sequence[Number]] | None = None) -> Program:
    """The program with outputs `d_<name>` of shape (*shape, n_directions) after its own.

    Args:
        program: is copied, so that value and derivative share all they can.
        names: outputs to differentiate; "margins" gives the margins' derivatives, shape (n_margins, n_directions).
        seeds: one direction a row, the rate of each input in it: numbers, or nodes of `program`. Without it, the
            directions are the inputs themselves.

    At a kink (fabs, fmin, where) the derivative is that of the side that is taken.
    """
    n = len(program.inputs)
    rows = seeds if seeds is not None else [[float(i == k) for i in range(n)] for k in range(n)]
    graph = program.graph
    tangents: list[dict[Node, Node]] = []
    order = program.order()
    for row in rows:
        tangent: dict[Node, Node] = {}
        for node in order:
            slope = graph.lift(row[node.value]) if node.op == "input" else _slope(graph, node, tangent)  # type: ignore[index]
            if slope is not None and not slope.is_const(0.0):
                tangent[node] = slope
        tangents.append(tangent)
    zero = graph.const(0.0)
    added = []
    for name in names:
        if name == "margins":
            nodes = tuple(m.node for m in program.margins)
            shape: tuple[int, ...] = (len(nodes),)
        else:
            nodes, shape = program.output(name).nodes, program.output(name).shape
        flat = tuple(tangent.get(node, zero) for node in nodes for tangent in tangents)
        added.append(Output(name=f"d_{name}", shape=(*shape, len(rows)), nodes=flat))
    return program.add(*added).rebuild(copied)


def twist_seeds(program: Program) -> list[list[Number]]:
    """Rates of x, y, z, rx, ry, rz (turns about fixed X, Y, Z) for the six unit twists [v; omega] in base axes.

    Further inputs (a grip) follow with a direction each. So `differentiate(p, ["active"], twist_seeds(p))` is the
    Jacobian of a mechanism that wrote none. Singular at ry = +-90 degrees, where the three angles are.
    """
    ry, rz = program.graph.input(4), program.graph.input(5)
    c, s, t = cos(rz), sin(rz), sin(ry) / cos(ry)
    zero = [0.0, 0.0, 0.0]
    more = len(program.inputs) - 6
    twists: list[list[Number]] = [
        [1.0, 0.0, 0.0, *zero],
        [0.0, 1.0, 0.0, *zero],
        [0.0, 0.0, 1.0, *zero],
        [*zero, c / cos(ry), -s, c * t],
        [*zero, s / cos(ry), c, s * t],
        [*zero, 0.0, 0.0, 1.0],
    ]
    return [[*row, *[0.0] * more] for row in twists] + [
        [float(k == i) for k in range(len(program.inputs))] for i in range(6, 6 + more)
    ]


def _slope(graph: Graph, node: Node, tangent: dict[Node, Node]) -> Node | None:
    """The tangent of a node from those of its arguments; None is zero."""
    if not any(a in tangent for a in node.args):
        return None
    rule = _RULES.get(node.op)
    if rule is None:
        return None  # answers yes or no, or is flat (floor)
    zero = graph.const(0.0)
    return rule(node, *node.args, *(tangent.get(a, zero) for a in node.args))


def _atan2(_: Node, y: Node, x: Node, dy: Node, dx: Node) -> Node:
    return (x * dy - y * dx) / (x * x + y * y)


_RULES: dict[str, Callable[..., Node]] = {
    "add": lambda n, a, b, da, db: da + db,
    "sub": lambda n, a, b, da, db: da - db,
    "mul": lambda n, a, b, da, db: da * b + a * db,
    "div": lambda n, a, b, da, db: (da - n * db) / b,
    "neg": lambda n, a, da: -da,
    "fabs": lambda n, a, da: where(a < 0.0, -da, da),
    "sqrt": lambda n, a, da: da / (2.0 * n),
    "hypot": lambda n, a, b, da, db: (a * da + b * db) / hypot(a, b),
    "sin": lambda n, a, da: cos(a) * da,
    "cos": lambda n, a, da: -(sin(a) * da),
    "atan2": _atan2,
    "acos": lambda n, a, da: -(da / sqrt((1.0 - a) * (1.0 + a))),
    "asin": lambda n, a, da: da / sqrt((1.0 - a) * (1.0 + a)),
    "fmin": lambda n, a, b, da, db: where(a < b, da, db),
    "fmax": lambda n, a, b, da, db: where(b < a, da, db),
    "where": lambda n, c, a, b, dc, da, db: where(c, da, db),
}
