"""Chung, Choo, Lee: SenSation. Its equations, its errata, its singularities and its static balance."""

from __future__ import annotations

import math

import numpy as np
import pytest

from linkwright.designs.five_bar.kinematics import solve_state as solve_five_bar
from linkwright.designs.five_bar.loci import opposed_tip_links_locus, parallel_tip_links_locus
from linkwright.designs.five_bar.mechanism import FiveBar
from linkwright.designs.five_bar.parameters import FiveBarParameters
from linkwright.designs.language.forward import search_forward
from linkwright.designs.language.vocabulary import Requirements
from linkwright.designs.sensation.kinematics import solve_state
from linkwright.designs.sensation.loci import opposed_arms_locus, parallel_arms_locus, stretched_locus
from linkwright.designs.sensation.mechanism import Sensation
from linkwright.designs.sensation.parameters import SENSATION_SECTION_4, SensationParameters

DEG = math.pi / 180.0
P = SensationParameters()
OUT = (-1.0, 1.0)
D, L = P.pivot_distance, P.arm_length
HALF = D / 2.0


@pytest.fixture(scope="module")
def sensation():
    return Sensation({})


@pytest.fixture(scope="module")
def five_bar():
    return FiveBar({})


def u(angle):
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _arms(pose, posture=OUT, p=P):
    with np.errstate(divide="ignore", invalid="ignore"):
        state = solve_state(p, pose, posture, Requirements())
    return (*state.right, *state.left)


def _residual_of_loops(t, pose, p=P):
    right = np.array([p.pivot_distance / 2.0, 0.0]) + p.arm_length * u(t[0]) + p.tip_link_length * u(t[1])
    left = np.array([-p.pivot_distance / 2.0, 0.0]) + p.arm_length * u(t[2]) + p.tip_link_length * u(t[3])
    return max(np.abs(right - pose).max(), np.abs(left - pose).max())


# --- Mobility


def _planar_freedoms(mechanism, pose):
    """Freedoms of the placed bodies in their plane: 3 a body, less the rank of all pins' velocity constraints."""
    Ts = mechanism.place_bodies(np.asarray(pose)[None])[0]
    index = {body.name: k for k, body in enumerate(mechanism.bodies)}
    rows = np.zeros((2 * len(mechanism.joints), 3 * len(Ts)))
    for k, joint in enumerate(mechanism.joints):
        a, b = index[joint.parent], index[joint.child]
        x, y = (Ts[a, :3, :3] @ joint.p_parent + Ts[a, :3, 3])[:2] / 100.0
        for body, sign in ((a, -1.0), (b, 1.0)):
            rows[2 * k, 3 * body : 3 * body + 3] = sign * np.array([1.0, 0.0, -y])
            rows[2 * k + 1, 3 * body : 3 * body + 3] = sign * np.array([0.0, 1.0, x])
    values = np.linalg.svd(rows[:, 3:], compute_uv=False)
    return rows.shape[1] - 3 - int(np.sum(values > 1e-7 * values[0]))


def test_equations_1_and_2_nine_bodies_and_eleven_pins_leave_two_freedoms(sensation):
    assert len(sensation.bodies) == 9
    assert len(sensation.joints) == 11
    assert 3 * (9 - 11 - 1) + 11 == 2
    assert _planar_freedoms(sensation, [20.0, 210.0]) == 2


def test_a_flat_parallelogram_adds_a_freedom_so_that_stops_must_keep_it_open(sensation):
    flat = np.array(stretched_locus(P, 1.0, 110.0 * DEG))
    assert _planar_freedoms(sensation, flat) == 3
    assert not sensation.solve_inverse(flat[None]).is_reachable[0]


# --- Inverse and forward kinematics


@pytest.mark.parametrize(
    ("pose", "degrees"),
    [((0.0, 220.0), (63.570, 160.929, 116.430, 19.071)), ((100.0, 200.0), (30.934, 143.341, 86.447, 6.490))],
)
def test_the_reference_tips_give_the_reference_angles(pose, degrees):
    assert np.degrees(_arms(pose)) == pytest.approx(degrees, abs=5e-4)


@pytest.mark.parametrize(
    ("pose", "J"),
    [
        ((0.0, 220.0), [[-0.20053, -0.20053], [-0.09968, 0.09968]]),
        ((100.0, 200.0), [[-0.20150, -0.11054], [0.01251, 0.18445]]),
    ],
)
def test_the_reference_tips_give_the_reference_jacobians_in_metres(sensation, pose, J):
    rates = sensation.compute_jacobian(np.array([pose]))[0]
    assert np.linalg.inv(rates) / 1000.0 == pytest.approx(np.array(J), abs=5e-6)


