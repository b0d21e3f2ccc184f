import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import Cancelled
from recon4.geometry.se3 import SE3, so3_exp
from recon4.model.figures import RefineFigures
from recon4.model.plain import to_plain
from recon4.model.pose_graph import PoseGraph
from recon4.model.trajectory import Trajectory
from recon4.progress import Silent
from recon4.registration.plane_map import Match
from recon4.registration.segments import sample_segments
from recon4.registration.submap import place_segments
from recon4.semi_rigid.refine import (
    MatchedFrames,
    _Sweep,
    corrected_by_nodes,
    refine,
    refine_trajectory,
)
from recon4.semi_rigid.tuning import RefineTuning
from recon4.settings import Settings, override
from recon4.store.arrays import load_trajectory, save_trajectory
from recon4.store.unfinished import keeping
from tests.scanned_room import strolling, walk, without_points

SETTINGS = replace(
    override(Settings(), ["graph.workers=1"]),
    refine=RefineTuning(rounds=6, converged_step_m=0.0002),
)


@pytest.fixture(scope="module")
def stroll():
    return walk(strolling, 30)


def bent(truth, height_m=0.012):
    """The truth with a slow wave of a centimeter, as a graph leaves it between its nodes."""
    s = (truth.t_ns - truth.t_ns[0]) / (truth.t_ns[-1] - truth.t_ns[0])
    wave = np.sin(3 * np.pi * s)[:, None]
    t = truth.T_a_b.t + height_m * wave * [0.6, 0.6, 1.0]
    R = so3_exp(0.003 * wave * [0.0, 0.0, 1.0]) @ truth.T_a_b.R
    return Trajectory(truth.t_ns, SE3(R, t))


def off_m(trajectory, truth):
    """Deviation from the truth apart from the place of the whole [m]."""
    d = trajectory.T_a_b.t - truth.T_a_b.t
    return float(np.sqrt(np.mean(np.sum((d - d.mean(axis=0)) ** 2, axis=1))))


def lost_none(frames):
    return np.zeros(len(frames), bool)


def tuned_by(**values):
    return replace(SETTINGS, refine=replace(SETTINGS.refine, **values))


def refined(stroll, start, *, lost=None, settings=SETTINGS):
    lost = lost_none(stroll) if lost is None else lost
    return refine_trajectory(stroll, start, lost, settings=settings, progress=Silent())


def test_a_bent_trajectory_becomes_straighter(stroll):
    start = bent(stroll.truth)

    result, rounds = refined(stroll, start)

    assert off_m(result, stroll.truth) < 0.75 * off_m(start, stroll.truth)
    assert rounds[-1].mean_m < rounds[0].mean_m
    assert rounds[-1].largest_step_m < rounds[0].largest_step_m
    np.testing.assert_array_equal(result.t_ns, start.t_ns)


def test_the_truth_stays_where_it_is(stroll):
    result, rounds = refined(stroll, stroll.truth)

    assert off_m(result, stroll.truth) < 0.002
    assert rounds[0].match_ratio > 0.5


def test_refinement_stops_once_nothing_moves(stroll):
    patient = tuned_by(converged_step_m=0.02)

    assert len(refined(stroll, stroll.truth, settings=patient)[1]) == 1


def test_threads_do_not_change_a_bit(stroll):
    two = override(tuned_by(rounds=1), ["graph.workers=2"])
    one = tuned_by(rounds=1)

    a, b = (refined(stroll, bent(stroll.truth), settings=s)[0] for s in (one, two))

    np.testing.assert_array_equal(a.T_a_b.t, b.T_a_b.t)


def test_lost_multiframes_are_excluded(stroll):
    lost = lost_none(stroll)
    lost[[10, 11]] = True
    frames = list(stroll)
    for k in (10, 11):
        frames[k] = without_points(frames[k])

    with_points, _ = refined(stroll, bent(stroll.truth), lost=lost)
    without, _ = refined(replace(stroll, frames=frames), bent(stroll.truth), lost=lost)

    np.testing.assert_array_equal(with_points.T_a_b.t, without.T_a_b.t)


