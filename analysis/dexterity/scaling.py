"""How motions of different kinds are made comparable: scales of motors and of the hand, and one stated length.

The house's Jacobian G takes the hand's velocity [v; omega] to motor rates, so the papers' motors-to-hand J is its
inverse. Conditions of either are the same, if turns have been made lengths by one number of millimetres per radian.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from linkwright.designs.language.errors import ParameterError
from linkwright.designs.language.mechanism import Mechanism

Array = np.ndarray

#: Columns of v in a platform's Jacobian; the columns after them, up to the sixth, are of omega.
N_MOVES = 3


class Form(StrEnum):
    """What the hand's scales S_T mean."""

    #: Forces and torques that the hand needs: A = S_J G S_T^-1 (Stocco et al., eq. 11).
    FORCE = "force"
    #: Velocities that the hand needs: A = S_J G S_T (eq. 27).
    VELOCITY = "velocity"


@dataclass(frozen=True, slots=True, kw_only=True)
class Scaling:
    """Scales of rows and columns of the Jacobian.

    Attributes:
        motors: S_J, one number per driven joint; empty for ones.
        hand: S_T, one number per hand coordinate: [N, N mm] in the force form, [mm/s, rad/s] in the velocity form, up
            to a common factor; empty for ones.
        form: what `hand` means.
    """

    motors: tuple[float, ...] = ()
    hand: tuple[float, ...] = ()
    form: Form = Form.FORCE

    def __post_init__(self) -> None:
        for name in ("motors", "hand"):
            for value in getattr(self, name):
                if not 0.0 < value < float("inf"):
                    raise ParameterError(f"scaling.{name}", value, "scales are positive, finite numbers")

    def rows(self, n: int) -> tuple[float, ...]:
        """Factors of n rows."""
        return _given("motors", self.motors, n)

    def columns(self, n: int) -> tuple[float, ...]:
        """Factors of n columns."""
        given = _given("hand", self.hand, n)
        return given if self.form is Form.VELOCITY else tuple(1.0 / s for s in given)


def _given(name: str, scales: tuple[float, ...], n: int) -> tuple[float, ...]:
    if scales and len(scales) != n:
        raise ParameterError(f"scaling.{name}", scales, f"must be {n} numbers")
    return scales or (1.0,) * n


def hand_columns(mechanism: Mechanism) -> int:
    """Columns of the Jacobian that move the hand: a coordinate after the sixth (a grip) is held."""
    return min(len(mechanism.task), 6)


def compute_hand_jacobian(mechanism: Mechanism, poses: Array) -> Array:
    """G without the columns of held coordinates, shape (n, n_active, n_hand) [motor rate per mm/s, rad/s]."""
    return mechanism.compute_jacobian(np.asarray(poses, dtype=float))[..., : hand_columns(mechanism)]


def natural_length(mechanism: Mechanism) -> float:
    """Millimetres per radian at which moves and turns weigh alike at home; 1 for a task without turns.

    It is the ratio of the root mean squares of G's columns of omega and of v there.
    """
    G = compute_hand_jacobian(mechanism, mechanism.home[None])[0]
    if G.shape[1] <= N_MOVES:
        return 1.0
    moves, turns = G[:, :N_MOVES], G[:, N_MOVES:]
    return float(np.sqrt(np.sum(turns**2) / turns.shape[1] / (np.sum(moves**2) / N_MOVES)))


def with_length(G: Array, length: float) -> Array:
    """G for [v; length * omega]: columns of omega divided by the length [mm]."""
    factors: Sequence[float] = [1.0] * N_MOVES + [1.0 / length] * (G.shape[-1] - N_MOVES)
    return G * np.array(factors[: G.shape[-1]])
