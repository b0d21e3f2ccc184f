"""Registration to planes and of lines: the same laws for every solver."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.lines import Lines
from recon4.geometry.se3 import SE3
from recon4.registration.collar_lines import LineTarget, register_lines
from recon4.registration.plane_map import PlaneMap
from recon4.registration.planes import register_to_planes
from recon4.registration.result import StopReason
from recon4.registration.segments import sample_segments
from recon4.registration.submap import place_segments
from recon4.registration.tuning import PlaneTuning, RegistrationTuning
from tests.room_walks import T0_NS
from tests.scanned_room import RIG, scan, standing, walk

PLANES = PlaneTuning()
T_TRUE = SE3.from_rpy(0.01, -0.02, 0.06, t=[0.25, -0.10, 0.04])
SOLVERS = ("planes", "common_normal", "svd")
# Lines are sampled again in each frame: without a plane between them they agree less well.
TOLERANCE_M = {"planes": 0.004, "common_normal": 0.012, "svd": 0.06}


def settings_of(solver, **changes):
    rounds = 200 if solver == "svd" else 40
    return RegistrationTuning(solver=solver, max_iterations=rounds, **changes)


def ends_of(T_map_body, *, first_id, frames=6):
    """Segments of a few frames from one place, in the body's frame, (M, 2, 3)."""
    parts = []
    for k in range(first_id, first_id + frames):
        frame = scan(lambda t_s: T_map_body @ SE3.identity(len(t_s)), T0_NS, frame_id=k)
        segments = sample_segments(frame, RIG)
        parts.append(np.stack([segments.a_body, segments.b_body], axis=1))
    return np.concatenate(parts)


@pytest.fixture(scope="module")
def target_ends():
    return ends_of(SE3.identity(), first_id=0)


@pytest.fixture(scope="module")
def source_ends():
    return ends_of(T_TRUE, first_id=20, frames=2)


def register(solver, target, source, initial, **changes):
    settings = settings_of(solver, **changes)
    if solver == "planes":
        planes = PlaneMap(PLANES)
        planes.add(np.ascontiguousarray(target.reshape(-1, 3)))
        return register_to_planes(planes, source.reshape(-1, 3), initial=initial, settings=settings)
    return register_lines(
        LineTarget(Lines.through(target[:, 0], target[:, 1])),
        Lines.through(source[:, 0], source[:, 1]),
        initial=initial,
        portion=0.7,
        settings=settings,
    )


def prediction_offset_m(T_a_b, T_other):
    """How far apart two poses put a point 5 m away."""
    delta = T_a_b.inverse() @ T_other
    return np.linalg.norm(delta.t) + 5 * delta.angle()


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_known_motion_is_recovered(solver, target_ends, source_ends):
    found = register(solver, target_ends, source_ends, SE3.identity())

    assert found.converged, found.stop
    assert prediction_offset_m(found.T_target_source, T_TRUE) < 2 * TOLERANCE_M[solver]
    assert found.match_ratio > 0.6
    assert found.degeneracy > 0.02


@pytest.mark.parametrize("solver", SOLVERS)
def test_forward_and_backward_are_inverse(solver, target_ends, source_ends):
    forward = register(solver, target_ends, source_ends, SE3.identity())
    backward = register(solver, source_ends, target_ends, SE3.identity())

    around = forward.T_target_source @ backward.T_target_source
    assert prediction_offset_m(around, SE3.identity()) < 4 * TOLERANCE_M[solver]


@pytest.mark.parametrize("solver", ["common_normal", "svd"])
def test_registration_of_lines_does_not_depend_on_where_the_world_is(
    solver, target_ends, source_ends
):
    W = SE3.from_rpy(0.4, -0.3, 2.0, t=[60.0, -35.0, 8.0])
    moved_ends = (W @ target_ends.reshape(-1, 3)).reshape(-1, 2, 3)

    here = register(solver, target_ends, source_ends, SE3.identity())
    there = register(solver, moved_ends, source_ends, W)

    assert prediction_offset_m(W.inverse() @ there.T_target_source, here.T_target_source) < 1e-3


def test_registration_to_planes_hardly_depends_on_where_the_world_is(target_ends, source_ends):
    # Cubes cut a turned world elsewhere, so not bit for bit.
    W = SE3.from_rpy(0.4, -0.3, 2.0, t=[60.0, -35.0, 8.0])
    moved_ends = (W @ target_ends.reshape(-1, 3)).reshape(-1, 2, 3)

    there = register("planes", moved_ends, source_ends, W)

    assert (
        prediction_offset_m(W.inverse() @ there.T_target_source, T_TRUE) < 4 * TOLERANCE_M["planes"]
    )


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_shifted_source_gives_the_shifted_motion(solver, target_ends, source_ends):
    S = SE3.from_rpy(0.0, 0.0, 0.5, t=[3.0, 1.0, 0.0])
    shifted = (S.inverse() @ source_ends.reshape(-1, 3)).reshape(-1, 2, 3)

    plain = register(solver, target_ends, source_ends, SE3.identity())
    moved = register(solver, target_ends, shifted, S)

    # Rotation is about another point then, so the steps are not the same bit for bit.
    assert (
        prediction_offset_m(moved.T_target_source @ S.inverse(), plain.T_target_source)
        < TOLERANCE_M[solver]
    )


