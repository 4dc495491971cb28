"""Prints programs as self-contained C99 for a controller: no allocation, no state, nothing but libm.

    int NAME(const double *in, const double *parameters, double *out)

returns 0 and writes all results one after the other, or k if the k-th requirement is the first that the pose breaks, or
-1 if an input or a result is not finite; `out` is untouched unless 0 is returned.
"""

from __future__ import annotations

from collections.abc import Sequence

from .graph import Node
from .passes import prepared
from .program import Program
from .text import Dialect, Writer

_C = Dialect(number="const double", truth="const int", variable="double", count="int", prefix="")
_HEAD = "#include <float.h>\n#include <math.h>\n"


def emit_c99(*programs: Program, comment: str = "") -> str:
    """One C file with a function for each program; no two may have the same name."""
    parts = [f"/* {comment} */" if comment else "/* Printed by Linkwright from the mechanism's one definition. */"]
    parts += ["", _HEAD + "\n/* 1 if x is a finite number, in C99 and under any rounding. */"]
    parts += ["static int is_finite_number(double x) { return x >= -DBL_MAX && x <= DBL_MAX; }"]
    return "\n".join([*parts, *(_function(prepared(p, is_polynomial=False)) for p in programs), ""])


def declaration(program: Program) -> str:
    """The line for a header."""
    return f"int {program.name}(const double *in, const double *parameters, double *out);"


def _function(program: Program) -> str:
    writer = Writer(_C, lambda k: f"in[{k}]", lambda k: f"parameters[{k}]")
    for k in range(len(program.inputs)):
        writer.write(f"if (!is_finite_number(in[{k}])) return -1;")
    if not program.parameters:
        writer.write("(void)parameters;")
    if not program.inputs:
        writer.write("(void)in;")
    for k, margin in enumerate(program.margins, start=1):
        writer.compute(margin.node)
        value = writer.name(margin.node)
        writer.write(f"if (!({value} >= 0.0 && {value} <= DBL_MAX)) return {k}; /* {margin.name} */")
    writer.compute(*program.results)
    for node in _distinct(program.results):
        writer.write(f"if (!is_finite_number({writer.name(node)})) return -1;")
    for k, node in enumerate(program.results):
        writer.write(f"out[{k}] = {writer.name(node)};")
    writer.write("return 0;")
    return "\n".join(["", *_words(program), declaration(program), declaration(program)[:-1], "{", *writer.lines, "}"])


def _distinct(nodes: Sequence[Node]) -> list[Node]:
    return [n for n in dict.fromkeys(nodes) if n.op != "const"]


def _words(program: Program) -> list[str]:
    """What the arrays hold."""
    at, lines = 0, [f"/* in: {', '.join(program.inputs)}"]
    if program.parameters:
        lines.append(f"   parameters: {', '.join(program.parameters)}")
    for output in program.outputs:
        size = " x ".join(str(n) for n in output.shape) or "1"
        lines.append(f"   out[{at}...]: {output.name} ({size})")
        at += len(output.nodes)
    lines[-1] += " */"
    return lines
