from dataclasses import replace

import numpy as np
import pytest

from recon4.geometry.se3 import SE3
from recon4.georeference.crs import GeodeticOrigin, to_enu, to_geodetic
from recon4.georeference.gnss import GeoreferenceResult, georeference
from recon4.georeference.gnss_priors import usable_gnss_priors
from recon4.georeference.tuning import GnssTuning
from recon4.model.local_frame import LocalReason
from recon4.model.pose_graph import (
    AUTOMATIC,
    Edge,
    EdgeKind,
    Judge,
    Measure,
    PoseGraph,
    Reason,
    Verdict,
    known_history,
    known_judgment,
)
from recon4.model.rig import load_rig
from recon4.model.samples import GnssQuality, GnssSamples
from recon4.model.trajectory import Trajectory

LOOPS = 25
PLACE = GeodeticOrigin(np.deg2rad(49.2), np.deg2rad(16.6), 250.0)
RIG = replace(load_rig("4recon"), p_body_antenna=np.array([-0.3, 0.1, 0.8]))
START = SE3.from_rpy(0.0, 0.0, 2.2, t=[40.0, -15.0, 3.0])
"""T_odom_enu: the map's own frame is level, but turned and shifted."""


def track(seconds: float, *, straight: bool = False) -> Trajectory:
    """True poses in ENU at 10 Hz: 1.3 m/s through a field."""
    t = np.arange(0.0, seconds, 0.1)
    yaw = 0.3 * np.ones_like(t) if straight else 1.2 * np.sin(0.02 * t) + 0.2 * np.sin(0.3 * t)
    step = 0.13 * np.stack([np.cos(yaw), np.sin(yaw), 0.02 * np.sin(0.01 * t)], 1)
    T = SE3.stack(
        SE3.from_rpy(0.04 * np.sin(3 * a), 0.03, b, t=c)
        for a, b, c in zip(t, yaw, np.cumsum(step, axis=0), strict=True)
    )
    return Trajectory((t * 1e9).astype(np.int64) + 10**18, T)


def slam(true: Trajectory, rng: np.random.Generator) -> tuple[PoseGraph, Trajectory]:
    """A drifting graph with a node each second, and the dense odometry it came from."""
    sd = np.array([1e-4, 1e-4, 1e-4, 1e-3, 1e-3, 1e-3])
    steps = (
        true.T_a_b[:-1].inverse()
        @ true.T_a_b[1:]
        @ SE3.exp(sd * rng.normal(size=(len(true) - 1, 6)))
    )
    poses = [START @ true.T_a_b[0]]
    for k in range(len(steps)):
        poses.append(poses[-1] @ steps[k])
    dense = Trajectory(true.t_ns, SE3.stack(poses))
    rows = np.arange(0, len(true), 10)
    T = dense.T_a_b[rows]
    edges = []
    for d in (1, 2, 4):
        for k in range(len(rows) - d):
            kind = EdgeKind.ODOMETRY if d == 1 else EdgeKind.NEIGHBOR
            information = np.diag(1.0 / (sd**2 * 10 * d))
            edges.append(
                Edge(
                    i=k,
                    j=k + d,
                    T_i_j=T[k].inverse() @ T[k + d],
                    kind=kind,
                    information=information,
                    judgments=known_history(Verdict.ACCEPTED),
                )
            )
    return PoseGraph(rows, dense.t_ns[rows], T, tuple(edges)), dense


def receiver(true: Trajectory, rng: np.random.Generator, *, sd_m: float = 0.02) -> GnssSamples:
    """Fixes at 5 Hz, off the frame grid, errors correlated over some 10 s."""
    t_ns = true.t_ns[0] + np.arange(30_000_000, int(true.t_ns[-1] - true.t_ns[0]), 200_000_000)
    T = true.at(t_ns)
    slow = np.zeros((len(t_ns), 3))
    keep = np.exp(-0.2 / 10.0)
    for k in range(1, len(slow)):
        slow[k] = keep * slow[k - 1] + np.sqrt(1 - keep**2) * sd_m * rng.normal(size=3)
    p = T @ np.tile(RIG.p_body_antenna, (len(t_ns), 1)) + slow
    lat, lon, height = to_geodetic(PLACE, p)
    n = len(t_ns)
    return GnssSamples(
        t_ns,
        lat,
        lon,
        height,
        np.full((n, 3), sd_m),
        np.full(n, 4, dtype=np.uint8),
        np.full((n, 3), np.nan),
    )


def worst_m(result: GeoreferenceResult, true: Trajectory) -> float:
    """Largest error of a node on earth."""
    assert result.origin is not None
    lat, lon, height = to_geodetic(result.origin, result.graph.T_map_body.t)
    p = to_enu(PLACE, lat, lon, ellipsoidal_height_m=height)
    return float(np.linalg.norm(p - true.at(result.graph.t_ns).t, axis=1).max())


def run(true: Trajectory, gnss: GnssSamples | None, **changes: object) -> GeoreferenceResult:
    graph, dense = slam(true, np.random.default_rng(1))
    settings = GnssTuning(**changes)  # type: ignore[arg-type]
    return georeference(graph, dense, gnss, rig=RIG, settings=settings)