@pytest.mark.parametrize("solver", SOLVERS)
def test_too_few_segments_are_a_stop_reason(solver, target_ends, source_ends):
    none = register(solver, target_ends, source_ends[:0], T_TRUE)
    few = register(solver, target_ends, source_ends[:15], T_TRUE)
    no_target = register(solver, target_ends[:0], source_ends, T_TRUE)

    for found in (none, few, no_target):
        assert found.stop is StopReason.TOO_FEW
        assert not found.converged
        assert np.isfinite(found.T_target_source.t).all()


@pytest.mark.parametrize("solver", SOLVERS)
def test_the_limit_of_rounds_is_not_convergence(solver, target_ends, source_ends):
    settings = replace(settings_of(solver), max_iterations=2)
    planes = PlaneMap(PLANES)
    planes.add(np.ascontiguousarray(target_ends.reshape(-1, 3)))
    if solver == "planes":
        found = register_to_planes(
            planes,
            source_ends.reshape(-1, 3),
            initial=SE3.identity(),
            settings=settings,
        )
    else:
        lines = Lines.through(target_ends[:, 0], target_ends[:, 1])
        found = register_lines(
            LineTarget(lines),
            Lines.through(source_ends[:, 0], source_ends[:, 1]),
            initial=SE3.identity(),
            portion=0.7,
            settings=settings,
        )

    assert found.stop is StopReason.LIMIT
    assert found.iterations == 2
    assert not found.converged


class RecordingMap(PlaneMap):
    """A map of planes that records the parameters of its matches."""

    def __init__(self, settings):
        super().__init__(settings)
        self.finest, self.gate_m = [], []

    def match(self, *args, finest, gate_m, **more):
        self.finest.append(finest)
        self.gate_m.append(gate_m)
        return super().match(*args, finest=finest, gate_m=gate_m, **more)


def test_large_cubes_and_a_wide_gate_come_first_and_all_gates_are_used(target_ends):
    planes = RecordingMap(PLANES)
    planes.add(np.ascontiguousarray(target_ends.reshape(-1, 3)))

    found = register_to_planes(
        planes, target_ends.reshape(-1, 3), initial=SE3.identity(),
        settings=settings_of("planes"),
    )  # fmt: skip

    rounds = slice(found.iterations)
    assert planes.finest[:4] == [3, 2, 1, 0]
    assert planes.gate_m[rounds] == sorted(planes.gate_m[rounds], reverse=True)
    # The initial pose is the truth: all steps are small, yet all gates are used.
    assert (planes.gate_m[0], planes.gate_m[rounds][-1]) == (1.0, 0.15)


def corner(count, *, off_m=0.0, seed=1):
    """Points of a floor and two walls that meet, at some distance before them, (3 count, 3)."""
    rng = np.random.default_rng(seed)
    walls = []
    for axis in range(3):
        p = rng.uniform(0.0, 6.0, (count, 3))
        p[:, axis] = 0.05 + off_m
        walls.append(p)
    return np.concatenate(walls)


def test_the_error_counts_what_lies_too_far_off_to_register_but_not_what_is_elsewhere():
    planes = PlaneMap(PLANES)
    planes.add(corner(60_000))
    there, before, elsewhere = (
        corner(count, off_m=off_m, seed=seed)
        for seed, (count, off_m) in enumerate([(1200, 0.0), (600, 0.3), (200, 0.9)], start=2)
    )

    found = register_to_planes(
        planes, np.concatenate([there, before, elsewhere]), initial=SE3.identity(),
        settings=settings_of("planes"),
    )  # fmt: skip

    assert prediction_offset_m(found.T_target_source, SE3.identity()) < 0.02
    # A third of what counts lies 0.3 m off; the tenth that lies 0.9 m off would make it 0.18.
    assert found.error_m == pytest.approx(0.1, abs=0.03)


def test_a_solution_far_from_the_initial_pose_is_unstable(target_ends, source_ends):
    found = register("planes", target_ends, source_ends, SE3.identity(), max_move_m=0.1)

    assert found.stop is StopReason.UNSTABLE