def test_without_any_match_nothing_moves(stroll):
    start = bent(stroll.truth)

    result, rounds = refined(stroll, start, lost=np.ones(len(stroll), bool))

    assert rounds == []
    np.testing.assert_array_equal(result.T_a_b.t, start.T_a_b.t)


class Asked:
    """A double of the map that records the points of its matches and finds nothing."""

    def match(self, p_map, fraction, **_):
        self.p_map, self.fraction = p_map, fraction
        nan = np.full(len(p_map), np.nan)
        return Match(np.zeros((12, 12)), np.zeros(12), nan, 0, np.nan, 0.0)


def test_both_ends_of_a_segment_are_matched_each_at_its_own_time(stroll):
    sweep = _Sweep(stroll, stroll.truth, lost_none(stroll), settings=SETTINGS, progress=Silent())
    frame, asked = stroll[25], Asked()

    assert sweep._match_one(asked, sweep._placed(25)) is None

    t_ns = frame.t_ns + np.rint(asked.fraction * frame.duration_ns).astype(np.int64)
    back = stroll.truth.at(t_ns).inverse()
    segments = sample_segments(frame, stroll.rig)
    ends = np.stack([segments.a_body, segments.b_body], axis=1).reshape(-1, 3)
    p_body = np.einsum("nij,nj->ni", back.R, asked.p_map) + back.t
    np.testing.assert_allclose(p_body, ends, atol=1e-4)
    assert np.ptp(asked.fraction) > 0.9


# -- points far in time only


def matched(stroll, gap_s):
    """Multiframes that match a map of the first multiframe only."""
    settings = tuned_by(min_gap_s=gap_s, map_stride=1000)
    frames = lost_none(stroll)
    sweep = _Sweep(stroll, stroll.truth, frames, settings=settings, progress=Silent())
    system, _, _ = sweep.match(sweep.build(), MatchedFrames(0))
    return system.H.any(axis=(1, 2))


def test_a_multiframe_does_not_match_points_near_in_time(stroll):
    assert matched(stroll, 0.0).all()
    assert not matched(stroll, 0.7)[:8].any()
    assert matched(stroll, 0.7)[-5:].all()


def test_a_short_recording_matches_all_it_has(stroll):
    assert matched(stroll, 1.1).all()


def test_the_map_is_whole_again_after_a_sweep_but_for_the_end(stroll):
    settings = tuned_by(min_gap_s=0.3)
    sweep = _Sweep(stroll, stroll.truth, lost_none(stroll), settings=settings, progress=Silent())
    planes, whole = sweep.build(), sweep.build()

    sweep.match(planes, MatchedFrames(0))

    frame, early = stroll[2], stroll.truth.at(stroll.t_mid_ns[2:3]).t[0]
    segments = sample_segments(frame, stroll.rig)
    ends = place_segments(segments, frame.t_ns, frame.duration_ns, trajectory=stroll.truth)
    fraction = np.full(len(ends), 0.5)
    a, b = (
        p.match(ends.mean(axis=1), fraction, center=early, finest=0, gate_m=0.1)
        for p in (planes, whole)
    )
    assert a.matches > 0.95 * b.matches
    assert a.mean_m == pytest.approx(b.mean_m, rel=0.1)


def test_points_far_in_time_straighten_a_bend_more_than_its_own(stroll):
    start = bent(stroll.truth)
    own, far = (
        refined(stroll, start, settings=tuned_by(min_gap_s=gap_s))[0] for gap_s in (0.0, 0.5)
    )

    assert off_m(far, stroll.truth) < 0.9 * off_m(own, stroll.truth)


# -- the stage


