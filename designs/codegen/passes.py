"""Rewrites of a program that keep its values: angles become algebra, inverse trigonometry becomes polynomials."""

from __future__ import annotations

import math
from collections.abc import Callable

from ..language.vocabulary import sqrt, where
from .graph import Graph, Node, is_nonnegative
from .polynomials import lowered_acos, lowered_asin, lowered_atan2, lowered_cos, lowered_sin
from .program import Program, copied

#: A sum of more angles than this is not expanded: the algebra would cost more than the cosine.
_MOST_TERMS = 6


def prepared(program: Program, *, is_polynomial: bool) -> Program:
    """The program as printers take it: trigonometry eliminated, and lowered to `is_polynomial` operations only."""
    return lowered(eliminated(program), is_polynomial=is_polynomial)


def eliminated(program: Program) -> Program:
    """Cosines and sines of sums of atan2, acos and asin written as algebra.

    An author writes angles like the paper; a kernel that needs only their directions then never computes an angle.
    Do not enclose the result in intervals: it repeats arguments.
    """

    def rule(graph: Graph, node: Node, args: tuple[Node, ...]) -> Node:
        if node.op in ("cos", "sin"):
            pair = _expanded(graph, args[0])
            if pair is not None:
                return pair[0] if node.op == "cos" else pair[1]
        return copied(graph, node, args)

    return program.rebuild(rule)


def lowered(program: Program, *, is_polynomial: bool) -> Program:
    """Guards and minima as comparisons; with `is_polynomial` also the elementary functions as straight-line text.

    In the result "root" is the square root of a number that is known to be >= 0, or whose guard stands around it. NaN
    passes through every guard: a NaN pose must not become a legal margin.
    """

    def rule(graph: Graph, node: Node, args: tuple[Node, ...]) -> Node:
        if node.op == "sqrt":
            root = graph.make("root", args[0])
            return root if is_nonnegative(args[0]) else where(args[0] < 0.0, 0.0, root)
        if node.op == "hypot":
            return graph.make("root", args[0] * args[0] + args[1] * args[1])
        if node.op in ("fmin", "fmax"):
            a, b = args if args[1].is_const() else (args[1], args[0]) if args[0].is_const() else args
            takes_b = b < a if node.op == "fmin" else a < b
            return where(takes_b, b, a) if b.is_const() else where(takes_b | ~graph.make("eq", b, b), b, a)
        if node.op in ("acos", "asin"):
            clamped = where(args[0] < -1.0, -1.0, where(args[0] > 1.0, 1.0, args[0]))
            return graph.make(node.op, clamped) if not is_polynomial else _LOWERED[node.op](clamped)
        if is_polynomial and node.op == "div":
            return _divided(*args)
        if is_polynomial and node.op in _LOWERED:
            return _LOWERED[node.op](*args)
        return copied(graph, node, args)

    return program.rebuild(rule)


_LOWERED: dict[str, Callable[..., Node]] = {
    "sin": lowered_sin,
    "cos": lowered_cos,
    "atan2": lowered_atan2,
    "acos": lowered_acos,
    "asin": lowered_asin,
}


def _divided(a: Node, b: Node) -> Node:
    """The quotient, with constant factors of b moved to a: all divisions by multiples of a number share its inverse."""
    while b.op == "mul" and (b.args[0].is_const() or b.args[1].is_const()):
        constant, b = b.args if b.args[0].is_const() else b.args[::-1]
        if not 1e-100 < abs(constant.value) < 1e100:
            return a / (b * constant)
        a = a * (1.0 / constant.value)
    return a / b


def _expanded(graph: Graph, angle: Node) -> tuple[Node, Node] | None:
    """(cos, sin) of a sum of angles whose cosines are algebra; None if some term is not."""
    terms: dict[Node, int] = {}
    turn = _collect(angle, 1, terms)
    if turn is None or sum(abs(k) for k in terms.values()) > _MOST_TERMS or not any(terms.values()):
        return None
    cosine, sine = graph.const(math.cos(turn)), graph.const(math.sin(turn))
    for term, count in terms.items():
        c, s = _pair(graph, term)
        for _ in range(abs(count)):
            t = s if count > 0 else -s
            cosine, sine = cosine * c - sine * t, sine * c + cosine * t
    return cosine, sine


def _collect(angle: Node, factor: int, terms: dict[Node, int]) -> float | None:
    """Sum up an angle as whole multiples of inverse functions plus the turn that is returned."""
    if angle.op == "const":
        return float(factor * angle.value)
    if angle.op in ("atan2", "acos", "asin"):
        terms[angle] = terms.get(angle, 0) + factor
        return 0.0
    if angle.op == "neg":
        return _collect(angle.args[0], -factor, terms)
    if angle.op == "mul":
        for two, half in (angle.args, angle.args[::-1]):
            if two.is_const(2.0):
                return _collect(half, 2 * factor, terms)
    if angle.op in ("add", "sub"):
        left = _collect(angle.args[0], factor, terms)
        right = _collect(angle.args[1], factor if angle.op == "add" else -factor, terms)
        return None if left is None or right is None else left + right
    return None


def _pair(graph: Graph, term: Node) -> tuple[Node, Node]:
    """(cos, sin) of one inverse function."""
    if term.op == "atan2":
        y, x = term.args
        length = graph.make("hypot", x, y)
        return x / length, y / length
    u = graph.make("fmin", graph.make("fmax", term.args[0], graph.const(-1.0)), graph.const(1.0))
    other = sqrt((1.0 - u) * (1.0 + u))
    return (u, other) if term.op == "acos" else (other, u)
