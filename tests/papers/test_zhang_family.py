"""UCI, KAIST and KJIST, the three devices that Zhang, Kong, Sun, Du compare theirs with; no dimensions are published.

So the numbers here are consequences of the descriptions with the HIT study's legs, and where the paper's equations,
written for one device, hold for another.
"""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from linkwright.designs.chains.tripod import DELTAS
from linkwright.designs.hit.mechanism import Hit
from linkwright.designs.hit.parameters import HIT_REFERENCE, HitParameters
from linkwright.designs.kaist.mechanism import Kaist
from linkwright.designs.kaist.parameters import KAIST_LITERAL, KaistParameters
from linkwright.designs.kjist.mechanism import Kjist
from linkwright.designs.kjist.parameters import KJIST_LITERAL, KjistParameters
from linkwright.designs.language.forward import search_forward
from linkwright.designs.language.poses import pose_from_task, rotation_about
from linkwright.designs.uci.mechanism import Uci
from linkwright.designs.uci.parameters import UCI_LITERAL, UciLimits, UciParameters

DEG = math.pi / 180.0
X, Y, Z = np.eye(3)
LEVEL = np.array([0.0, 0.0, 250.0, 0.0, 0.0, 0.0])
POSE = np.array([30.0, -20.0, 260.0, 10.0 * DEG, -15.0 * DEG, 20.0 * DEG])


@pytest.fixture(scope="module")
def uci():
    return Uci({})


@pytest.fixture(scope="module")
def kaist():
    return Kaist({})


@pytest.fixture(scope="module")
def kjist():
    return Kjist({})


def _values(mechanism, pose, branch=None):
    inverse = mechanism.solve_inverse(pose[None], branch)
    return {j.name: v for j, v in zip(mechanism.joints, inverse.joints[0], strict=True)}


def _poses(mechanism, rng, n, centre=250.0, spread=60.0, turn=20.0):
    lower = np.array([-spread, -spread, centre - spread, -turn * DEG, -turn * DEG, -turn * DEG])
    upper = np.array([spread, spread, centre + spread, turn * DEG, turn * DEG, turn * DEG])
    poses = rng.uniform(lower, upper, (20 * n, 6))
    return poses[mechanism.solve_inverse(poses).is_reachable][:n]


def _ball(pose, delta, radius):
    T = pose_from_task(pose)
    return T[:3, :3] @ rotation_about(Z, delta) @ (radius * X) + T[:3, 3]


# --- UCI: the parallelogram form


def test_uci_has_the_angles_of_the_hit_device_where_all_links_are_equal(uci):
    hit, mine, tilted = Hit({"parameters": HIT_REFERENCE}), _values(uci, LEVEL), _values(uci, POSE)
    assert math.degrees(mine["leg_1_theta_1"]) == pytest.approx(135.572996, abs=5e-7)
    assert math.degrees(mine["leg_1_theta_2"]) == pytest.approx(44.427004, abs=5e-7)
    for leg, alpha, t1, t2 in (
        (1, 3.935219, 119.912982, 52.582441),
        (2, -8.680571, 124.935201, 42.742895),
        (3, -2.481656, 115.027676, 21.135649),
    ):
        names = (f"leg_{leg}_pin", f"leg_{leg}_theta_1", f"leg_{leg}_theta_2")
        assert [math.degrees(tilted[n]) for n in names] == pytest.approx([alpha, t1, t2], abs=5e-7)
    assert uci.compute_jacobian(POSE[None])[0] == pytest.approx(hit.compute_jacobian(POSE[None])[0], abs=1e-15)


def test_equations_4_and_16_hold_on_unequal_links_for_uci_and_not_for_a_kite_or_a_five_bar(rng):
    """theta_2's rate is omega_1 + omega_2 only where the link E-F stays parallel to D-H."""
    uci = Uci({"parameters": UciParameters(lower_link_length=140.0, upper_link_length=160.0)})
    kite = Hit(
        {
            "parameters": HitParameters(
                base_radius=110.0,
                platform_radius=110.0,
                pivot_height=10.0,
                lower_link_length=140.0,
                upper_link_length=160.0,
            )
        }
    )
    kaist = Kaist({"parameters": KAIST_LITERAL})
    errors = {}
    for mechanism in (uci, kite, kaist):
        worst = []
        for pose in _poses(mechanism, rng, 60):
            J, Ts = mechanism.compute_jacobian(pose[None])[0], mechanism.place_bodies(pose[None])[0]
            printed = _influence_rows(mechanism, pose, Ts)
            worst.append(np.max(np.abs(printed - J)[:, :3]) / np.max(np.abs(J[:, :3])))
        errors[mechanism.name] = np.array(worst)
    assert errors["uci"].max() < 1e-12
    assert errors["hit"].max() > 0.2
    assert errors["kaist"].max() > 0.2


