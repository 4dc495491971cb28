"""Prints a program as LLVM IR that computes eight poses at once.

The function `void kernel(double *in, double *parameters, double *out, i64 n_blocks)` reads rows of inputs and writes
rows of results (outputs, margins, status), eight poses a block. A row of results is padded to a multiple of eight and
begins on a cache line. Everything between is straight-line arithmetic on vectors of eight, and loops where a formula
has them; rows are turned to lanes and back inside, so that callers keep plain
(n, k) arrays. What depends on parameters only is computed once, before the loop.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from .graph import LOGICAL, Node, order_of
from .loops import Loop
from .passes import prepared
from .program import Program
from .schedule import scheduled

#: Lanes of a block.
WIDTH = 8
#: Fused multiply-add, division by a common reciprocal, zeros without sign; never a promise that NaN cannot occur.
_FLAGS = "nsz arcp contract"
_V, _M = f"<{WIDTH} x double>", f"<{WIDTH} x i1>"

_ZERO, _INF, _NEVER = (
    f"<{', '.join([f'double {v}'] * WIDTH)}>" for v in ("0.0", "0x7FF0000000000000", "0xFFF0000000000000")
)

_BINARY = {"add": "fadd", "sub": "fsub", "mul": "fmul", "div": "fdiv"}
_COMPARE = {"lt": "olt", "le": "ole", "eq": "oeq"}
_UNARY = {"root": "sqrt", "fabs": "fabs", "floor": "floor"}


@dataclass(frozen=True, slots=True, kw_only=True)
class KernelText:
    """Printed IR and the layout of its result rows.

    Attributes:
        text: LLVM IR.
        n_results: numbers of all outputs; margins follow them, then the status.
        n_margins: margins in a row; 0 where they only make the status.
        row_length: doubles a row, a multiple of eight.
    """

    text: str
    n_results: int
    n_margins: int
    row_length: int


def emit_llvm(program: Program, *, is_strict: bool = False, has_margins: bool = True) -> KernelText:
    """The kernel of a program.

    Args:
        program: traced and not yet lowered.
        is_strict: every operation rounds as IEEE 754 says, with no fused or exchanged operation.
        has_margins: margins are written; without it only the status tells of them.
    """
    program = prepared(program, is_polynomial=True)
    printer = _Printer("" if is_strict else _FLAGS)
    margins, results = [m.node for m in program.margins], list(program.results)
    early = [n for n in order_of([*margins, *results]) if _is_early(n, printer.early)]
    for node in early:
        printer.node(node, printer.before)
    body = printer.body
    total = _check_of_inputs(printer, len(program.inputs))
    for node in scheduled([*margins, *results], printer.early):
        printer.node(node, body)
    n_margins = len(margins) if has_margins else 0
    length = -(-(len(results) + n_margins + 1) // WIDTH) * WIDTH
    for k, node in enumerate(results):
        body.append(f"  store {_V} {printer.name(node)}, ptr {_slot(printer, body, k)}, align 64")
    _store_status(printer, results, margins, total, has_margins=has_margins)
    return KernelText(
        text=_frame(printer, len(program.inputs), len(results), length),
        n_results=len(results),
        n_margins=n_margins,
        row_length=length,
    )


def _is_early(node: Node, early: set[Node]) -> bool:
    """It depends on parameters only."""
    if node.op == "parameter" or (
        node.op not in ("loop", "pick")
        and any(a in early for a in node.args)
        and all(a in early or a.op == "const" for a in node.args)
    ):
        early.add(node)
    return node in early


class _Printer:
    """Names and lines."""

    def __init__(self, flags: str) -> None:
        self.flags, self.early = flags, set[Node]()
        self.before: list[str] = []
        self.body: list[str] = []
        self._names: dict[Node, str] = {}
        self._count = 0
        self._picks: dict[Node, list[str]] = {}
        #: Label of the part of the function that lines go to.
        self.label = "loop"

    def fresh(self) -> str:
        self._count += 1
        return f"%v{self._count}"

    def line(self, lines: list[str], text: str) -> str:
        name = self.fresh()
        lines.append(f"  {name} = {text}")
        return name

    def name(self, node: Node) -> str:
        if node.op == "const":
            return f"<{', '.join([f'double {_hex(node.value)}'] * WIDTH)}>"
        return self._names[node]

    def node(self, node: Node, lines: list[str]) -> None:
        if node.op == "const" or node in self._names:
            return
        if node.op == "loop":
            self._picks[node] = self._loop(node, lines)
            return
        args = [] if node.op == "pick" else [self.name(a) for a in node.args]
        self._names[node] = self._operation(node, args, lines)

    def _operation(self, node: Node, args: list[str], lines: list[str]) -> str:
        op, flags = node.op, self.flags
        if op == "input":
            return f"%in{node.value}"
        if op == "pick":
            return self._picks[node.args[0]][node.value]
        if op == "parameter":
            at = self.line(lines, f"getelementptr double, ptr %parameters, i64 {node.value}")
            scalar = self.line(lines, f"load double, ptr {at}")
            first = self.line(lines, f"insertelement {_V} poison, double {scalar}, i64 0")
            return self.line(lines, f"shufflevector {_V} {first}, {_V} poison, <{WIDTH} x i32> zeroinitializer")
        if op in _BINARY:
            return self.line(lines, f"{_BINARY[op]} {flags} {_V} {args[0]}, {args[1]}")
        if op == "neg":
            return self.line(lines, f"fneg {flags} {_V} {args[0]}")
        if op in _UNARY:
            return self.line(lines, f"call {_V} @llvm.{_UNARY[op]}.v{WIDTH}f64({_V} {args[0]})")
        if op in _COMPARE:
            return self.line(lines, f"fcmp {_COMPARE[op]} {_V} {args[0]}, {args[1]}")
        if op in ("and", "or"):
            return self.line(lines, f"{op} {_M} {args[0]}, {args[1]}")
        if op == "not":
            return self.line(lines, f"xor {_M} {args[0]}, <{', '.join(['i1 true'] * WIDTH)}>")
        assert op == "where", f"{op} is not lowered"
        kind = _M if node.args[1].op in LOGICAL else _V
        return self.line(lines, f"select {_M} {args[0]}, {kind} {args[1]}, {kind} {args[2]}")

    def _loop(self, node: Node, lines: list[str]) -> list[str]:
        """A `while` of which each lane leaves for itself; the block leaves with its last lane."""
        loop: Loop = node.value
        head = f"head{self._count}"
        again, following = loop.body.output("again").nodes[0], loop.body.output("next").nodes
        starts, carried = [self.name(a) for a in node.args], [self.fresh() for _ in range(loop.n_carried)]
        count, more, before = self.fresh(), self.fresh(), self.label
        ends = [self.fresh() for _ in range(loop.n_carried)]
        for inner in loop.body.order():
            if inner.op == "input":
                self._names[inner] = (carried + starts[loop.n_carried :])[inner.value]
        lines += [f"  br label %{head}", f"{head}:"]
        for name, start, end in zip(carried, starts, ends, strict=False):
            lines.append(f"  {name} = phi {_V} [ {start}, %{before} ], [ {end}, %{head}_body ]")
        lines.append(f"  {count} = phi i64 [ 0, %{before} ], [ {more}, %{head}_body ]")
        asked = scheduled([again])
        for inner in asked:
            self.node(inner, lines)
        bits = self.line(lines, f"bitcast {_M} {self.name(again)} to i{WIDTH}")
        wanted = self.line(lines, f"icmp ne i{WIDTH} {bits}, 0")
        left = self.line(lines, f"icmp ult i64 {count}, {loop.n_most}")
        go = self.line(lines, f"and i1 {wanted}, {left}")
        lines += [f"  br i1 {go}, label %{head}_body, label %{head}_end", f"{head}_body:"]
        for inner in scheduled(following, asked):
            self.node(inner, lines)
        for end, inner, name in zip(ends, following, carried, strict=True):
            lines.append(f"  {end} = select {_M} {self.name(again)}, {_V} {self.name(inner)}, {_V} {name}")
        lines += [f"  {more} = add i64 {count}, 1", f"  br label %{head}", f"{head}_end:"]
        self.label = f"{head}_end"
        return carried


def _check_of_inputs(printer: _Printer, n: int) -> str:
    """A number that is 0 where all inputs are finite, else NaN."""
    total = ""
    for k in range(n):
        gone = printer.line(printer.body, f"fsub {_V} %in{k}, %in{k}")
        total = printer.line(printer.body, f"fadd {_V} {total}, {gone}") if total else gone
    return total or "zeroinitializer"


def _store_status(
    printer: _Printer, results: list[Node], margins: list[Node], total: str, *, has_margins: bool
) -> None:
    """Margins (-inf where not finite), the status, and whether all of the block is legal."""
    body, line = printer.body, printer.line
    chains = ["zeroinitializer"] * 4
    for k, node in enumerate(results):
        gone = line(body, f"fmul contract {_V} {printer.name(node)}, {_ZERO}")
        chains[k % 4] = line(body, f"fadd contract {_V} {chains[k % 4]}, {gone}")
    left, right = (line(body, f"fadd {_V} {chains[k]}, {chains[k + 1]}") for k in (0, 2))
    every = line(body, f"fadd {_V} {left}, {right}")
    is_bad = line(body, f"fcmp uno {_V} {every}, {every}")
    codes = [f"<{', '.join([f'double {_hex(float(k))}'] * WIDTH)}>" for k in range(-1, len(margins) + 1)]
    status = line(body, f"select {_M} {is_bad}, {_V} {codes[0]}, {_V} zeroinitializer")
    for k in reversed(range(len(margins))):
        if has_margins:
            is_legal = _kept_margin(printer, margins[k], total, len(results) + k)
        else:
            name = printer.name(margins[k])
            above, below = (line(body, f"fcmp {c} {_V} {name}, {end}") for c, end in (("oge", _ZERO), ("olt", _INF)))
            is_legal = line(body, f"and {_M} {above}, {below}")
        status = line(body, f"select {_M} {is_legal}, {_V} {status}, {_V} {codes[k + 2]}")
    is_finite = line(body, f"fcmp ord {_V} {total}, {total}")
    status = line(body, f"select {_M} {is_finite}, {_V} {status}, {_V} {codes[0]}")
    body.append(
        f"  store {_V} {status}, ptr {_slot(printer, body, len(results) + has_margins * len(margins))}, align 64"
    )
    is_wrong = line(body, f"fcmp une {_V} {status}, zeroinitializer")
    bits = line(body, f"bitcast {_M} {is_wrong} to i{WIDTH}")
    body.append(f"  %is_clean = icmp eq i{WIDTH} {bits}, 0")


def _kept_margin(printer: _Printer, margin: Node, total: str, slot: int) -> str:
    """Store a margin, -inf where it or an input is not finite; the mask of lanes where it is legal."""
    body, line = printer.body, printer.line
    shifted = line(body, f"fadd {_V} {printer.name(margin)}, {total}")
    size = line(body, f"call {_V} @llvm.fabs.v{WIDTH}f64({_V} {shifted})")
    is_finite = line(body, f"fcmp olt {_V} {size}, {_INF}")
    kept = line(body, f"select {_M} {is_finite}, {_V} {shifted}, {_V} {_NEVER}")
    body.append(f"  store {_V} {kept}, ptr {_slot(printer, body, slot)}, align 64")
    return line(body, f"fcmp oge {_V} {kept}, zeroinitializer")


def _slot(printer: _Printer, lines: list[str], k: int) -> str:
    return printer.line(lines, f"getelementptr {_V}, ptr %scratch, i64 {k}")


def _zeros(length: int) -> list[str]:
    """Clear the end of the scratch, so that padding is 0."""
    lines = []
    for k in range(length - WIDTH, length):
        lines.append(f"  %s{k} = getelementptr {_V}, ptr %scratch, i64 {k}")
        lines.append(f"  store {_V} zeroinitializer, ptr %s{k}, align 64")
    return lines


def _hex(value: float) -> str:
    return f"0x{struct.unpack('>Q', struct.pack('>d', value))[0]:016X}"


def _loads(n: int) -> list[str]:
    """Rows of inputs turned to lanes."""
    lines = [f"  %first = mul i64 %block, {WIDTH * n}", "  %row = getelementptr double, ptr %in, i64 %first"]
    for k in range(n):
        vector = "poison"
        for lane in range(WIDTH):
            lines += [
                f"  %a{k}_{lane} = getelementptr double, ptr %row, i64 {lane * n + k}",
                f"  %x{k}_{lane} = load double, ptr %a{k}_{lane}",
                f"  %{'in' + str(k) if lane == WIDTH - 1 else f'i{k}_{lane}'} = "
                f"insertelement {_V} {vector}, double %x{k}_{lane}, i64 {lane}",
            ]
            vector = f"%i{k}_{lane}"
    return lines


def _turned() -> list[str]:
    """Eight vectors of the scratch, from %group on, turned to eight pieces of rows."""
    names = [f"%t0_{k}" for k in range(8)]
    lines = ["  %from = getelementptr " + _V + ", ptr %scratch, i64 %group"]
    for k in range(8):
        lines += [
            f"  %f{k} = getelementptr {_V}, ptr %from, i64 {k}",
            f"  %t0_{k} = load {_V}, ptr %f{k}, align 64",
        ]
    masks = {
        1: ([0, 8, 2, 10, 4, 12, 6, 14], [1, 9, 3, 11, 5, 13, 7, 15]),
        2: ([0, 1, 8, 9, 4, 5, 12, 13], [2, 3, 10, 11, 6, 7, 14, 15]),
        4: ([0, 1, 2, 3, 8, 9, 10, 11], [4, 5, 6, 7, 12, 13, 14, 15]),
    }
    for stage, (low, high) in masks.items():
        new = list(names)
        for k in range(8):
            if k & stage:
                continue
            for which, mask in ((k, low), (k + stage, high)):
                text = ", ".join(f"i32 {m}" for m in mask)
                new[which] = f"%t{stage}_{which}"
                pair = f"{_V} {names[k]}, {_V} {names[k + stage]}"
                lines.append(f"  {new[which]} = shufflevector {pair}, <8 x i32> <{text}>")
        names = new
    return [*lines, *(f"  store {_V} {names[k]}, ptr %o{k}, align 64" for k in range(8))]


def _frame(printer: _Printer, n_inputs: int, n_results: int, length: int) -> str:
    """The function around the body: loop over blocks, cleaning of what is not finite, rows out."""
    n = max(n_results, 1)
    cleaning = [
        "clean:",
        f"  %k = phi i64 [ 0, %{printer.label} ], [ %k1, %clean ]",
        f"  %dirty = getelementptr {_V}, ptr %scratch, i64 %k",
        f"  %old = load {_V}, ptr %dirty, align 64",
        f"  %gone = fsub {_V} %old, %old",
        f"  %fine = fcmp ord {_V} %gone, %gone",
        f"  %new = select {_M} %fine, {_V} %old, {_V} zeroinitializer",
        f"  store {_V} %new, ptr %dirty, align 64",
        "  %k1 = add i64 %k, 1",
        f"  %k_done = icmp eq i64 %k1, {n}",
        "  br i1 %k_done, label %turn_all, label %clean",
    ]
    rows = [f"  %o{k} = getelementptr double, ptr %to, i64 {k * length}" for k in range(8)]
    return "\n".join(
        [
            f"declare {_V} @llvm.sqrt.v{WIDTH}f64({_V})",
            f"declare {_V} @llvm.fabs.v{WIDTH}f64({_V})",
            f"declare {_V} @llvm.floor.v{WIDTH}f64({_V})",
            "define void @kernel(ptr noalias readonly %in, ptr noalias readonly %parameters, ptr noalias %out, "
            "i64 %n_blocks) #0 {",
            "entry:",
            f"  %scratch = alloca [{length} x {_V}], align 64",
            *_zeros(length),
            *printer.before,
            "  br label %loop",
            "loop:",
            "  %block = phi i64 [ 0, %entry ], [ %next, %end ]",
            *_loads(n_inputs),
            *printer.body,
            "  br i1 %is_clean, label %turn_all, label %clean" if n_results else "  br label %turn_all",
            *(cleaning if n_results else []),
            "turn_all:",
            f"  %out_first = mul i64 %block, {WIDTH * length}",
            "  %out_row = getelementptr double, ptr %out, i64 %out_first",
            "  br label %turn",
            "turn:",
            "  %group = phi i64 [ 0, %turn_all ], [ %group1, %turn ]",
            "  %to = getelementptr double, ptr %out_row, i64 %group",
            *rows,
            *_turned(),
            f"  %group1 = add i64 %group, {WIDTH}",
            f"  %turned = icmp eq i64 %group1, {length}",
            "  br i1 %turned, label %end, label %turn",
            "end:",
            "  %next = add i64 %block, 1",
            "  %is_last = icmp eq i64 %next, %n_blocks",
            "  br i1 %is_last, label %exit, label %loop",
            "exit:",
            "  ret void",
            "}",
            'attributes #0 = { nounwind "min-legal-vector-width"="512" "prefer-vector-width"="512" }',
            "",
        ]
    )