def prepared(stroll, folder):
    """Folders of odometry (off by a drift) and graph (true)."""
    for name in ("odometry", "out"):
        (folder / name).mkdir()
    drift = SE3.exp(np.linspace(0, 1, len(stroll.truth))[:, None] * [0, 0, 0.02, 0.1, 0.05, 0.0])
    save_trajectory(
        folder / "odometry" / "trajectory.npz",
        Trajectory(stroll.truth.t_ns, drift @ stroll.truth.T_a_b),
    )
    np.savez(folder / "odometry" / "steps.npz", lost=lost_none(stroll))
    t_ns = stroll.t_mid_ns[2::5]
    graph = PoseGraph(np.arange(2, 30, 5), t_ns, stroll.truth.at(t_ns), ())
    return graph


@pytest.mark.parametrize("mode", ["10", "overlap", "verification"])
def test_other_modes_keep_the_trajectory_of_the_graph(stroll, tmp_path, mode):
    graph = prepared(stroll, tmp_path)

    figures = refine(
        stroll,
        tmp_path / "odometry",
        graph.nodes,
        settings=override(SETTINGS, [f"graph.mode={mode}"]),
        progress=Silent(),
    ).save(tmp_path / "out")

    assert figures == RefineFigures(rounds=())
    found = load_trajectory(tmp_path / "out" / "trajectory.npz")
    odometry = load_trajectory(tmp_path / "odometry" / "trajectory.npz")
    expected = corrected_by_nodes(odometry, graph.nodes)
    np.testing.assert_allclose(found.T_a_b.t, expected.T_a_b.t, atol=1e-9)


def test_mode_beyond_writes_a_better_trajectory_and_its_rounds(stroll, tmp_path):
    graph = prepared(stroll, tmp_path)

    figures = refine(
        stroll,
        tmp_path / "odometry",
        graph.nodes,
        settings=SETTINGS,
        progress=Silent(),
    ).save(tmp_path / "out")

    found = load_trajectory(tmp_path / "out" / "trajectory.npz")
    assert json.loads((tmp_path / "out" / "refine.json").read_text()) == to_plain(figures)
    assert 1 <= len(figures.rounds) <= 6
    inner = slice(30, -30)
    at_nodes = found.at(graph.t_ns)
    np.testing.assert_allclose(at_nodes.t, graph.T_map_body.t, atol=0.006)
    assert off_m(found[inner], stroll.truth[inner]) < 0.006


def test_odometry_moves_along_with_the_nodes(stroll):
    shifted = PoseGraph(
        np.arange(2, 30, 5),
        stroll.t_mid_ns[2::5],
        SE3.from_rpy(0, 0, 1.0, t=[5.0, 0, 0]) @ stroll.truth.at(stroll.t_mid_ns[2::5]),
        (),
    )

    moved = corrected_by_nodes(stroll.truth, shifted.nodes)

    expected = SE3.from_rpy(0, 0, 1.0, t=[5.0, 0, 0]) @ stroll.truth.T_a_b
    np.testing.assert_allclose(moved.T_a_b.t, expected.t, atol=1e-9)
    np.testing.assert_allclose(moved.T_a_b.R, expected.R, atol=1e-9)


def test_a_refinement_that_was_stopped_matches_only_the_rest(stroll, tmp_path, monkeypatch):
    start, match, matched = bent(stroll.truth), _Sweep._match_one, []
    settings = tuned_by(rounds=2)
    whole, rounds = refined(stroll, start, settings=settings)
    stop_after = len(stroll) + 11  # in the second round

    def counted(sweep, planes, row):
        if len(matched) == stop_after:
            raise Cancelled("enough")
        matched.append(row)
        return match(sweep, planes, row)

    def run():
        with keeping(tmp_path, "refine", "key"):
            return refined(stroll, start, settings=settings)

    monkeypatch.setattr(_Sweep, "_match_one", counted)
    with pytest.raises(Cancelled):
        run()
    stop_after = -1
    again, rounds_again = run()

    assert len(matched) == len(rounds) * len(stroll)
    assert rounds_again == rounds
    np.testing.assert_array_equal(again.T_a_b.t, whole.T_a_b.t)
    np.testing.assert_array_equal(again.T_a_b.R, whole.T_a_b.R)
