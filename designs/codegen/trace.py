"""Runs a mechanism's formulas on symbols once, and keeps what they did as a `Program`."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..language.errors import LinkwrightError, UnknownNameError
from ..language.formulas import LIMIT_SLACK, FormulaMechanism
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require
from .graph import Graph, Node
from .program import Margin, Output, Program

#: What of a mechanism can be traced: all joints, the driven ones, rate rows, body poses as rows of [R | p].
OUTPUTS = ("joints", "active", "jacobian", "frames")

Formula = Callable[[Sequence[Number], Sequence[Number], Require], Mapping[str, Any]]


class FixedParametersError(LinkwrightError):
    """A mechanism whose formulas read numbers that were fixed when it was made."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(
            f"{name}: its formulas read none of its parameters, only numbers made from them; trace it with numbers, or "
            "give it a method with_parameters(section)"
        )


def trace_formula(name: str, inputs: Sequence[str], parameters: Sequence[str], formula: Formula) -> Program:
    """The program of any formula.

    Args:
        name: of the program.
        inputs, parameters: names of the numbers that the formula is handed, as two sequences.
        formula: takes inputs, parameters and `require`; returns numbers, or nested sequences of equal rows, by name.
    """
    graph, margins = Graph(), []

    def require(margin: Number, name: str) -> None:
        margins.append(Margin(name=name, node=graph.lift(margin)))

    results = formula(
        [graph.input(k) for k in range(len(inputs))], [graph.parameter(k) for k in range(len(parameters))], require
    )
    outputs = []
    for key, value in results.items():
        shape, flat = _flattened(value)
        outputs.append(Output(name=key, shape=shape, nodes=tuple(graph.lift(v) for v in flat)))
    return Program(
        name=name, inputs=tuple(inputs), parameters=tuple(parameters), outputs=tuple(outputs), margins=tuple(margins)
    )


def _flattened(value: Any) -> tuple[tuple[int, ...], list[Any]]:
    if not isinstance(value, Sequence):
        return (), [value]
    rows = [_flattened(v) for v in value]
    shapes = {shape for shape, _ in rows}
    assert len(shapes) == 1, f"rows of different shapes: {sorted(shapes)}"
    return (len(rows), *shapes.pop()), [v for _, flat in rows for v in flat]


def trace_mechanism(
    mechanism: FormulaMechanism,
    outputs: Sequence[str] = ("joints", "jacobian", "frames"),
    branch: str | None = None,
    *,
    has_symbols: bool = False,
    has_limits: bool = False,
) -> Program:
    """The program of a mechanism's inverse kinematics.

    Args:
        mechanism: whose formulas are traced.
        outputs: which of `OUTPUTS` the program computes.
        branch: working mode; a program holds one.
        has_symbols: the numbers of the section `parameters` stay symbols (one kernel for all dimensions); else they
            fold into the text. Numbers that a mechanism computed from them when it was made stay numbers, unless it
            has a method `with_parameters(section)` that makes them anew for a section of symbols.
        has_limits: the joint limits become margins after the formulas' own.

    Raises:
        UnknownNameError: lists the outputs, or the branches.
        FixedParametersError: symbols were asked for and the formulas read none.
    """
    for name in outputs:
        if name not in OUTPUTS:
            raise UnknownNameError("traced output", name, OUTPUTS)
    names = _symbol_names(mechanism) if has_symbols else ()

    def formula(pose: Sequence[Number], symbols: Sequence[Number], require: Require) -> dict[str, Any]:
        traced = _with_symbols(mechanism, dict(zip(names, symbols, strict=True))) if has_symbols else mechanism
        state = traced.solve_state(tuple(pose), traced.read_branch(branch), require)
        joints = tuple(traced.joint_values(state)) if {"joints", "active"} & set(outputs) or has_limits else ()
        if has_limits:
            for joint, value in zip(mechanism.joints, joints, strict=True):
                require(value - joint.lower + LIMIT_SLACK, f"{joint.name} below its limit")
            for joint, value in zip(mechanism.joints, joints, strict=True):
                require(joint.upper - value + LIMIT_SLACK, f"{joint.name} above its limit")
        read: dict[str, Callable[[], Any]] = {
            "joints": lambda: joints,
            "active": lambda: joints[: mechanism.n_active],
            "jacobian": lambda: traced.rate_rows(state),
            "frames": lambda: [_pose_rows(R, p) for R, p in traced.body_frames(state)],
        }
        return {key: read[key]() for key in outputs}

    program = trace_formula(mechanism.name, [c.name for c in mechanism.task], names, formula)
    if has_symbols and not any(node.op == "parameter" for node in program.order()):
        raise FixedParametersError(mechanism.name)
    return program


def parameter_values(mechanism: FormulaMechanism) -> tuple[float, ...]:
    """The numbers that a program traced with symbols takes, for this mechanism."""
    section = mechanism.sections["parameters"]
    return tuple(float(getattr(section, name)) for name in _symbol_names(mechanism))


def _symbol_names(mechanism: FormulaMechanism) -> tuple[str, ...]:
    section = mechanism.sections["parameters"]
    return tuple(f.name for f in dataclasses.fields(section) if isinstance(getattr(section, f.name), float))


def _with_symbols(mechanism: FormulaMechanism, symbols: Mapping[str, Node]) -> Any:
    """A copy of the mechanism whose parameters are nodes; properties of the section then compute with nodes."""
    section = mechanism.sections["parameters"]
    stand_in = object.__new__(type(section))
    for f in dataclasses.fields(section):
        object.__setattr__(stand_in, f.name, symbols.get(f.name, getattr(section, f.name)))
    with_parameters = getattr(mechanism, "with_parameters", None)
    if with_parameters is not None:
        return with_parameters(stand_in)
    double = copy.copy(mechanism)
    double.sections = {**mechanism.sections, "parameters": stand_in}
    for attribute, value in vars(mechanism).items():
        if value is section:
            setattr(double, attribute, stand_in)
    return double


def _pose_rows(R: Rot, p: Vec) -> tuple[tuple[Number, ...], ...]:
    return tuple((R.x[k], R.y[k], R.z[k], p[k]) for k in range(3))
