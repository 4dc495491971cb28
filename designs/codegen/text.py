"""What C and JavaScript share: one line a node, margins first, loops as loops."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .graph import LOGICAL, Node, order_of
from .loops import Loop

_INFIX = {"add": "+", "sub": "-", "mul": "*", "div": "/", "lt": "<", "le": "<=", "eq": "==", "and": "&&", "or": "||"}


@dataclass(frozen=True, slots=True, kw_only=True)
class Dialect:
    """How a language spells things.

    Attributes:
        number, truth, variable, count: words before a new name: for a number, a yes or no, a number that will change,
            and a turn counter.
        prefix: of the mathematical functions.
    """

    number: str
    truth: str
    variable: str
    count: str
    prefix: str


class Writer:
    """Names nodes and writes their lines in a dialect."""

    def __init__(
        self, dialect: Dialect, read_input: Callable[[int], str], read_parameter: Callable[[int], str]
    ) -> None:
        self.dialect = dialect
        self.lines: list[str] = []
        self._read = {"input": read_input, "parameter": read_parameter}
        self._names: dict[Node, str] = {}
        self._indent = "    "
        self._loops: dict[Node, list[str]] = {}

    @property
    def done(self) -> set[Node]:
        """Nodes that have a name already."""
        return set(self._names)

    def write(self, text: str) -> None:
        """Write a line."""
        self.lines.append(self._indent + text)

    def name(self, node: Node) -> str:
        """How a node that was written is referred to."""
        if node.op == "const":
            return f"({node.value!r})" if node.value < 0.0 else repr(node.value)
        return self._names[node]

    def compute(self, *roots: Node) -> None:
        """Write all that the roots need and that is not there yet."""
        for node in order_of(roots, self.done):
            self._node(node)

    def _fresh(self, letter: str = "t") -> str:
        return f"{letter}{len(self._names)}"

    def _node(self, node: Node) -> None:
        if node.op == "const":
            return
        if node.op in self._read:
            self._names[node] = self._read[node.op](node.value)
        elif node.op == "loop":
            self._names[node] = ""
            self._loops[node] = self._loop(node)
        elif node.op == "pick":
            self._names[node] = self._loops[node.args[0]][node.value]
        else:
            name = self._fresh()
            word = self.dialect.truth if _is_logical(node) else self.dialect.number
            self.write(f"{word} {name} = {self._expression(node)};")
            self._names[node] = name

    def _expression(self, node: Node) -> str:
        args, op, prefix = [self.name(a) for a in node.args], node.op, self.dialect.prefix
        if op in _INFIX:
            return f"{args[0]} {_INFIX[op]} {args[1]}"
        if op == "where":
            return f"{args[0]} ? {args[1]} : {args[2]}"
        if op == "neg":
            return f"-{args[0]}"
        if op == "not":
            return f"!{args[0]}"
        if op == "atan2":  # a zero of either sign counts as +0, as in the kernels
            return f"{prefix}atan2({args[0]} + 0.0, {args[1]} + 0.0)"
        word = {"root": "sqrt"}.get(op, op)
        if op == "fabs" and prefix:
            word = "abs"
        return f"{prefix}{word}({', '.join(args)})"

    def _loop(self, node: Node) -> list[str]:
        loop: Loop = node.value
        again, following = loop.body.output("again").nodes[0], loop.body.output("next").nodes
        mark = len(self._names)
        carried = [f"c{mark}_{k}" for k in range(loop.n_carried)]
        for name, start in zip(carried, node.args, strict=False):
            self.write(f"{self.dialect.variable} {name} = {self.name(start)};")
        fixed = [self.name(a) for a in node.args[loop.n_carried :]]
        for inner in loop.body.order():
            if inner.op == "input":
                self._names[inner] = (carried + fixed)[inner.value]
        turn = f"n{mark}"
        self.write(f"for ({self.dialect.count} {turn} = 0; {turn} < {loop.n_most}; ++{turn}) {{")
        self._indent += "    "
        self.compute(again)
        self.write(f"if (!{self.name(again)}) break;")
        self.compute(*following)
        # Constants and carried numbers may be among the results: keep all before any changes.
        kept = [f"k{mark}_{k}" for k in range(loop.n_carried)]
        for name, inner in zip(kept, following, strict=True):
            self.write(f"{self.dialect.number} {name} = {self.name(inner)};")
        for name, new in zip(carried, kept, strict=True):
            self.write(f"{name} = {new};")
        self._indent = self._indent[:-4]
        self.write("}")
        return carried


def _is_logical(node: Node) -> bool:
    return node.op in LOGICAL or (node.op == "where" and _is_logical(node.args[1]))
