"""Measures of dexterity against their definitions, and singular poses against the curves that are known."""

from __future__ import annotations

import math
import sys
import types

import numpy as np
import pytest

from linkwright.analysis.dexterity.isotropy_index import compute_global_isotropy, trace_isotropy
from linkwright.analysis.dexterity.loci import compute_loci
from linkwright.analysis.dexterity.measures import compute_ellipsoids, measure_jacobians, measure_poses
from linkwright.analysis.dexterity.report import PoseRequest, build_report, choose_poses
from linkwright.analysis.dexterity.scaling import Form, Scaling, compute_hand_jacobian, hand_columns, natural_length
from linkwright.analysis.dexterity.singularity import Kind, find_nearest_singularities
from linkwright.analysis.dexterity.survey import survey_poses
from linkwright.analysis.pose_sets import PoseSet
from linkwright.designs import catalogue
from linkwright.designs.codegen.kernel import Kernel
from linkwright.designs.language.errors import KinematicsError, ParameterError, VacuousCheckError
from linkwright.designs.language.poses import pose_from_task

DEG = math.pi / 180.0


def design_of(name):
    return catalogue.entry(name).default_design()


@pytest.fixture(params=catalogue.names())
def each_design(request):
    return design_of(request.param)


def reachable_poses(design, rng, n=200):
    poses = rng.uniform(*design.box(), (n, len(design.mechanism.task)))
    return poses[design.mechanism.solve_inverse(poses).is_reachable]


def test_measures_are_those_of_the_inverted_jacobian(each_design, rng):
    mechanism, length = each_design.mechanism, 80.0
    poses = reachable_poses(each_design, rng)
    got = measure_poses(mechanism, poses, length)
    for k, G in enumerate(compute_hand_jacobian(mechanism, poses)):
        J = np.linalg.pinv(G)
        whole = np.concatenate([J[:3], J[3:] * length])
        values = np.linalg.svd(whole, compute_uv=False)
        assert got.condition[k] == pytest.approx(values[0] / values[-1], rel=1e-9)
        assert got.isotropy[k] == pytest.approx(values[-1] / values[0], rel=1e-9)
        assert got.manipulability[k] == pytest.approx(math.sqrt(np.linalg.det(whole @ whole.T)), rel=1e-9)
        assert (got.slowest[k], got.fastest[k]) == pytest.approx((values[-1], values[0]), rel=1e-9)
        assert got.condition_position[k] == pytest.approx(np.linalg.cond(J[:3]), rel=1e-9)
        if len(J) > 3:
            assert got.condition_rotation[k] == pytest.approx(np.linalg.cond(J[3:]), rel=1e-9)


def test_conditions_of_moves_and_of_turns_do_not_depend_on_the_length(rng):
    design = design_of("hit")
    poses = reachable_poses(design, rng)
    one, other = (measure_poses(design.mechanism, poses, length) for length in (20.0, 300.0))
    for name in ("condition_position", "condition_rotation"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-10)
    assert np.abs(one.condition / other.condition - 1.0).min() > 1e-3


def test_at_the_natural_length_moves_and_turns_weigh_alike_at_home(each_design):
    mechanism = each_design.mechanism
    length, G = natural_length(mechanism), compute_hand_jacobian(mechanism, mechanism.home[None])[0]
    if hand_columns(mechanism) <= 3:
        assert length == 1.0
        return
    moves, turns = np.mean(G[:, :3] ** 2), np.mean((G[:, 3:] / length) ** 2)
    assert moves * len(G) == pytest.approx(turns * len(G), rel=1e-12)


def test_the_least_condition_is_one_and_belongs_to_square_lines(rng):
    Q, _ = np.linalg.qr(rng.normal(size=(6, 6)))
    got = measure_jacobians(Q[None], 1.0)
    assert got.condition[0] == pytest.approx(1.0)
    assert got.parallel_margin[0] == pytest.approx(1.0)
    assert abs(got.determinant[0]) == pytest.approx(1.0)
    assert got.serial_margin[0] == pytest.approx(1.0)