@pytest.fixture(scope="module")
def true() -> Trajectory:
    return track(240.0)


@pytest.fixture(scope="module")
def gnss(true: Trajectory) -> GnssSamples:
    return receiver(true, np.random.default_rng(2))


def test_a_drifting_walk_is_aligned_with_its_positions(true: Trajectory, gnss: GnssSamples) -> None:
    result = run(true, gnss)

    assert worst_m(result, true) < 0.08
    assert result.used.mean() > 0.98
    assert np.all(result.rmse_m < 0.04)
    assert result.local is None


def test_exact_positions_pull_a_drifting_walk_to_the_truth(true: Trajectory) -> None:
    exact = receiver(true, np.random.default_rng(3), sd_m=0.0)
    exact.sd_enu_m[:] = 0.02

    result = run(true, exact)

    # The rest is drift of the edges, which are overconfident.
    assert worst_m(result, true) < 0.06


def test_the_lever_arm_matters(true: Trajectory, gnss: GnssSamples) -> None:
    graph, dense = slam(true, np.random.default_rng(1))
    bare = replace(RIG, p_body_antenna=np.zeros(3))

    result = georeference(graph, dense, gnss, rig=bare, settings=GnssTuning())

    assert worst_m(result, true) > 0.5


def test_outliers_of_every_kind_are_excluded(true: Trajectory, gnss: GnssSamples) -> None:
    rng = np.random.default_rng(4)
    bad = gnss.take(np.arange(len(gnss)))
    single = rng.choice(len(gnss), 60, replace=False)
    bad.lat_rad[single] += rng.normal(0, 50, 60) / 6.4e6
    bad.lon_rad[400:450] += 8.0 / 4.2e6  # ten seconds of multipath
    bad.height_m[700:730] += 3.0
    bad.lat_rad[900:930], bad.lon_rad[900:930] = bad.lat_rad[900], bad.lon_rad[900]  # frozen
    bad.quality[1000:1050] = 0
    bad.lat_rad[1000:1050] = 0.1

    result = run(true, bad)

    assert worst_m(result, true) < 0.08
    wrong = np.isin(result.t_ns, np.r_[bad.t_ns[400:450], bad.t_ns[700:730]])
    assert not result.used[wrong].any()
    assert not np.isin(result.t_ns, bad.t_ns[1000:1050]).any()
    assert not np.isin(result.t_ns, bad.t_ns[910:930]).any()  # frozen: not even looked at


def test_a_gap_of_a_minute_costs_little(true: Trajectory, gnss: GnssSamples) -> None:
    s = (gnss.t_ns - gnss.t_ns[0]) / 1e9
    whole = run(true, gnss)

    result = run(true, gnss.take(np.flatnonzero((s < 90) | (s > 150))))

    assert worst_m(result, true) < max(1.5 * worst_m(whole, true), 0.08)


def test_float_and_single_fixes_weigh_less_than_fixed_ones(true: Trajectory) -> None:
    good, poor = (
        receiver(true, np.random.default_rng(k), sd_m=sd) for k, sd in ((5, 0.02), (6, 1.5))
    )
    mixed = good.take(np.arange(len(good)))
    rows = np.arange(400, 700)
    for name in ("lat_rad", "lon_rad", "height_m"):
        getattr(mixed, name)[rows] = getattr(poor, name)[rows]
    mixed.sd_enu_m[:] = np.nan
    mixed.quality[rows] = 1

    result = run(true, mixed)

    assert worst_m(result, true) < 0.1


def test_fixes_below_the_smallest_quality_are_not_used(true: Trajectory) -> None:
    gnss = receiver(true, np.random.default_rng(5), sd_m=0.02)
    gnss.quality[::2] = GnssQuality.SINGLE
    graph, dense = slam(true, np.random.default_rng(1))

    every, fixed = (
        usable_gnss_priors(graph, dense, gnss, rig=RIG, settings=settings)[0]
        for settings in (GnssTuning(), GnssTuning(min_quality="fixed"))
    )

    assert (gnss.quality[every.row] == GnssQuality.SINGLE).any()
    assert (gnss.quality[fixed.row] == GnssQuality.RTK_FIXED).all()
    assert len(fixed.row) > 10


def test_a_straight_line_does_not_roll() -> None:
    line = track(120.0, straight=True)

    result = run(line, receiver(line, np.random.default_rng(7)))

    assert result.origin is not None
    up = result.graph.T_map_body.R[:, 2, :]
    tilt = np.arccos(np.clip(np.sum(up * line.at(result.graph.t_ns).R[:, 2, :], axis=1), -1, 1))
    assert np.rad2deg(tilt.max()) < 0.5
    assert worst_m(result, line) < 0.08


def soft(graph: PoseGraph) -> PoseGraph:
    """A walk with twenty times the standard deviation: consistent loops dominate its edges."""
    return graph.with_edges(
        tuple(edge.evolve(information=edge.information / 400.0) for edge in graph.edges)
    )