def _influence_rows(mechanism, pose, Ts):
    """Eq. (16), corrected to rows of the inverse, from the serial chain C-D-E-F of every leg."""
    index, rows = {b.name: k for k, b in enumerate(mechanism.bodies)}, []
    for i, delta in enumerate(DELTAS):
        frame, lower = Ts[index[f"leg_{i + 1}_frame"]], Ts[index[f"leg_{i + 1}_lower_left"]]
        F = _ball(pose, delta, mechanism.parameters.platform_radius)
        E = Ts[index[f"leg_{i + 1}_upper_left"]][:3, 3]
        D = lower[:3, 3]
        if mechanism.name == "hit":  # its elbow is half a frame's width beside the kite's
            half = mechanism.parameters.frame_width / 2.0 * frame[:3, 1]
            lift = (mechanism.parameters.chain_height - mechanism.parameters.pivot_height) * frame[:3, 2]
            E, D = E + half + lift, D + half + lift
        screws = [(frame[:3, 1], frame[:3, 3]), (frame[:3, 0], D), (frame[:3, 0], E), (X, F), (Y, F), (Z, F)]
        G = np.linalg.inv(np.stack([np.concatenate([np.cross(s, pose[:3] - o), s]) for s, o in screws], axis=1))
        rows += [G[1], G[1] + G[2]]
    return np.array(rows)


def test_the_setback_and_the_ball_bar_enter_no_motor_angle(uci, rng):
    """F = D + L_2 u(theta_1) + L_3 u(theta_2), wherever along E-F the parallelogram closes."""
    literal, poses = Uci({"parameters": UCI_LITERAL}), _poses(uci, rng, 50)
    assert np.array_equal(uci.solve_inverse(poses).joints[:, :6], literal.solve_inverse(poses).joints[:, :6])
    assert np.array_equal(uci.compute_jacobian(poses), literal.compute_jacobian(poses))


def test_a_straight_ball_bar_needs_a_tilted_socket_and_the_dog_leg_an_upright_one(uci):
    assert _values(uci, LEVEL)["leg_1_ball"] == pytest.approx(0.0, abs=1e-6)
    straight = Uci({"parameters": UciParameters(ball_bar_angle=0.0)})
    assert math.degrees(_values(straight, LEVEL)["leg_2_ball"]) == pytest.approx(45.573, abs=5e-4)
    assert _values(Uci({"parameters": UCI_LITERAL}), LEVEL)["leg_3_ball"] == pytest.approx(0.0, abs=1e-6)


# --- KAIST: the five-bar, its ball beside the leg's plane


def test_kaist_without_motor_distance_and_offset_is_the_rhombus():
    flat = dataclasses.replace(KAIST_LITERAL, motor_distance=0.0)
    values, hit = _values(Kaist({"parameters": flat}), POSE), _values(Hit({"parameters": HIT_REFERENCE}), POSE)
    for leg in (1, 2, 3):
        for name in ("pin", "theta_1", "theta_2"):
            assert values[f"leg_{leg}_{name}"] == pytest.approx(hit[f"leg_{leg}_{name}"], abs=1e-12)


def test_kaist_keeps_all_rod_lengths_in_all_eight_branches_of_a_leg(kaist):
    p, low = kaist.parameters, POSE - np.array([0.0, 0.0, 60.0, 0.0, 0.0, 0.0])
    assert len(kaist.branches) == 8
    assert kaist.branches[0] == "up-out"
    seen = set()
    for branch in kaist.branches:
        values = _values(kaist, low, branch)
        for i, delta in enumerate(DELTAS):
            alpha, t1, t2 = (values[f"leg_{i + 1}_{n}"] for n in ("pin", "theta_1", "theta_2"))
            turn = rotation_about(Z, delta)
            axes = turn @ rotation_about(Y, alpha)
            foot = turn @ (p.base_radius * X)
            top = _ball(low, delta, p.platform_radius) + p.ball_inset * axes[:, 0]
            for theta, y in ((t1, -p.motor_distance / 2.0), (t2, p.motor_distance / 2.0)):
                lever = p.lower_link_length * (math.cos(theta) * axes[:, 1] + math.sin(theta) * axes[:, 2])
                elbow = foot + y * axes[:, 1] + p.chain_height * axes[:, 2] + lever
                assert np.linalg.norm(top - elbow) == pytest.approx(p.upper_link_length, abs=1e-9)
            assert abs((top - foot) @ axes[:, 0]) < 1e-9
        seen.add(tuple(np.round([values[f"leg_1_{n}"] for n in ("pin", "theta_1", "theta_2")], 6)))
    assert len(seen) == 8