def test_the_two_kinds_of_singularity_are_told_apart(rng):
    """Lines that depend on each other free the hand; a lever of zero stops a motor."""
    W = rng.normal(size=(6, 6))
    W /= np.linalg.norm(W, axis=1, keepdims=True)
    plain = measure_jacobians(W[None], 1.0)
    dependent = W.copy()
    dependent[5] = (W[0] + W[1]) / np.linalg.norm(W[0] + W[1])
    parallel = measure_jacobians(dependent[None], 1.0)
    assert parallel.parallel_margin[0] < 1e-12 < plain.parallel_margin[0]
    assert parallel.serial_margin[0] == pytest.approx(1.0)
    short = W * np.array([1.0, 1e9, 1.0, 1.0, 1.0, 1.0])[:, None]
    serial = measure_jacobians(short[None], 1.0)
    assert serial.serial_margin[0] == pytest.approx(1e-9)
    assert serial.parallel_margin[0] == pytest.approx(plain.parallel_margin[0], rel=1e-6)
    assert serial.determinant[0] == pytest.approx(plain.determinant[0], rel=1e-6)


def test_motor_rates_of_length_one_stay_in_the_ellipsoid_and_reach_its_ends(rng):
    mechanism = design_of("hit").mechanism
    J = np.linalg.inv(compute_hand_jacobian(mechanism, mechanism.home[None])[0])
    rates = rng.normal(size=(5000, 6))
    rates /= np.linalg.norm(rates, axis=1, keepdims=True)
    for part, ellipsoid in zip((J[:3], J[3:]), compute_ellipsoids(mechanism, mechanism.home), strict=True):
        reached = rates @ part.T @ ellipsoid.directions / ellipsoid.semi_axes
        assert np.linalg.norm(reached, axis=1).max() < 1.0 + 1e-12
        assert np.linalg.norm(
            np.linalg.pinv(part) @ ellipsoid.directions * ellipsoid.semi_axes, axis=0
        ) == pytest.approx(1.0)


def test_the_compiled_index_is_that_of_numpy(each_design, rng):
    mechanism = each_design.mechanism
    poses = reachable_poses(each_design, rng)
    G = compute_hand_jacobian(mechanism, poses)
    G = G[:, np.any(G != 0.0, axis=(0, 2))]
    motors, hand = (tuple(rng.uniform(0.5, 2.0, n)) for n in G.shape[1:])
    for form, columns in ((Form.FORCE, 1.0 / np.array(hand)), (Form.VELOCITY, np.array(hand))):
        scaling = Scaling(motors=motors, hand=hand, form=form)
        kernel = Kernel(trace_isotropy(mechanism, scaling, has_hand_axes=False, has_limits=True))
        found = compute_global_isotropy(kernel, PoseSet(positions=poses, turns=np.zeros((1, 0))))
        values = np.linalg.svd(G * np.array(motors)[:, None] * columns, compute_uv=False)
        assert found.n_unreachable == 0
        assert found.index == pytest.approx(values[:, -1].min() / values[:, 0].max(), rel=1e-9)
        assert (found.pose_of_least == poses[np.argmin(values[:, -1])]).all()
        assert (found.pose_of_greatest == poses[np.argmax(values[:, 0])]).all()


def test_the_axes_of_the_hand_are_those_of_its_body(rng):
    design = design_of("hit")
    mechanism, poses = design.mechanism, reachable_poses(design, rng)
    hand = (1.0, 2.0, 3.0, 100.0, 200.0, 300.0)
    found = compute_global_isotropy(
        Kernel(trace_isotropy(mechanism, Scaling(hand=hand))), PoseSet(positions=poses, turns=np.zeros((1, 0)))
    )
    G, Q = mechanism.compute_jacobian(poses), pose_from_task(poses)[:, :3, :3]
    own = np.concatenate([G[..., :3] @ Q, G[..., 3:] @ Q], axis=-1) / np.array(hand)
    values = np.linalg.svd(own, compute_uv=False)
    assert found.index == pytest.approx(values[:, -1].min() / values[:, 0].max(), rel=1e-9)