def _equation_10(x, y, sign, beta_sign):
    """theta_2 of the right arm by half tangents; beta_1 = +2 P_y l_4 as printed, or -2 P_y l_4."""
    alpha, beta = -2.0 * (x - HALF) * L, beta_sign * 2.0 * y * L
    gamma = (x - HALF) ** 2 + y**2
    return 2.0 * math.atan((-beta + sign * math.sqrt(beta**2 - gamma**2 + alpha**2)) / (gamma - alpha))


def test_equation_10_holds_with_the_sign_of_beta_corrected_and_not_as_printed(rng):
    for x, y in rng.uniform([-150.0, 30.0], [150.0, 280.0], (200, 2)):
        want = {round(math.cos(_arms((x, y), (side, 1.0))[1]), 9) for side in (-1.0, 1.0)}
        assert {round(math.cos(_equation_10(x, y, sign, -1.0)), 9) for sign in (-1, 1)} == want
    # With the printed sign the arm does not close: B would be 389 mm from A instead of 180.
    B = np.array([50.0, 220.0]) - L * u(_equation_10(50.0, 220.0, -1, 1.0))
    others = np.array([50.0, 220.0]) - L * u(_equation_10(50.0, 220.0, 1, 1.0))
    lengths = [float(np.linalg.norm(point - [HALF, 0.0])) for point in (B, others)]
    assert min(abs(length - L) for length in lengths) > 100.0
    assert any(length == pytest.approx(389.0, abs=0.5) for length in lengths)


def test_half_tangents_fail_where_gamma_equals_alpha_and_the_law_of_cosines_does_not(sensation):
    """gamma = alpha means theta_2 = 180 degrees: l_1 is then reached from the tip shifted by l_4."""
    pose = np.array([HALF + L * math.cos(60.0 * DEG) - L, L * math.sin(60.0 * DEG)])
    alpha = -2.0 * (pose[0] - HALF) * L
    gamma = (pose[0] - HALF) ** 2 + pose[1] ** 2
    assert abs(gamma - alpha) < 1e-9 * gamma
    assert sensation.solve_inverse(pose[None]).joints[0, 0] == pytest.approx(math.pi, abs=1e-12)


def test_the_four_postures_close_and_are_named_by_their_elbows(sensation, rng):
    assert sensation.branches == ("out", "in", "left", "right")
    assert sensation.read_branch(None) == sensation.read_branch("out")
    for pose in rng.uniform([-100.0, 60.0], [100.0, 280.0], (50, 2)):
        seen = set()
        for branch in sensation.branches:
            t = _arms(pose, sensation.read_branch(branch))
            assert _residual_of_loops(t, pose) < 1e-12 * 1000.0
            elbows = [np.array([s * HALF, 0.0]) + L * u(a) for s, a in ((1.0, t[0]), (-1.0, t[2]))]
            pivots = [np.array([s * HALF, 0.0]) for s in (1.0, -1.0)]
            sides = tuple(
                float(np.sign(np.cross(np.append(pose - a, 0.0), np.append(b - a, 0.0))[2]))
                for a, b in zip(pivots, elbows, strict=True)
            )
            assert sides == sensation.read_branch(branch)
            seen.add(tuple(np.round(t, 6)))
        assert len(seen) == 4


def test_closed_form_forward_agrees_with_a_search_from_many_starts(sensation, five_bar, rng):
    starts = [np.array(s) for s in ((-60.0, 120.0), (60.0, 120.0), (0.0, 180.0), (0.0, 250.0), (-80.0, 240.0))]
    for mechanism, low, high in ((sensation, 100.0, 270.0), (five_bar, 215.0, 315.0)):
        poses = rng.uniform([-50.0, low], [50.0, high], (100, 2))
        active = mechanism.solve_inverse(poses).joints[:, :2]
        direct, searched = mechanism.solve_forward(active), search_forward(mechanism, active, starts, None)
        assert direct.is_solved.all()
        assert searched.is_solved.all()
        assert np.abs(direct.poses - poses).max() < 1e-10
        assert np.abs(searched.poses - poses).max() < 1e-7


