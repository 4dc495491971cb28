"""Prints programs as JavaScript functions for a page: plain text, no modules, the same contract as the C."""

from __future__ import annotations

from .passes import prepared
from .program import Program
from .text import Dialect, Writer

_JS = Dialect(number="const", truth="const", variable="let", count="let", prefix="Math.")


def emit_js(*programs: Program) -> str:
    """A function `NAME(input, parameters, out)` for each program.

    It returns 0 and fills `out`, or k for the first requirement broken, or -1 for what is not finite, and then leaves
    `out` untouched.
    """
    return "\n".join(_function(prepared(p, is_polynomial=False)) for p in programs) + "\n"


def _function(program: Program) -> str:
    writer = Writer(_JS, lambda k: f"input[{k}]", lambda k: f"parameters[{k}]")
    writer.write(f"for (let k = 0; k < {len(program.inputs)}; ++k) if (!Number.isFinite(input[k])) return -1;")
    for k, margin in enumerate(program.margins, start=1):
        writer.compute(margin.node)
        value = writer.name(margin.node)
        writer.write(f"if (!({value} >= 0.0 && {value} < Infinity)) return {k}; // {margin.name}")
    writer.compute(*program.results)
    names = [writer.name(node) for node in program.results]
    writer.write(f"const results = [{', '.join(names)}];")
    writer.write("if (!results.every(Number.isFinite)) return -1;")
    writer.write("for (let k = 0; k < results.length; ++k) out[k] = results[k];")
    writer.write("return 0;")
    return "\n".join([f"function {program.name}(input, parameters, out) {{", *writer.lines, "}"])
