"""PATHOS-II as a mechanism: solves both ways, differentiates, places its bodies."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..chains.sections import check_order, resolve_sections
from ..language.bodies import Body
from ..language.errors import ParameterError, UnknownNameError
from ..language.formulas import FormulaMechanism
from ..language.forward import Candidates
from ..language.mechanism import Array, Coordinate, ForwardSolution
from ..language.poses import pose_from_parts, pose_from_task, rotation_from_vector, task_from_pose
from ..language.units import DEG
from ..language.vectors import Rot, Vec
from ..language.vocabulary import Number, Require, Requirements
from .closure import CLOSED, Tori, locate_globe, platform_from_globes
from .joints import build_joints
from .kinematics import (
    BRANCHES,
    N_LEGS,
    SIDES,
    TURNS,
    PathosState,
    body_frames,
    joint_values,
    parallel_measure,
    rate_rows,
    solve_state,
)
from .parameters import PathosLimits, PathosParameters

#: The grip is h_0, half the distance of the top plates; the grip's joint measures all of it.
TASK = (
    *(Coordinate(name=n, unit="mm") for n in "xyz"),
    *(Coordinate(name=n, unit="deg") for n in ("rx", "ry", "rz")),
    Coordinate(name="grip", unit="mm"),
)

#: Section of the design file -> its dataclass, in the order in which they are written.
SECTIONS: dict[str, type] = {"parameters": PathosParameters, "joint_limits": PathosLimits}

#: Legs (0 to 5) whose three first joints carry sensors: P_3, P_2, P_1 of Fig. 5.
SENSOR_LEGS = (0, 4, 5)

#: Platform turns (lean [rad], its direction [rad], turn about Z [rad]) from which the forward kinematics starts.
#: Far from the parallel singularity at 60 degrees Newton's method stays in the working assembly: of 20000 poses all
#: were found from the first; the others look for a second answer.
_STARTS = (
    (0.0, 0.0, -60.0 * DEG),
    (0.0, 0.0, -90.0 * DEG),
    (0.0, 0.0, -20.0 * DEG),
    (0.0, 0.0, 30.0 * DEG),
    *((0.25, 120.0 * DEG * k, -40.0 * DEG) for k in range(3)),
    *((0.5, 60.0 * DEG + 120.0 * DEG * k, -75.0 * DEG) for k in range(3)),
)


class Pathos2(FormulaMechanism):
    """Six RRR legs with globular joints, grip as the seventh freedom."""

    name = "pathos2"
    title = "PATHOS-II: six RRR legs with globular joints, grip between two top plates, 7 DOF"
    source = "Kim, Chung: Design and Analysis of a New 7-DOF Parallel Type Haptic Device: PATHOS-II"
    task = TASK
    branches = tuple(BRANCHES)
    assembly_mode = "elbows counter-clockwise, det A > 0"

    def __init__(self, sections: Mapping[str, Any]) -> None:
        self.sections = resolve_sections(SECTIONS, sections)
        self.parameters: PathosParameters = self.sections["parameters"]
        self.limits: PathosLimits = self.sections["joint_limits"]
        self._check_limits()
        p = self.parameters
        self.joints = build_joints(p, self.limits)
        self.bodies = _build_bodies()
        self.home = np.array([0.0, 0.0, p.base_distance / 2.0, 0.0, 0.0, p.home_turn, p.home_grip])

    def _check_limits(self) -> None:
        check_order(self.limits, [f"theta_{k}" for k in range(1, 7)])
        low, high = self.limits.gap_min, self.limits.gap_max
        if low >= high:
            raise ParameterError("joint_limits.gap_max_mm", high, f"must be above gap_min_mm = {low:g}")

    def read_branch(self, branch: str | None) -> tuple[float, ...]:
        """The side of every leg's elbow; six names joined by / name one branch per leg."""
        names = (branch or self.branches[0]).split("/")
        names = names * N_LEGS if len(names) == 1 else names
        for name in names:
            if name not in BRANCHES:
                raise UnknownNameError("branch", name, self.branches)
        if len(names) != N_LEGS:
            raise UnknownNameError("branch", branch or "", (*self.branches, "six of these joined by /"))
        return tuple(BRANCHES[name] for name in names)

    def solve_state(self, pose: Sequence[Number], branch: tuple[float, ...], require: Require) -> PathosState:
        """All legs at a pose; in the working branch the pose must keep off the parallel singularity."""
        state = solve_state(self.parameters, pose, branch, require)
        if branch == self.read_branch(None):
            measure = parallel_measure(self.parameters, state)
            require(measure - self.limits.least_determinant, "parallel singularity")
        return state

    def joint_values(self, state: PathosState) -> Sequence[Number]:
        """Six motor angles and the plates' distance, then the passive joints leg by leg."""
        return joint_values(state)

    def rate_rows(self, state: PathosState) -> Sequence[Sequence[Number]]:
        """d(motor angles, plates' distance)/d(twist, h_0): columns v [mm/s], omega [rad/s], dh_0/dt [mm/s]."""
        return rate_rows(state)

    def body_frames(self, state: PathosState) -> Sequence[tuple[Rot, Vec]]:
        """Base, five bodies a leg, lower and upper plate."""
        return body_frames(state)

    def move_pose(self, poses: Array, velocity: Array) -> Array:
        """Poses (n, 7) after a unit of time at [v; omega; dh_0/dt]."""
        Ts = pose_from_task(poses)
        Ts[..., :3, :3] = rotation_from_vector(velocity[..., 3:6]) @ Ts[..., :3, :3]
        Ts[..., :3, 3] += velocity[..., :3]
        return np.concatenate([task_from_pose(Ts), poses[..., 6:] + velocity[..., 6:]], axis=-1)

    def compute_locked_jacobian(self, poses: Array) -> Array:
        """Twist to motor rates with the grip held, shape (n, 6, 6), rows d(theta_1)/d(v, omega)."""
        return self.compute_jacobian(poses)[..., :N_LEGS, :N_LEGS]

    def compute_motor_jacobian(self, poses: Array) -> Array:
        """Motor rates to twist with the grip held, shape (n, 6, 6): rows 0-2 are J_p [mm/rad], rows 3-5 J_o.

        Only at reachable poses: at a parallel singularity it has no value.

        Source: Kim, Chung, eq. (22).
        """
        return np.linalg.inv(self.compute_locked_jacobian(poses))

    def solve_forward(self, active: Array, near: Array | None = None) -> ForwardSolution:
        """Poses of the working assembly mode for motor angles [rad] and plates' distance [mm], shape (n, 7).

        Newton on the six distances of the globular joints from the tori on which the motors keep them. A pose counts
        if it closes and if its inverse is legal and returns the motor angles; when more than one does, the answer is
        refused unless `near` decides.

        Source: none; the paper solves forward from nine sensors only (`solve_forward_from_sensors`).
        """
        active = np.atleast_2d(np.asarray(active, dtype=float))
        n, p = len(active), self.parameters
        finite = np.all(np.isfinite(active), axis=-1)
        goal = np.where(finite[:, None], active, 0.0)
        h_0 = goal[:, N_LEGS] / 2.0
        candidates = Candidates(n, self.home, near)
        tori = Tori(p, goal[:, :N_LEGS], h_0)
        guesses = [np.broadcast_to(self._start(*start), (n, 7)) for start in _STARTS]
        if candidates.near is not None:
            guesses.insert(0, candidates.near)
        for guess in guesses:
            Ts = pose_from_task(guess)
            R, origin, error = tori.close(Ts[:, :3, :3], Ts[:, :3, 3])
            Ts[:, :3, :3], Ts[:, :3, 3] = R, origin
            poses = np.concatenate([task_from_pose(Ts), h_0[:, None]], axis=-1)
            inverse = self.solve_inverse(poses)
            back = np.max(np.abs(inverse.joints[:, : N_LEGS + 1] - goal), axis=-1)
            candidates.offer(poses, finite & (error < CLOSED) & inverse.is_reachable & (back < 1e-6), error)
        return candidates.solution()

    def _start(self, lean: float, direction: float, turn: float) -> Array:
        pose = self.home.copy()
        pose[3:6] = lean * math.cos(direction), lean * math.sin(direction), turn
        return pose

    def solve_forward_from_sensors(self, sensors: Array, tolerance: float = 1.0) -> ForwardSolution:
        """Poses from theta_1, theta_2, theta_3 of legs 1, 5 and 6, shape (n, 9) [rad], in closed form.

        Nine measurements for seven coordinates leave two checks: P_1 and P_2 are sqrt(3) l_p apart, and equally far
        from P_3. The larger miss [mm] is the residual; an answer that misses by more than `tolerance` is refused.

        Source: Kim, Chung, section 2.3, corrected as `closure.platform_from_globes` says.
        """
        q = np.atleast_2d(np.asarray(sensors, dtype=float))
        p, need = self.parameters, Requirements()
        P_3, P_2, P_1 = (
            locate_globe(p, leg, (q[:, 3 * k], q[:, 3 * k + 1], q[:, 3 * k + 2])) for k, leg in enumerate(SENSOR_LEGS)
        )
        with np.errstate(all="ignore"):
            R, origin, h_0 = platform_from_globes(p, P_3, P_2, P_1, need)
            poses = np.concatenate([task_from_pose(pose_from_parts(R, origin)), h_0[:, None]], axis=-1)
            side = np.abs((P_1 - P_2).norm() - math.sqrt(3.0) * p.plate_radius)
            miss = np.maximum(side, np.abs((P_1 - P_3).norm() - (P_2 - P_3).norm()))
            good = np.all(np.isfinite(poses), axis=-1) & (need.stacked((len(q),))[:, 0] > 0.0) & (miss <= tolerance)
        return ForwardSolution(
            poses=np.where(good[:, None], poses, self.home),
            is_solved=good,
            n_candidates=good.astype(int),
            residual=np.where(np.isfinite(miss), miss, np.inf),
        )

    def derived_numbers(self) -> Mapping[str, tuple[float, str, str]]:
        """Numbers that follow from the parameters."""
        p = self.parameters
        home = self.solve_inverse(self.home[None]).joints[0]
        values = {joint.name: float(home[k]) for k, joint in enumerate(self.joints)}
        J = self.compute_motor_jacobian(self.home[None])[0]
        return {
            "shift_along": (float(p.shift_along), "mm", "l_x: along the tilted plane to a motor"),
            "shift_up": (
                float(p.shift_up),
                "mm",
                "l_t: along the base plate's normal to the start of the tilted plane",
            ),
            **{
                f"home_theta_{k}": (values[f"leg_1_theta_{k}"], "deg", f"theta_{k} of the lower legs at home")
                for k in (1, 2, 3)
            },
            "home_condition_p": (float(np.linalg.cond(J[:3])), "", "condition number of J_p at home, grip held"),
            "home_condition_o": (float(np.linalg.cond(J[3:])), "", "condition number of J_o at home, grip held"),
        }

    def controller_parameters(self) -> Mapping[str, tuple[float, str]]:
        """The dimensions from which a controller computes the kinematics."""
        p = self.parameters
        return {
            "base_distance": (p.base_distance, "mm"),
            "base_radius": (p.base_radius, "mm"),
            "motor_tilt": (p.motor_tilt, "deg"),
            "lower_link_length": (p.lower_link_length, "mm"),
            "middle_link_length": (p.middle_link_length, "mm"),
            "upper_link_length": (p.upper_link_length, "mm"),
            "plate_radius": (p.plate_radius, "mm"),
            "globular_tilt": (p.globular_tilt, "deg"),
            **{f"leg_{i + 1}_turn": (turn, "deg") for i, turn in enumerate(TURNS)},
            **{f"leg_{i + 1}_side": (side, "") for i, side in enumerate(SIDES)},
        }


def _build_bodies() -> tuple[Body, ...]:
    """Base (both base plates), five bodies a leg, two top plates, in the order of `kinematics.body_frames`."""
    links = ("lower_link", "middle_link", "upper_link", "ring", "fork")
    legs = [f"leg_{i + 1}" for i in range(N_LEGS)]
    return (
        Body(name="base", kind="base", group="", parts=()),
        *(Body(name=f"{leg}_{kind}", kind=kind, group=leg, parts=()) for leg in legs for kind in links),
        *(Body(name=kind, kind=kind, group="", parts=()) for kind in ("lower_plate", "upper_plate")),
    )