def test_a_place_never_seen_is_not_matched(target_ends, source_ends):
    elsewhere = SE3(np.eye(3), np.array([500.0, 0.0, 0.0]))

    assert register("planes", target_ends, source_ends, elsewhere).stop is StopReason.TOO_FEW


def test_parallel_lines_only_give_no_motion():
    rng = np.random.default_rng(1)
    mid = rng.uniform(-3, 3, (200, 3))
    lines = Lines(mid, np.tile([0.0, 0.0, 1.0], (200, 1)))
    target = LineTarget(lines)

    found = register_lines(
        target, lines, initial=SE3.identity(), portion=1.0, settings=settings_of("svd")
    )

    assert not found.converged
    assert prediction_offset_m(found.T_target_source, SE3.identity()) == 0.0


def test_moving_objects_have_little_weight_along_common_normals(target_ends, source_ends):
    moved = source_ends.copy()
    moved[::3] += [0.3, 0.18, 0.09]

    found = register("common_normal", target_ends, moved, T_TRUE)
    plain = register("common_normal", target_ends, moved, T_TRUE, kernel_m=100.0)

    assert found.converged
    assert prediction_offset_m(found.T_target_source, T_TRUE) < 0.04
    assert prediction_offset_m(plain.T_target_source, T_TRUE) > 0.08


def test_portion_is_the_fraction_of_lines_kept(target_ends, source_ends):
    lines = Lines.through(source_ends[:, 0], source_ends[:, 1])
    target = LineTarget(Lines.through(target_ends[:, 0], target_ends[:, 1]))

    found = register_lines(
        target, lines, initial=T_TRUE, portion=0.3, settings=settings_of("svd", error_window=1)
    )

    assert found.match_ratio == pytest.approx(0.3, abs=1e-3)


# -- segments in a moving frame


def test_segments_are_the_same_every_time_and_within_their_bounds():
    frame = scan(standing, T0_NS, columns=1800)

    first, again = (sample_segments(frame, RIG) for _ in range(2))

    np.testing.assert_array_equal(first.a_body, again.a_body)
    assert 0.8 * 2 * 2700 < len(first) <= 2 * 2700
    length = np.linalg.norm(first.a_body - first.b_body, axis=1)
    assert (length <= 0.34 * first.range_m + 1e-6).all()


def test_segments_of_a_sensor_that_is_off_are_not_drawn():
    rig = replace(RIG, sensors=(RIG.sensors[0], replace(RIG.sensors[1], enabled=False)))
    frame = scan(standing, T0_NS)

    both, one = (sample_segments(frame, r) for r in (RIG, rig))

    assert 0 < len(one) < len(both)
    np.testing.assert_array_equal(one.a_body, both.a_body[: len(one)])


def test_each_end_keeps_the_time_and_place_of_its_point():
    frame = scan(standing, T0_NS, noise_m=0.0)

    segments = sample_segments(frame, RIG)

    T = RIG.T_body_sensor[frame.sensor]
    p_body = (T @ frame.xyz.astype(np.float64)).round(9)
    when = {tuple(p): dt for p, dt in zip(p_body.tolist(), frame.dt_ns.tolist(), strict=True)}
    for p, t_s in zip(segments.a_body[::97].round(9).tolist(), segments.a_s[::97], strict=True):
        assert when[tuple(p)] == pytest.approx(t_s * 1e9, abs=1)


def test_an_empty_frame_has_no_segments():
    frame = scan(standing, T0_NS).take(slice(0, 0))

    segments = sample_segments(frame, RIG)
    placed = place_segments(
        segments, frame.t_ns, frame.duration_ns, trajectory=walk(standing, 1).truth
    )

    assert len(segments) == 0
    assert placed.shape == (0, 2, 3)


def test_a_direction_that_only_noise_observes_keeps_the_initial_pose():
    rng = np.random.default_rng(5)

    def tunnel(count):
        """Floor and two walls along x, rough by 1 cm."""
        p = rng.uniform([-8.0, -0.9, 0.0], [8.0, 0.9, 2.5], (3 * count, 3))
        p[:count, 2], p[count : 2 * count, 1], p[2 * count :, 1] = 0.05, -0.85, 0.85
        return p + 0.01 * rng.standard_normal(p.shape)

    planes = PlaneMap(PLANES)
    planes.add(tunnel(20_000))
    initial = SE3(np.eye(3), np.array([0.4, 0.02, -0.02]))

    found = register_to_planes(
        planes, tunnel(2000), initial=initial, settings=settings_of("planes"),
        normal_noise_rad=0.08,
    )  # fmt: skip

    # Across the tunnel the pose is found, along it nothing is claimed.
    np.testing.assert_allclose(found.T_target_source.t, [0.4, 0.0, 0.0], atol=0.01)
    assert found.information[3, 3] < 1e-3 * found.information[4, 4]
