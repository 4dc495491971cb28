"""Dexterity over a sampled workspace: ends and middle of every measure, and where; margins; the dextrous positions."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.codegen.trace import trace_mechanism
from linkwright.designs.language.errors import UnknownNameError, VacuousCheckError
from linkwright.designs.language.formulas import FormulaMechanism
from linkwright.designs.language.mechanism import Mechanism

from ..pose_sets import PoseSet
from .measures import MEASURES, Measures, measure_poses

Array = np.ndarray
Progress = Callable[[int, int, str], None]

_BLOCK = 4096


@dataclass(frozen=True, slots=True, kw_only=True)
class Spread:
    """A measure over the reachable poses.

    Attributes:
        name: one of `MEASURES`.
        least, median, greatest: its values.
        pose_of_least, pose_of_greatest: where, shape (n_task,) [mm, rad].
    """

    name: str
    least: float
    median: float
    greatest: float
    pose_of_least: Array
    pose_of_greatest: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class LeastMargin:
    """The requirement of a formula (or a joint limit) over all poses: how near it comes, in its own unit, and where."""

    requirement: str
    margin: float
    pose: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Survey:
    """What a set of poses shows.

    Attributes:
        poses: all of them, shape (n, n_task) [mm, rad].
        is_reachable: shape (n,).
        values: columns in the order of `MEASURES`, shape (n, n_measures); zeros where not reachable.
        spreads: one per measure.
        margins: of all requirements, joint limits among them, over all poses.
        n_other_assembly: reachable poses whose determinant has another sign than at home: a parallel singularity lies
            between.
    """

    poses: Array
    is_reachable: Array
    values: Array
    spreads: tuple[Spread, ...]
    margins: tuple[LeastMargin, ...]
    n_other_assembly: int

    def spread(self, name: str) -> Spread:
        """The spread of this measure."""
        return next(s for s in self.spreads if s.name == name)


def survey_poses(mechanism: Mechanism, poses: Array, length: float, progress: Progress | None = None) -> Survey:
    """Measures at all reachable poses of a batch (n, n_task), turns made lengths by `length` [mm].

    Raises:
        VacuousCheckError: no pose is reachable.
    """
    poses = np.asarray(poses, dtype=float)
    values, reachable, least = np.zeros((len(poses), len(MEASURES))), np.zeros(len(poses), dtype=bool), _Least()
    for first in range(0, len(poses), _BLOCK):
        block = poses[first : first + _BLOCK]
        inverse = mechanism.solve_inverse(block)
        ok = np.asarray(inverse.is_reachable)
        least.take(inverse.requirements, inverse.margins, block)
        reachable[first : first + _BLOCK] = ok
        if ok.any():
            values[first : first + _BLOCK][ok] = _columns(measure_poses(mechanism, block[ok], length))
        if progress is not None:
            progress(first + len(block), len(poses), "dexterity")
    if not reachable.any():
        raise VacuousCheckError(f"{mechanism.name}: none of {len(poses)} poses can be reached, so nothing is measured")
    determinant = MEASURES.index("determinant")
    at_home = _columns(measure_poses(mechanism, mechanism.home[None], length))[0, determinant]
    return Survey(
        poses=poses,
        is_reachable=reachable,
        values=values,
        spreads=tuple(_spread(name, values[reachable, k], poses[reachable]) for k, name in enumerate(MEASURES)),
        margins=least.found(),
        n_other_assembly=int(np.sum(values[reachable, determinant] * np.sign(at_home) < 0.0)),
    )


def _columns(measures: Measures) -> Array:
    return np.stack([getattr(measures, name) for name in MEASURES], axis=-1)


def _spread(name: str, values: Array, poses: Array) -> Spread:
    low, high = int(np.argmin(values)), int(np.argmax(values))
    return Spread(
        name=name,
        least=float(values[low]),
        median=float(np.median(values)),
        greatest=float(values[high]),
        pose_of_least=poses[low],
        pose_of_greatest=poses[high],
    )


class _Least:
    """The least margin of every requirement over several batches."""

    def __init__(self) -> None:
        self._kept: dict[str, tuple[float, Array]] = {}

    def take(self, names: tuple[str, ...], margins: Array, poses: Array) -> None:
        """Take up the margins (n, n_requirements) of a batch."""
        for name, at, value in zip(names, np.argmin(margins, axis=0), np.min(margins, axis=0), strict=True):
            if name not in self._kept or value < self._kept[name][0]:
                self._kept[name] = (float(value), poses[at])

    def found(self) -> tuple[LeastMargin, ...]:
        """All of them, nearest first."""
        rows = sorted(self._kept.items(), key=lambda row: row[1][0])
        return tuple(LeastMargin(requirement=n, margin=margin, pose=pose) for n, (margin, pose) in rows)


def find_dextrous(
    mechanism: FormulaMechanism, poses: PoseSet, *, without: Sequence[str] = (), progress: Progress | None = None
) -> Array:
    """Which positions can be reached with every one of the turns, by the formulas alone, shape (n_positions,).

    Joint limits are not asked: this is the workspace that the lengths of the links allow.

    Args:
        mechanism: whose formulas are asked, by compiled kernel.
        poses: positions, and the turns that each must allow.
        without: requirements that are not asked ("other assembly": reach alone then counts, in any assembly).
        progress: told how many positions are done.

    Raises:
        UnknownNameError: `without` names no requirement of the mechanism.

    Source: Stocco, Salcudean, Sassani, section VI.A (the semi-dextrous workspace).
    """
    program = trace_mechanism(mechanism, ("active",))
    names = tuple(m.name for m in program.margins)
    for name in without:
        if name not in names:
            raise UnknownNameError("requirement", name, names)
    kernel, asked = Kernel(program), np.array([name not in without for name in names])
    dextrous = np.zeros(len(poses.positions), dtype=bool)
    for first, last in poses.blocks(4 * _BLOCK):
        legal = np.all(kernel(poses.poses(first, last)).margins[:, asked] >= 0.0, axis=1)
        dextrous[first:last] = legal.reshape(last - first, -1).all(axis=1)
        if progress is not None:
            progress(last, len(dextrous), "dextrous workspace")
    return dextrous