def test_the_offset_ball_stands_the_legs_upright_when_the_base_is_wider_by_it(kaist):
    values = _values(kaist, LEVEL)
    assert [values[f"leg_{leg}_pin"] for leg in (1, 2, 3)] == pytest.approx([0.0] * 3, abs=1e-12)
    assert [values[f"leg_{leg}_ball"] for leg in (1, 2, 3)] == pytest.approx([0.0] * 3, abs=1e-12)
    narrow = Kaist({"parameters": KaistParameters(base_radius=110.0)})
    assert abs(_values(narrow, LEVEL)["leg_1_pin"]) > 5.0 * DEG


def test_a_turn_about_z_uses_kaists_cone_and_not_that_of_hit(kaist):
    turned = LEVEL + np.array([0.0, 0.0, 0.0, 0.0, 0.0, 30.0 * DEG])
    hit = Hit({"parameters": HIT_REFERENCE})
    lean = _values(hit, turned)["leg_1_pin"]
    assert _values(hit, turned)["leg_1_ball"] == pytest.approx(abs(lean), abs=1e-9)
    assert _values(kaist, turned)["leg_1_ball"] >= 30.0 * DEG - 1e-9


# --- KJIST: the dual problem


def test_kjist_joint_centres_stay_in_fixed_planes_and_at_the_bars_length(kjist, rng):
    p = kjist.parameters
    for pose in _poses(kjist, rng, 30, centre=330.0, spread=40.0):
        Ts = kjist.place_bodies(pose[None])[0]
        index = {b.name: k for k, b in enumerate(kjist.bodies)}
        for i, delta in enumerate(DELTAS):
            S = Ts[index[f"leg_{i + 1}_bar"]][:3, 3]
            assert S @ (rotation_about(Z, delta) @ X) == pytest.approx(p.base_radius, abs=1e-10)
            reach = np.linalg.norm(_ball(pose, delta, p.platform_radius) - S)
            assert reach == pytest.approx(p.bar_length, abs=1e-10)


def test_the_inset_of_the_joint_changes_no_equation_but_moves_the_pantographs_outwards(kjist, rng):
    literal, poses = Kjist({"parameters": KJIST_LITERAL}), _poses(kjist, rng, 30, centre=330.0, spread=40.0)
    assert np.array_equal(kjist.solve_inverse(poses).joints, literal.solve_inverse(poses).joints)
    assert kjist.parameters.plane_radius - literal.parameters.plane_radius == 40.0


def test_kjist_stands_upright_at_the_jigs_height(kjist):
    values = _values(kjist, LEVEL + np.array([0.0, 0.0, 80.0, 0.0, 0.0, 0.0]))
    for leg in (1, 2, 3):
        assert math.degrees(values[f"leg_{leg}_theta_1"]) == pytest.approx(135.573, abs=5e-4)
        assert math.degrees(values[f"leg_{leg}_theta_2"]) == pytest.approx(44.427, abs=5e-4)
        assert math.degrees(values[f"leg_{leg}_plate_pin"]) == pytest.approx(-90.0, abs=1e-9)
        assert [values[f"leg_{leg}_{turn}"] for turn in ("tilt", "twist")] == pytest.approx([0.0, 0.0], abs=1e-12)


def test_hanging_bars_are_another_branch_with_the_plate_below_its_joints(kjist):
    low = LEVEL - np.array([0.0, 0.0, 80.0, 0.0, 0.0, 0.0])
    for leg in (1, 2, 3):
        assert math.degrees(_values(kjist, low, "hanging-out")[f"leg_{leg}_plate_pin"]) == pytest.approx(90.0, abs=1e-9)
        assert math.degrees(_values(kjist, low, "standing-out")[f"leg_{leg}_plate_pin"]) == pytest.approx(-90, abs=1e-9)


def test_a_bar_along_its_pantographs_normal_holds_nothing_and_is_refused(kjist):
    """e_r . k = 0: the joint centre would run along its plane's normal nowhere, so the plate is loose."""
    p = kjist.parameters
    shift = np.array([0.999 * p.bar_length, 0.0, 252.0, 0.0, 0.0, 0.0])
    inverse = kjist.solve_inverse(shift[None])
    held = inverse.margins[0][inverse.requirements.index("leg_1 bar held")]
    assert held < 0.0
    assert not inverse.is_reachable[0]


# --- All three