def test_the_other_assembly_has_the_motor_angles_but_is_never_returned(sensation, rng):
    """Mirroring the tip on the line between the points that the motors place gives the second assembly."""
    refused = 0
    for pose in rng.uniform([-90.0, 90.0], [90.0, 270.0], (100, 2)):
        t = _arms(pose)
        first, second = np.array([HALF, 0.0]) + L * u(t[1]), np.array([-HALF, 0.0]) + L * u(t[3])
        line = (second - first) / np.linalg.norm(second - first)
        other = first + 2.0 * ((pose - first) @ line) * line - (pose - first)
        assert np.linalg.norm(other - first) == pytest.approx(L, abs=1e-9)
        assert np.linalg.norm(other - second) == pytest.approx(L, abs=1e-9)
        inverse = sensation.solve_inverse(other[None])
        refused += not inverse.is_reachable[0]
        assert sensation.solve_forward(np.array([[t[1], t[3]]])).poses[0] == pytest.approx(pose, abs=1e-9)
    assert refused == 100


# --- Jacobians and the identity


def _matrices(t, driven_tip):
    """J_p and J_theta of eq. (15), for the SenSation (tip links driven) or the five-bar."""
    if driven_tip:
        J_p = L * np.stack([u(t[0]), u(t[2])])
        return J_p, np.diag([L * L * math.sin(t[0] - t[1]), L * L * math.sin(t[2] - t[3])])
    J_p = L * np.stack([u(t[1]), u(t[3])])
    return J_p, np.diag([L * L * math.sin(t[1] - t[0]), L * L * math.sin(t[3] - t[2])])


def test_equation_15_gives_the_jacobians_of_both_devices(sensation, five_bar, rng):
    for pose in rng.uniform([-80.0, 215.0], [80.0, 290.0], (50, 2)):
        for mechanism, driven_tip in ((sensation, True), (five_bar, False)):
            J_p, J_theta = _matrices(_arms(pose), driven_tip)
            rates = mechanism.compute_jacobian(pose[None])[0]
            assert np.linalg.solve(J_theta, J_p) == pytest.approx(rates, rel=1e-12)


def test_sensation_is_the_five_bar_with_exchanged_links_in_its_other_working_mode(rng):
    """Not in the paper: the parallelograms give access to that mode without links that cross; they make no new one."""
    p = SensationParameters(arm_length=170.0, tip_link_length=190.0)
    swapped = FiveBarParameters(arm_length=190.0, tip_link_length=170.0)
    for pose in rng.uniform([-100.0, 60.0], [100.0, 280.0], (200, 2)):
        t = _arms(pose, OUT, p)
        bar = solve_five_bar(swapped, pose, (1.0, -1.0), Requirements())
        assert np.sin(bar.right.pivot - t[1]) == pytest.approx(0.0, abs=1e-12)
        assert np.sin(bar.left.pivot - t[3]) == pytest.approx(0.0, abs=1e-12)
        assert np.cos(bar.right.tip - t[0]) == pytest.approx(1.0, abs=1e-12)
        mine = Sensation({"parameters": p}).compute_jacobian(pose[None])[0]
        J_p = 170.0 * np.stack([u(bar.right.tip), u(bar.left.tip)])
        J_t = 170.0 * 190.0 * np.sin([bar.right.tip - bar.right.pivot, bar.left.tip - bar.left.pivot])
        assert J_p / J_t[:, None] == pytest.approx(mine, rel=1e-9)


def test_the_crank_length_enters_no_angle_of_the_motors(rng):
    printed, ours = Sensation({"parameters": SENSATION_SECTION_4}), Sensation({})
    poses = rng.uniform([-90.0, 90.0], [90.0, 270.0], (50, 2))
    assert np.array_equal(printed.solve_inverse(poses).joints, ours.solve_inverse(poses).joints)


# --- Singularities


def test_on_the_first_direct_locus_both_arms_close_in_one_direction():
    a = np.linspace(0.0, 2.0 * np.pi, 721)
    for sheet in (1.0, -1.0):
        tip = np.stack(parallel_arms_locus(P, sheet, a), axis=-1)
        ends = tip - L * u(a)  # B - A shifted: what the tip links must span from either pivot
        for pivot in (HALF, -HALF):
            assert np.linalg.norm(ends - [pivot, 0.0], axis=-1) == pytest.approx(P.tip_link_length, abs=1e-12 * 1e3)
    assert math.sqrt(L**2 - D**2 / 4.0) == pytest.approx(155.9, abs=0.05)


