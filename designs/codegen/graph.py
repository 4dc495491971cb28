"""What a formula becomes when it runs on symbols: a graph of operations in which nothing stands twice.

A `Node` answers the vocabulary and Python's arithmetic, so the formulas of a mechanism run on nodes unchanged. Equal
operations on equal arguments are one node (hash-consing), constants fold at once. Each graph numbers its nodes
from 0, so the text printed from it depends on the formula alone, never on what was traced before.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any

from ..language.errors import LinkwrightError

#: Operations whose arguments may be exchanged without changing a bit of the result.
_COMMUTATIVE = frozenset({"add", "mul", "hypot", "and", "or", "eq"})

#: Operations that answer yes or no; they may only be asked by `where`.
LOGICAL = frozenset({"lt", "le", "eq", "and", "or", "not"})

_FOLDED: dict[str, Callable[..., float]] = {
    "add": lambda a, b: a + b,
    "sub": lambda a, b: a - b,
    "mul": lambda a, b: a * b,
    "div": lambda a, b: a / b,
    "neg": lambda a: -a,
    "fabs": abs,
    "sqrt": lambda a: math.sqrt(a) if a > 0.0 else 0.0,
    "floor": lambda a: float(math.floor(a)),
    "sin": math.sin,
    "cos": math.cos,
    "atan2": math.atan2,
    "acos": lambda a: math.acos(min(1.0, max(-1.0, a))),
    "asin": lambda a: math.asin(min(1.0, max(-1.0, a))),
    "hypot": math.hypot,
    "fmin": min,
    "fmax": max,
}


class TracedBranchError(LinkwrightError):
    """A formula asked a traced number for its value."""

    def __init__(self, asked: str) -> None:
        self.asked = asked
        super().__init__(
            f"a formula asked for {asked} of a traced number; it has none yet: write where(condition, a, b) instead of "
            "`if`, and the vocabulary's sin, cos, sqrt instead of math's"
        )


class Node:
    """One operation of a graph.

    Attributes:
        graph: where it lives; nodes of two graphs do not mix.
        op: its operation; "const", "input" and "parameter" have a value instead of arguments.
        args: nodes it works on.
        value: the constant, the number of the input or parameter, a loop's body, the number of the result picked.
        index: its number in the graph, by order of creation.
    """

    __slots__ = ("args", "graph", "index", "op", "value")

    #: numpy scalars leave arithmetic with a node to the node.
    __array_ufunc__ = None

    def __init__(self, graph: Graph, op: str, args: tuple[Node, ...], value: Any, index: int) -> None:
        self.graph, self.op, self.args, self.value, self.index = graph, op, args, value, index

    @staticmethod
    def __vocabulary__(name: str, args: Sequence[Any]) -> Node:
        graph = next(a.graph for a in args if isinstance(a, Node))
        return graph.make(name, *(graph.lift(a) for a in args))

    def __repr__(self) -> str:
        inside = ", ".join(f"#{a.index}" for a in self.args) if self.args else repr(self.value)
        return f"#{self.index} {self.op}({inside})"

    def __bool__(self) -> bool:
        raise TracedBranchError("the truth")

    def __float__(self) -> float:
        raise TracedBranchError("the value")

    def __add__(self, other: Any) -> Node:
        return self.graph.make("add", self, self.graph.lift(other))

    def __radd__(self, other: Any) -> Node:
        return self.graph.make("add", self.graph.lift(other), self)

    def __sub__(self, other: Any) -> Node:
        return self.graph.make("sub", self, self.graph.lift(other))

    def __rsub__(self, other: Any) -> Node:
        return self.graph.make("sub", self.graph.lift(other), self)

    def __mul__(self, other: Any) -> Node:
        if isinstance(other, tuple):
            return NotImplemented
        return self.graph.make("mul", self, self.graph.lift(other))

    def __rmul__(self, other: Any) -> Node:
        return self.graph.make("mul", self.graph.lift(other), self)

    def __truediv__(self, other: Any) -> Node:
        return self.graph.make("div", self, self.graph.lift(other))

    def __rtruediv__(self, other: Any) -> Node:
        return self.graph.make("div", self.graph.lift(other), self)

    def __neg__(self) -> Node:
        return self.graph.make("neg", self)

    def __pos__(self) -> Node:
        return self

    def __abs__(self) -> Node:
        return self.graph.make("fabs", self)

    def __pow__(self, exponent: int) -> Node:
        if not isinstance(exponent, int) or not 1 <= exponent <= 8:
            raise TracedBranchError(f"the power {exponent!r} (whole numbers 1 to 8 only)")
        power = self
        for _ in range(exponent - 1):
            power = power * self
        return power

    def __lt__(self, other: Any) -> Node:
        return self.graph.make("lt", self, self.graph.lift(other))

    def __le__(self, other: Any) -> Node:
        return self.graph.make("le", self, self.graph.lift(other))

    def __gt__(self, other: Any) -> Node:
        return self.graph.make("lt", self.graph.lift(other), self)

    def __ge__(self, other: Any) -> Node:
        return self.graph.make("le", self.graph.lift(other), self)

    def __and__(self, other: Node) -> Node:
        return self.graph.make("and", self, other)

    def __or__(self, other: Node) -> Node:
        return self.graph.make("or", self, other)

    def __invert__(self) -> Node:
        return self.graph.make("not", self)

    def is_const(self, value: float | None = None) -> bool:
        """It is a constant (of this value)."""
        return self.op == "const" and (value is None or self.value == value)


class Graph:
    """The table of one trace."""

    def __init__(self) -> None:
        self._table: dict[tuple[Any, ...], Node] = {}

    def const(self, value: float) -> Node:
        """A constant; -0.0 counts as 0.0."""
        value = float(value)
        if not math.isfinite(value):
            raise TracedBranchError(f"the constant {value}")
        return self._intern("const", (), value + 0.0)

    def input(self, number: int) -> Node:
        """The input of this number."""
        return self._intern("input", (), number)

    def parameter(self, number: int) -> Node:
        """The parameter of this number."""
        return self._intern("parameter", (), number)

    def loop(self, loop: Any, args: tuple[Node, ...]) -> Node:
        """A loop (see `loops.Loop`) over these starting and fixed numbers; `pick` reads its results."""
        return self._intern("loop", args, loop)

    def pick(self, loop: Node, number: int) -> Node:
        """The carried number of a loop, after it."""
        return self._intern("pick", (loop,), number)

    def lift(self, value: Any) -> Node:
        """A node stays, a number becomes a constant."""
        if isinstance(value, Node):
            assert value.graph is self, "nodes of two graphs do not mix"
            return value
        return self.const(value)

    def make(self, op: str, *args: Node) -> Node:
        """The node of this operation, simplified where that changes no value."""
        if op in _FOLDED and all(a.op == "const" for a in args):
            try:
                value = _FOLDED[op](*(a.value for a in args))
            except (ZeroDivisionError, OverflowError):
                value = math.nan
            if math.isfinite(value):
                return self.const(value)
        simple = _simplify(self, op, args)
        if simple is not None:
            return simple
        if op in _COMMUTATIVE and args[0].index > args[1].index:
            args = (args[1], args[0])
        return self._intern(op, args, None)

    def _intern(self, op: str, args: tuple[Node, ...], value: Any) -> Node:
        key = (op, value, *(a.index for a in args))
        node = self._table.get(key)
        if node is None:
            node = self._table[key] = Node(self, op, args, value, len(self._table))
        return node


def is_nonnegative(node: Node) -> bool:
    """It is plain that the value is never below zero (it may be NaN)."""
    if node.op == "const":
        return bool(node.value >= 0.0)
    if node.op in ("sqrt", "hypot", "fabs", "acos"):
        return True
    if node.op in ("add", "div", "fmin"):
        return all(is_nonnegative(a) for a in node.args)
    if node.op == "fmax":
        return any(is_nonnegative(a) for a in node.args)
    return node.op == "mul" and (node.args[0] is node.args[1] or all(is_nonnegative(a) for a in node.args))


def _simplify(graph: Graph, op: str, args: tuple[Node, ...]) -> Node | None:
    """A simpler node of the same value, if there is one; zeros carry no sign and inputs are finite."""
    rule = _RULES.get(op)
    return rule(graph, *args) if rule is not None else None


def _add(graph: Graph, a: Node, b: Node) -> Node | None:
    if a.is_const(0.0):
        return b
    if b.is_const(0.0):
        return a
    if b.op == "neg":
        return graph.make("sub", a, b.args[0])
    if a.op == "neg":
        return graph.make("sub", b, a.args[0])
    return None


def _sub(graph: Graph, a: Node, b: Node) -> Node | None:
    if b.is_const(0.0):
        return a
    if a.is_const(0.0):
        return graph.make("neg", b)
    if a is b:
        return graph.const(0.0)
    if b.op == "neg":
        return graph.make("add", a, b.args[0])
    if a.op == "neg":
        return graph.make("neg", graph.make("add", a.args[0], b))
    return None


def _mul(graph: Graph, a: Node, b: Node) -> Node | None:
    for one, other in ((a, b), (b, a)):
        if one.is_const(0.0):
            return one
        if one.is_const(1.0):
            return other
        if one.is_const(-1.0):
            return graph.make("neg", other)
        if one.op == "neg":
            return graph.make("neg", graph.make("mul", one.args[0], other))
    if a is b and a.op == "hypot":
        x, y = a.args
        return graph.make("add", graph.make("mul", x, x), graph.make("mul", y, y))
    if a is b and a.op == "sqrt" and is_nonnegative(a.args[0]):
        return a.args[0]
    return None


def _div(graph: Graph, a: Node, b: Node) -> Node | None:
    if b.is_const(1.0) or a.is_const(0.0):
        return a
    if a.op == "neg":
        return graph.make("neg", graph.make("div", a.args[0], b))
    if b.op == "neg":
        return graph.make("neg", graph.make("div", a, b.args[0]))
    if b.op == "const" and b.value and abs(math.frexp(b.value)[0]) == 0.5:
        return graph.make("mul", a, graph.const(1.0 / b.value))
    return None


def _neg(graph: Graph, a: Node) -> Node | None:
    if a.op == "sub":
        return graph.make("sub", a.args[1], a.args[0])
    return a.args[0] if a.op == "neg" else None


def _even(op: str) -> Callable[..., Node | None]:
    def rule(graph: Graph, *args: Node) -> Node | None:
        bare = [a.args[0] if a.op == "neg" else a for a in args]
        return graph.make(op, *bare) if list(args) != bare else None

    return rule


def _odd(op: str) -> Callable[..., Node | None]:
    def rule(graph: Graph, a: Node) -> Node | None:
        return graph.make("neg", graph.make(op, a.args[0])) if a.op == "neg" else None

    return rule


def _fabs(graph: Graph, a: Node) -> Node | None:
    return a if is_nonnegative(a) else _even("fabs")(graph, a)


def _where(_graph: Graph, condition: Node, a: Node, b: Node) -> Node | None:
    return a if a is b or (condition.is_const() and condition.value) else b if condition.is_const() else None


def _compare(holds: Callable[[float, float], bool]) -> Callable[..., Node | None]:
    def rule(graph: Graph, a: Node, b: Node) -> Node | None:
        return graph.const(float(holds(a.value, b.value))) if a.is_const() and b.is_const() else None

    return rule


_RULES: dict[str, Callable[..., Node | None]] = {
    "add": _add,
    "sub": _sub,
    "mul": _mul,
    "div": _div,
    "neg": _neg,
    "fabs": _fabs,
    "cos": _even("cos"),
    "hypot": _even("hypot"),
    "sin": _odd("sin"),
    "asin": _odd("asin"),
    "where": _where,
    "lt": _compare(lambda a, b: a < b),
    "le": _compare(lambda a, b: a <= b),
    "eq": _compare(lambda a, b: a == b),
}


def order_of(roots: Iterable[Node], done: Iterable[Node] = ()) -> list[Node]:
    """All nodes that the roots need, arguments first, in the order in which the roots ask for them.

    Args:
        roots: nodes wanted.
        done: nodes that are already there, with all that they need.
    """
    seen, order = set(done), []
    for root in roots:
        stack: list[tuple[Node, bool]] = [(root, False)]
        while stack:
            node, is_ready = stack.pop()
            if node in seen:
                continue
            if is_ready:
                seen.add(node)
                order.append(node)
            else:
                stack.append((node, True))
                stack.extend((a, False) for a in reversed(node.args))
    return order