@pytest.mark.parametrize(
    ("build", "height", "forces"),
    [(Uci, 250.0, (606, 700, 357)), (Kaist, 250.0, (541, 625, 417)), (Kjist, 330.0, (866, 800, 357))],
)
def test_home_torques_for_10_newton_are_those_of_the_reference(build, height, forces):
    """Largest motor torque [N mm] that holds 10 N along x, y, z."""
    J = build({}).compute_jacobian(np.array([[0.0, 0.0, height, 0.0, 0.0, 0.0]]))[0]
    torque = [np.abs(np.linalg.solve(J.T, 10.0 * np.eye(6)[i])).max() for i in range(3)]
    assert torque == pytest.approx(forces, abs=0.5)


def _litres(mechanism, tilt, seed=5, n=120_000, low=(-300.0, -300.0, 60.0), high=(300.0, 300.0, 400.0)):
    rng, poses = np.random.default_rng(seed), np.zeros((n, 6))
    poses[:, :3] = rng.uniform(low, high, (n, 3))
    poses[:, 3:] = np.array(tilt) * DEG
    share = np.mean(mechanism.solve_inverse(poses).is_reachable)
    return share * np.prod(np.subtract(high, low)) * 1e-6


UCI_60 = UciLimits(pin_max=60.0 * DEG)


@pytest.mark.parametrize(
    ("sections", "tilt", "litres"),
    [
        ({"joint_limits": UCI_60}, (0, 0, 0), 12.97),
        ({"joint_limits": UCI_60}, (10, 10, 10), 10.60),
        ({"joint_limits": UCI_60}, (20, 0, 0), 7.79),
        ({"joint_limits": UCI_60}, (0, 0, 30), 10.76),
        ({"joint_limits": UCI_60, "parameters": UCI_LITERAL}, (0, 0, 0), 12.94),
        ({"joint_limits": UCI_60, "parameters": UCI_LITERAL}, (20, 0, 0), 8.00),
        ({"parameters": UciParameters(base_radius=120.0)}, (0, 0, 0), 12.91),
    ],
)
def test_uci_workspace_in_litres(sections, tilt, litres):
    assert _litres(Uci(sections), tilt) == pytest.approx(litres, rel=0.03)


@pytest.mark.parametrize(
    ("sections", "tilt", "litres"),
    [
        ({}, (0, 0, 0), 12.38),
        ({}, (10, 10, 10), 9.25),
        ({}, (20, 0, 0), 7.30),
        ({}, (0, 0, 30), 7.07),
        ({"parameters": KAIST_LITERAL}, (0, 0, 0), 13.30),
    ],
)
def test_kaist_workspace_in_litres(sections, tilt, litres):
    assert _litres(Kaist(sections), tilt) == pytest.approx(litres, rel=0.03)


@pytest.mark.parametrize(("bar", "platform", "litres"), [(60.0, 110.0, 1.75), (80.0, 110.0, 2.83), (60.0, 80.0, 0.49)])
def test_kjist_workspace_in_litres_grows_with_the_bars_and_wants_equal_radii(bar, platform, litres):
    kjist = Kjist({"parameters": KjistParameters(bar_length=bar, platform_radius=platform)})
    low, high = (-110.0, -110.0, 150.0), (110.0, 110.0, 440.0)
    assert _litres(kjist, (0, 0, 0), low=low, high=high) == pytest.approx(litres, rel=0.05)


@pytest.mark.parametrize(
    ("build", "height", "spread"), [(Uci, 250.0, 40.0), (Kaist, 250.0, 40.0), (Kjist, 330.0, 25.0)]
)
def test_closure_agrees_with_a_search_on_the_inverse(build, height, spread, rng):
    """The second way knows the inverse kinematics only."""
    mechanism = build({})
    poses = _poses(mechanism, rng, 15, centre=height, spread=spread, turn=10.0)
    active = mechanism.solve_inverse(poses).joints[:, :6]
    closed = mechanism.solve_forward(active)
    searched = search_forward(mechanism, active, [mechanism.home], None)
    assert closed.is_solved.all()
    assert searched.is_solved.all()
    assert np.abs(closed.poses - poses).max() < 1e-9
    assert np.abs(searched.poses - poses).max() < 1e-7


@pytest.mark.parametrize("build", [Uci, Kaist, Kjist])
def test_branches_may_differ_from_leg_to_leg(build):
    mechanism = build({})
    mixed = "/".join(mechanism.branches[k] for k in (0, 1, 0))
    here, there = (mechanism.solve_inverse(mechanism.home[None], name).joints[0] for name in (None, mixed))
    assert here[:2] == pytest.approx(there[:2])
    assert here[4:6] == pytest.approx(there[4:6])
    assert np.abs(here[2:4] - there[2:4]).max() > 0.1