def test_on_the_second_direct_locus_both_arms_close_in_opposite_directions():
    a, need = np.linspace(0.0, 2.0 * np.pi, 721), Requirements()
    for sheet in (1.0, -1.0):
        tip = np.stack(opposed_arms_locus(P, sheet, a, need), axis=-1)
        exists = need.margins[-1] >= 0.0
        assert 100 < exists.sum() < 721
        for pivot, sign in ((HALF, 1.0), (-HALF, -1.0)):
            span = np.linalg.norm(tip - sign * L * u(a) - [pivot, 0.0], axis=-1)
            assert span[exists] == pytest.approx(P.tip_link_length, abs=1e-9)


def test_elbows_out_and_above_30_mm_only_an_arc_of_the_locus_occurs_close_to_the_boundary():
    a = np.linspace(-np.pi, np.pi, 7201)
    kept = []
    for sheet in (1.0, -1.0):
        tip = np.stack(parallel_arms_locus(P, sheet, a), axis=-1)
        for k in np.flatnonzero(tip[:, 1] > 30.0):
            t = _arms(tip[k])
            if abs(math.remainder(t[0] - a[k], 2 * math.pi)) + abs(math.remainder(t[2] - a[k], 2 * math.pi)) < 1e-6:
                kept.append((a[k], *tip[k], t[1], t[3]))
    kept = np.array(kept)
    assert np.degrees([kept[:, 0].min(), kept[:, 0].max()]) == pytest.approx([60.0, 120.0], abs=0.1)
    assert np.degrees(kept[:, 3]) == pytest.approx(np.full(len(kept), 120.0), abs=1e-5)
    assert np.degrees(kept[:, 4]) == pytest.approx(np.full(len(kept), 60.0), abs=1e-5)
    assert parallel_arms_locus(P, 1.0, 60.0 * DEG) == pytest.approx((90.0, 311.8), abs=0.05)
    assert parallel_arms_locus(P, 1.0, 90.0 * DEG) == pytest.approx((0.0, 335.9), abs=0.05)
    inside = 2.0 * L - np.hypot(np.abs(kept[:, 1]) + HALF, kept[:, 2])
    assert -1e-9 < inside.min() < 0.01
    assert inside.max() == pytest.approx(12.3, abs=0.05)
    assert math.sqrt((2 * L) ** 2 - HALF**2) == pytest.approx(348.6, abs=0.05)


def test_elbows_out_the_rest_of_the_direct_loci_lies_below_24_mm():
    """The lower circle reaches 24.1 mm, the second kind no higher than the motors' line: keep the tip above 30 mm."""
    a, need = np.linspace(-np.pi, np.pi, 7201), Requirements()
    lower = np.stack(parallel_arms_locus(P, -1.0, a), axis=-1)
    upper = [np.stack(opposed_arms_locus(P, s, a, need), axis=-1)[need.margins[-1] > 0.0] for s in (1.0, -1.0)]
    heights = []
    for tips in (lower, *upper):
        t = _arms(tips.T)
        occurs = np.abs(np.sin(t[2] - t[0])) < 1e-6
        heights.append(tips[occurs, 1].max() if occurs.any() else -np.inf)
    assert heights[0] == pytest.approx(24.1, abs=0.05)
    assert -1.0 < heights[1] < 1e-9
    assert heights[2] == -np.inf


def test_the_inverse_locus_is_the_reach_and_there_the_parallelogram_is_flat():
    a = np.linspace(60.0 * DEG, 120.0 * DEG, 61)
    tips = np.stack(stretched_locus(P, 1.0, a), axis=-1)
    for tip in tips:
        t = _arms(tip)
        assert abs(math.sin(t[1] - t[0])) < 1e-6


def test_the_five_bars_direct_locus_is_a_loop_in_the_middle():
    crossings = []
    a, need = np.linspace(-np.pi, np.pi, 7201), Requirements()
    p = FiveBarParameters()
    curves = [np.stack(parallel_tip_links_locus(p, s, a), axis=-1) for s in (1.0, -1.0)]
    for s in (1.0, -1.0):
        tip = np.stack(opposed_tip_links_locus(p, s, a, need), axis=-1)
        curves.append(tip[need.margins[-1] > 0.0])
    for tips in curves:
        for tip in tips[(np.abs(tips[:, 0]) < 1.0) & (tips[:, 1] > 30.0)]:
            t = _arms(tip)
            if abs(math.sin(t[1] - t[3])) < 1e-6:
                crossings.append(tip[1])
    assert np.min(crossings) == pytest.approx(155.9, abs=0.3)
    assert np.max(crossings) == pytest.approx(155.9, abs=0.3)


# --- Static balance


