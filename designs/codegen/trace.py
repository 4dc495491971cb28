"""Runs a mechanism's formulas on symbols once, and keeps what they did as a `Program`."""

from __future__ import annotations

import copy
import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ..language.errors import LinkwrightError, UnknownNameError
from ..language.formulas import LIMIT_SLACK, FormulaMechanism
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .graph import Graph, Node
from .program import Margin, Output, Program

#: What of a mechanism can be traced: all joints, the driven ones, rate rows, body poses as rows of [R | p].
OUTPUTS = ("joints", "active", "jacobian", "frames")

#: Share by which a parameter is changed to see whether a program follows it, and how well that must agree.
_NUDGE, _AGREE = 1e-4, 1e-9

Formula = Callable[[Sequence[Number], Sequence[Number], Require], Mapping[str, Any]]


class FixedParametersError(LinkwrightError):
    """A mechanism whose formulas read numbers that were made from its parameters when it was built.

    Attributes:
        mechanism: its name.
        parameters: those that the formulas do not follow; empty where they read none at all.
    """

    def __init__(self, mechanism: str, parameters: Sequence[str] = ()) -> None:
        self.mechanism, self.parameters = mechanism, tuple(parameters)
        what = f"{', '.join(parameters)} only through numbers" if parameters else "no parameters, only numbers"
        super().__init__(
            f"{mechanism}: its formulas read {what} made when it was built; trace it with numbers, keep to outputs "
            "that read the parameters themselves, or give it a method with_parameters(section)"
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
        FixedParametersError: symbols were asked for, and some number that the outputs need does not follow them.
    """
    for name in outputs:
        if name not in OUTPUTS:
            raise UnknownNameError("traced output", name, OUTPUTS)
    names = _symbol_names(mechanism) if has_symbols else ()

    def formula(pose: Sequence[Number], symbols: Sequence[Number], require: Require) -> dict[str, Any]:
        traced = _with_symbols(mechanism, dict(zip(names, symbols, strict=True))) if has_symbols else mechanism
        return _results(traced, outputs, branch, pose, require, has_limits=has_limits)

    program = trace_formula(mechanism.name, [c.name for c in mechanism.task], names, formula)
    if has_symbols:
        if not any(node.op == "parameter" for node in program.order()):
            raise FixedParametersError(mechanism.name)
        fixed = [name for name in names if not _follows(program, mechanism, name, branch)]
        if fixed:
            raise FixedParametersError(mechanism.name, fixed)
    return program


def _results(
    mechanism: Any,
    outputs: Sequence[str],
    branch: str | None,
    pose: Sequence[Number],
    require: Require,
    *,
    has_limits: bool,
) -> dict[str, Any]:
    """What a program of the mechanism computes, in any kind of number."""
    state = mechanism.solve_state(tuple(pose), mechanism.read_branch(branch), require)
    joints = tuple(mechanism.joint_values(state)) if {"joints", "active"} & set(outputs) or has_limits else ()
    if has_limits:
        for joint, value in zip(mechanism.joints, joints, strict=True):
            require(value - joint.lower + LIMIT_SLACK, f"{joint.name} below its limit")
        for joint, value in zip(mechanism.joints, joints, strict=True):
            require(joint.upper - value + LIMIT_SLACK, f"{joint.name} above its limit")
    read: dict[str, Callable[[], Any]] = {
        "joints": lambda: joints,
        "active": lambda: joints[: mechanism.n_active],
        "jacobian": lambda: mechanism.rate_rows(state),
        "frames": lambda: [_pose_rows(R, p) for R, p in mechanism.body_frames(state)],
    }
    return {key: read[key]() for key in outputs}


def _follows(program: Program, mechanism: FormulaMechanism, parameter: str, branch: str | None) -> bool:
    """The program with another value of a parameter equals the mechanism built with it, at home; True if none can be.

    A whole turn more or less is the same angle.
    """
    section = mechanism.sections["parameters"]
    for factor in (1.0 + _NUDGE, 1.0 - _NUDGE):
        changed = {parameter: getattr(section, parameter) * factor}
        try:
            other: Any = type(mechanism)({**mechanism.sections, "parameters": dataclasses.replace(section, **changed)})  # type: ignore[call-arg]
        except LinkwrightError:
            continue
        with np.errstate(all="ignore"):
            got = program.evaluate([float(v) for v in mechanism.home], parameter_values(other)).outputs
            names = [output.name for output in program.outputs]
            want = _results(other, names, branch, [float(v) for v in mechanism.home], Requirements(), has_limits=False)
        for name in names:
            a, b = np.array(got[name], dtype=float), np.array(_flattened(want[name])[1], dtype=float)
            apart = np.abs(a - b)
            if np.any(np.minimum(apart, np.abs(apart - 2.0 * np.pi)) > _AGREE * (1.0 + np.abs(b))):
                return False
        return True
    return True


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