def with_loops(
    graph: PoseGraph, true: Trajectory, *, shift_m: float, decided_by: str = AUTOMATIC
) -> PoseGraph:
    """25 loops from the end back to the beginning; all are wrong by one shift of the end."""
    T = true.at(graph.t_ns)
    T_moved = SE3(T.R, T.t + np.array([shift_m, 0.0, 0.0]))
    loops = []
    for k in range(LOOPS):
        j = len(graph) - LOOPS + k
        loops.append(
            Edge(
                i=k,
                j=j,
                T_i_j=T[k].inverse() @ T_moved[j],
                kind=EdgeKind.LOOP,
                information=np.diag([1e6] * 3 + [1e4] * 3),
                judgments=known_history(Verdict.ACCEPTED, decided_by=decided_by),
            )
        )
    return graph.with_edges((*graph.edges, *loops))


@pytest.mark.parametrize(("shift_m", "kept"), [(0.0, LOOPS), (1.0, 0)])
def test_the_positions_decide_which_loops_are_rejected(
    true: Trajectory, gnss: GnssSamples, shift_m: float, kept: int
) -> None:
    graph, dense = slam(true, np.random.default_rng(1))
    graph = with_loops(soft(graph), true, shift_m=shift_m)
    unregistered = (
        graph.edges[0]
        .evolve(j=50, kind=EdgeKind.LOOP)
        .judged(known_judgment(Verdict.REJECTED, Reason.OVERLAP))
    )
    graph = graph.with_edges((unregistered, *graph.edges))

    result = georeference(graph, dense, gnss, rig=RIG, settings=GnssTuning())

    assert result.graph.edges[0].reason is Reason.OVERLAP
    loops = result.graph.edges[-LOOPS:]
    assert sum(edge.in_graph for edge in loops) == kept
    assert all(edge.reason is Reason.ROBUST for edge in loops if not edge.in_graph)
    for edge in loops:
        if not edge.in_graph:
            first, last = edge.judgments
            assert (first.by, first.verdict) == (Judge.SEARCH, Verdict.ACCEPTED)
            assert (last.by, last.verdict, last.measure) == (
                Judge.GNSS, Verdict.REJECTED, Measure.CHI2,
            )  # fmt: skip
            assert last.value > last.limit
    assert len(result.rejected) == LOOPS - kept
    assert result.record().edges_rejected == list(result.rejected)
    assert worst_m(result, true) < 0.15
    assert result.used.mean() > 0.98


@pytest.mark.parametrize(("person", "judge_edges"), [("Ada", True), (AUTOMATIC, False)])
def test_positions_reject_no_decision_of_a_person_and_nothing_when_off(
    true: Trajectory, gnss: GnssSamples, person: str, judge_edges: bool
) -> None:
    graph, dense = slam(true, np.random.default_rng(1))
    graph = with_loops(graph, true, shift_m=1.0, decided_by=person)
    settings = GnssTuning(judge_edges=judge_edges)

    result = georeference(graph, dense, gnss, rig=RIG, settings=settings)

    assert result.rejected == ()
    assert all(edge.in_graph for edge in result.graph.edges)


@pytest.mark.parametrize("kept", [0, 3])
def test_with_too_few_fixes_the_map_is_not_georeferenced(
    true: Trajectory, gnss: GnssSamples, kept: int
) -> None:
    graph, dense = slam(true, np.random.default_rng(1))

    result = georeference(graph, dense, gnss.take(np.arange(kept)), rig=RIG, settings=GnssTuning())

    assert result.origin is None
    assert result.local is not None
    assert result.local.reason is LocalReason.FEW_FIXES
    assert (result.local.fixes, result.local.fixes_usable) == (kept, kept)
    assert result.graph is graph
    assert result.record().georeferenced is False


def test_a_stationary_receiver_gives_no_heading_and_a_reason(
    true: Trajectory, gnss: GnssSamples
) -> None:
    result = run(true, gnss.take(np.arange(8)))

    assert result.origin is None
    assert result.local is not None
    assert result.local.reason is LocalReason.NO_AGREEMENT
    assert result.local.extent_m < 1.0
    assert result.local.beside_m is None


def test_fixes_that_contradict_the_trajectory_are_said_with_their_distance(
    true: Trajectory, gnss: GnssSamples
) -> None:
    shuffled = np.random.default_rng(3).permutation(len(gnss))
    elsewhere = replace(gnss, lat_rad=gnss.lat_rad[shuffled], lon_rad=gnss.lon_rad[shuffled])

    result = run(true, elsewhere, gate_relative=0.0)

    assert result.origin is None
    assert result.local is not None
    assert result.local.fixes_usable == len(gnss)
    assert result.local.beside_m > 50.0


def test_no_receiver_and_switched_off_are_named(true: Trajectory, gnss: GnssSamples) -> None:
    assert run(true, None).record().reason is LocalReason.NO_GNSS
    assert run(true, gnss, enabled=False).record().reason is LocalReason.SWITCHED_OFF


def test_the_same_input_gives_the_same_bits(true: Trajectory, gnss: GnssSamples) -> None:
    first, second = run(true, gnss), run(true, gnss)

    np.testing.assert_array_equal(first.graph.T_map_body.t, second.graph.T_map_body.t)