def test_a_pen_without_roll_has_the_papers_axes_too(rng):
    design = design_of("haptic_pen")
    pen, poses = design.mechanism, reachable_poses(design, rng)
    hand = (1.0, 1.0, 1.5, 36.0, 39.0)
    found = compute_global_isotropy(
        Kernel(trace_isotropy(pen, Scaling(hand=hand))), PoseSet(positions=poses, turns=np.zeros((1, 0)))
    )
    values = np.linalg.svd(pen.compute_force_jacobian(poses) / np.array(hand), compute_uv=False)
    assert found.least == pytest.approx(values[:, -1].min(), rel=1e-9)
    assert found.greatest == pytest.approx(values[:, 0].max(), rel=1e-9)


def test_threads_and_blocks_do_not_change_the_index(rng):
    design = design_of("five_bar")
    poses = PoseSet(positions=rng.uniform(*design.box(), (20_001, 2)), turns=np.zeros((1, 0)))
    kernel, seen = Kernel(trace_isotropy(design.mechanism, Scaling())), []
    found = [
        compute_global_isotropy(
            kernel, poses, n_threads=n, progress=lambda done, total, text: seen.append((done, total))
        )
        for n in (1, 2, 5)
    ]
    assert len({(f.least, f.greatest, tuple(f.pose_of_least), tuple(f.pose_of_greatest)) for f in found}) == 1
    assert seen
    assert all(0 < done <= total == len(poses) for done, total in seen)


def test_poses_out_of_reach_are_counted_and_make_the_index_zero():
    design = design_of("five_bar")
    kernel = Kernel(trace_isotropy(design.mechanism, Scaling()))
    poses = np.stack([design.mechanism.home, [0.0, 5000.0]])
    found = compute_global_isotropy(kernel, PoseSet(positions=poses, turns=np.zeros((1, 0))))
    assert (found.n_unreachable, found.index) == (1, 0.0)
    assert found.index_of_reachable > 0.1
    with pytest.raises(VacuousCheckError):
        compute_global_isotropy(kernel, PoseSet(positions=poses[1:], turns=np.zeros((1, 0))))
    with pytest.raises(VacuousCheckError):
        survey_poses(design.mechanism, poses[1:], 1.0)


def test_wrong_scales_are_refused():
    mechanism = design_of("five_bar").mechanism
    with pytest.raises(ParameterError, match="2 numbers"):
        trace_isotropy(mechanism, Scaling(hand=(1.0, 1.0, 1.0)))
    with pytest.raises(ParameterError, match="positive"):
        Scaling(motors=(1.0, 0.0))


def test_the_survey_holds_the_ends_of_what_it_measured(rng):
    design = design_of("hit")
    lower, upper = design.box()
    poses = rng.uniform(2.0 * lower - upper, 2.0 * upper - lower, (3000, 6))
    survey = survey_poses(design.mechanism, poses, 100.0)
    assert 0 < survey.is_reachable.sum() < len(poses)
    measured = measure_poses(design.mechanism, poses[survey.is_reachable], 100.0)
    spread = survey.spread("condition")
    assert spread.least == pytest.approx(measured.condition.min())
    assert spread.median == pytest.approx(np.median(measured.condition))
    assert measure_poses(design.mechanism, spread.pose_of_greatest[None], 100.0).condition[0] == pytest.approx(
        spread.greatest
    )
    assert survey.margins[0].margin == min(m.margin for m in survey.margins) < 0.0


def test_no_default_workspace_crosses_a_parallel_singularity(each_design):
    poses = choose_poses(each_design, PoseRequest()).poses()
    survey = survey_poses(each_design.mechanism, poses, natural_length(each_design.mechanism))
    assert survey.n_other_assembly == 0
    assert survey.spread("parallel_margin").least > 0.0
    assert survey.spread("serial_margin").least > 0.0