def _arm_points(mechanism, poses, masses, centres):
    """Point masses on links 1 to 4 of both arms: (n, 8, 3) [mm] and masses (8,) [kg]."""
    Ts = mechanism.place_bodies(poses)
    order = ("arm", "crank", "rod", "tip_link")
    index = [[b.name for b in mechanism.bodies].index(f"{s}_{kind}") for s in ("right", "left") for kind in order]
    local = np.array([[c, 0.0, 0.0] for c in centres] * 2)
    held = Ts[:, index]
    return np.einsum("njik,jk->nji", held[..., :3, :3], local) + held[..., :3, 3], np.array(list(masses) * 2)


@pytest.mark.parametrize("crank", [300.0, 60.0, -60.0, -99.5])
def test_equation_19_is_the_height_of_the_point_masses(crank, rng):
    mechanism = Sensation({"parameters": SensationParameters(crank_length=crank)})
    poses = rng.uniform([-100.0, 40.0], [100.0, 290.0], (200, 2))
    masses, centres = (0.0701, 0.0409, 0.0423, 0.1047), (89.98, -23.99, 90.0, 72.87)
    points, m = _arm_points(mechanism, poses, masses, centres)
    t = np.stack(_arms((poses[:, 0], poses[:, 1])))
    U1 = masses[0] * centres[0] + masses[2] * centres[2] + masses[3] * L
    U2 = masses[1] * centres[1] + masses[2] * crank + masses[3] * centres[3]
    want = U1 * (np.sin(t[0]) + np.sin(t[2])) + U2 * (np.sin(t[1]) + np.sin(t[3]))
    assert points[:, :, 1] @ m == pytest.approx(want, abs=1e-9)
    # In kg m, the moments that the counterweights on links 1 and 2 must take out.
    if crank == -60.0:
        assert pytest.approx((0.0290, 0.0041), abs=5e-5) == (U1 / 1000.0, U2 / 1000.0)


def test_equation_20_balances_for_every_direction_of_gravity(rng):
    """Counterweights on links 1 and 2 only: the common centre of mass then stands still."""
    mechanism = Sensation({})
    poses = rng.uniform([-100.0, 40.0], [100.0, 290.0], (200, 2))
    masses, centres = np.array([0.0701, 0.0409, 0.0423, 0.1047]), np.array([89.98, -23.99, 90.0, 72.87])
    U1 = masses[0] * centres[0] + masses[2] * centres[2] + masses[3] * L
    U2 = masses[1] * centres[1] + masses[2] * P.crank_length + masses[3] * centres[3]
    weights = np.array([0.641, 0.143])
    balanced, shifted = masses.copy(), centres.copy()
    for k, (moment, weight) in enumerate(zip((U1, U2), weights, strict=True)):
        balanced[k] += weight
        shifted[k] = (masses[k] * centres[k] - moment) / balanced[k]
    assert balanced[0] * shifted[0] + masses[2] * centres[2] + masses[3] * L == pytest.approx(0.0, abs=1e-12)
    assert balanced[1] * shifted[1] + masses[2] * P.crank_length + masses[3] * centres[3] == pytest.approx(
        0.0, abs=1e-12
    )
    spans = []
    for m, c in ((masses, centres), (balanced, shifted)):
        points, all_m = _arm_points(mechanism, poses, m, c)
        moment = np.einsum("nji,j->ni", points, all_m)
        spans.append(np.ptp(moment, axis=0).max())
    assert spans[0] > 5.0  # kg mm
    assert spans[1] < 1e-10


def test_the_handle_must_be_counted_half_on_each_tip_link(rng):
    """The paper leaves it out; with half its mass at l_4 on links 4 and 8, eq. (20) balances the handle at P too."""
    mechanism, handle = Sensation({}), 0.030
    poses = rng.uniform([-100.0, 40.0], [100.0, 290.0], (200, 2))
    masses, centres = np.array([0.0701, 0.0409, 0.0423, 0.0897]), np.array([89.98, -23.99, 90.0, 54.94])
    spans = {}
    for counted in (0.0, handle / 2.0):
        U1 = masses[2] * centres[2] + (masses[3] + counted) * L
        U2 = masses[2] * P.crank_length + masses[3] * centres[3] + counted * P.tip_link_length
        shifted = centres.copy()
        shifted[0], shifted[1] = -U1 / masses[0], -U2 / masses[1]
        points, m = _arm_points(mechanism, poses, masses, shifted)
        moment = np.einsum("nji,j->ni", points, m)[:, :2] + handle * poses
        spans[counted] = np.ptp(moment, axis=0).max()
    assert spans[0.0] > 5.0  # kg mm
    assert spans[handle / 2.0] < 1e-10