@pytest.mark.parametrize("name", ["five_bar", "sensation"])
def test_the_nearest_singular_tips_lie_on_the_stated_curves(name):
    mechanism = design_of(name).mechanism
    loci = compute_loci(mechanism, 20_000)
    assert {locus.kind for locus in loci} == set(Kind)
    found = find_nearest_singularities(mechanism, mechanism.home, 1.0, within=300.0)
    assert {s.kind for s in found} == set(Kind)
    for s in found:
        away = min(np.linalg.norm(q.points - s.pose, axis=1).min() for q in loci if q.kind is s.kind and len(q.points))
        assert away < 0.1
        assert np.linalg.norm(s.pose - mechanism.home) == pytest.approx(s.distance)
        nearest = min(np.linalg.norm(q.points - mechanism.home, axis=1).min() for q in loci if q.kind is s.kind)
        assert s.distance > nearest - 0.1
    # SenSation's nearest toggle lies 1.6 mm behind the arc where its arms are parallel: another assembly, not counted.
    serial = next(s for s in found if s.kind is Kind.SERIAL)
    stretched = min(np.linalg.norm(q.points - mechanism.home, axis=1).min() for q in loci if q.kind is Kind.SERIAL)
    assert serial.distance == pytest.approx(stretched + (0.0 if name == "five_bar" else 1.57), abs=0.1)


def test_a_singularity_found_is_one(each_design):
    mechanism = each_design.mechanism
    length = natural_length(mechanism)
    for s in find_nearest_singularities(mechanism, mechanism.home, length, within=150.0):
        inside = mechanism.home + (s.pose - mechanism.home) * (1.0 - 1e-7)
        at, home = (measure_poses(mechanism, p[None], length) for p in (inside, mechanism.home))
        if s.kind is Kind.PARALLEL:
            assert at.parallel_margin[0] < 1e-4 * home.parallel_margin[0]
            assert at.serial_margin[0] > 1e-3 * home.serial_margin[0]
        else:
            assert at.serial_margin[0] < 5e-3 * home.serial_margin[0]


def test_a_mechanism_that_states_no_curve_has_none():
    assert compute_loci(design_of("hit").mechanism) == ()


def test_a_mechanism_outside_the_package_states_its_curves_in_its_own_module(monkeypatch):
    module = types.ModuleType("a_single_file")
    exec("def circle_locus(p, sheet, angle):\n    return 5.0 * np.cos(angle), 5.0 * np.sin(angle)", module.__dict__)
    module.np = np
    monkeypatch.setitem(sys.modules, "a_single_file", module)
    kind = type("Mine", (), {"__module__": "a_single_file", "sections": {"parameters": None}})
    loci = compute_loci(kind())
    assert [locus.name for locus in loci] == ["circle +1", "circle -1"]
    assert np.linalg.norm(loci[0].points, axis=1) == pytest.approx(5.0)


def test_the_report_refuses_what_it_cannot_measure():
    design = design_of("five_bar")
    with pytest.raises(KinematicsError, match="stretched"):
        build_report(design, np.array([0.0, 5000.0]))
    with pytest.raises(ParameterError, match="turns"):
        choose_poses(design, PoseRequest(cone=0.3))
    with pytest.raises(ParameterError, match="one number, or 2"):
        choose_poses(design, PoseRequest(grid=(3, 3, 3)))
    with pytest.raises(ParameterError, match="no roll"):
        choose_poses(design_of("haptic_pen"), PoseRequest(cone=0.3, rolls=(0.1,)))


def test_rings_and_grid_are_laid_over_the_declared_positions():
    design = design_of("pathos2")
    poses = choose_poses(design, PoseRequest(grid=(3, 3, 2), cone=10.0 * DEG, n_rings=1, rolls=(30.0 * DEG,)))
    assert len(poses) == 3 * 3 * 2 * 7
    assert (poses.poses()[:, 6] == design.mechanism.home[6]).all()
    lower, upper = design.box()
    assert poses.positions.min(axis=0) == pytest.approx(lower[:3])
    assert poses.positions.max(axis=0) == pytest.approx(upper[:3])


def test_positions_and_turns_of_pathos2_have_the_reference_conditions():
    """At the middle with Rz = 30 degrees: J_p 3.15, J_o 3.93 (Kim, Chung, eq. 22)."""
    mechanism = design_of("pathos2").mechanism
    pose = np.array([[0.0, 0.0, 225.0, 0.0, 0.0, 30.0 * DEG, 70.0]])
    got = measure_poses(mechanism, pose, 1.0)
    assert (got.condition_position[0], got.condition_rotation[0]) == pytest.approx((3.15, 3.93), abs=6e-3)
