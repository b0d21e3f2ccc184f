"""Kinds that accused maps that were right, or were silent of one that was not."""

import json
from dataclasses import replace

import msgspec
import numpy as np
import pytest
from msgspec import structs

from recon4.findings.audit import check_walk
from recon4.findings.walk_record import WalkRecord
from recon4.findings.wording import text_of
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import ImuChoice, LineFigures, OdometryFigures
from recon4.model.pose_graph import EdgeKind, PoseGraph, Verdict, known_history
from recon4.recording.report import warning
from tests.unit.findings.test_known_shape import FLAT, stated
from tests.unit.pose_graph.test_uncertainty import chain, edge


def only(walked, kind):
    (found,) = (one for one in check_walk(walked) if one.kind is kind)
    return found


def unverified() -> PoseGraph:
    graph = chain(20)
    open_loop = edge(graph.T_map_body, 0, 19, EdgeKind.LOOP, 0.01 * np.ones(6))
    loop = structs.replace(open_loop, judgments=known_history(Verdict.UNVERIFIED))
    return replace(graph, edges=(*graph.edges, loop))


@pytest.mark.parametrize(("sd", "level"), [(FLAT, Level.NOTE), (10 * FLAT, Level.CHECK)])
def test_an_unverified_loop_is_a_fault_only_where_the_map_is_not_known_without_it(sd, level):
    walked = replace(stated(sd, 0.1, on_earth=False), graph=unverified())

    assert only(walked, FindingKind.LOOPS_UNVERIFIED).level is level


@pytest.mark.parametrize(
    ("outcome", "level"),
    [("as recorded", Level.NOTE), ("not used", Level.CHECK), (None, Level.CHECK)],
    ids=["LiDARs see the same turns", "LiDARs contradict it", "no LiDAR was compared"],
)
def test_a_unit_of_the_gyroscope_that_its_samples_leave_open_is_settled_by_lidars(outcome, level):
    choice = None if outcome is None else ImuChoice(outcome=outcome)
    figures = OdometryFigures(multiframes=9, lost=0, imu=outcome is not None, imu_choice=choice)
    walked = WalkRecord(imported={"counts": {"imu_gyro_assumed": 9}}, odometry_figures=figures)

    found = only(walked, FindingKind.IMU_UNIT)
    assert found.level is level
    assert "ingest.imu_gyro_unit=deg_s" in text_of(found)


@pytest.mark.parametrize(
    ("offset_m", "converged", "level"),
    [(0.14, False, Level.CHECK), (0.03, False, None), (0.29, True, None)],
    ids=["far and stopped", "near and stopped", "far and converged"],
)
def test_one_multiframe_that_did_not_converge_counts_if_it_is_far_from_where_it_was_expected(
    offset_m, converged, level
):
    flags = {name: np.zeros(40, bool) for name in ("lost", "stationary", "bridged")}
    offsets = np.full(40, 0.05)
    offsets[39] = offset_m
    done = np.ones(40, bool)
    done[[0, 39]] = False, converged
    steps = flags | {"converged": done, "prediction_offset_m": offsets}
    steps |= {"t_mid_ns": np.arange(40) * 10**8, "t_m": np.zeros((40, 3))}

    found = check_walk(WalkRecord(steps=steps))

    levels = [one.level for one in found if one.kind is FindingKind.NOT_CONVERGED]
    assert levels == ([] if level is None else [level])
    assert all(
        "lies 14.0 cm from where" in text_of(one) and one.span_s == (3.9, 3.9)
        for one in found
        if one.kind is FindingKind.NOT_CONVERGED
    )


def test_a_weak_direction_of_unknown_size_is_stored():
    steps = {"lost": np.zeros(40, bool), "degeneracy": np.zeros(40)}
    steps |= {"t_mid_ns": np.arange(40) * 10**8, "t_m": np.zeros((40, 3))}

    found = check_walk(WalkRecord(steps=steps))

    weak = [one for one in found if one.kind is FindingKind.WEAK_DIRECTION]
    assert len(weak) == 1 and "degeneracy 0.0000" in text_of(weak[0])
    json.dumps([one.values for one in found], allow_nan=False)


@pytest.mark.parametrize(
    ("rest_s", "kinds"),
    [
        (9.9, {FindingKind.LASER_MISSING: Level.NOTE}),
        (5.0, {FindingKind.LASER_MISSING: Level.CHECK, FindingKind.LOOPS_NONE: Level.CHECK}),
    ],
    ids=["stands", "walks"],
)
def test_a_profiler_without_a_laser_that_stands_needs_neither_loop_nor_laser(rest_s, kinds):
    lines = LineFigures(walk_s=10.0, laser="none", rest_s=rest_s)
    said = msgspec.to_builtins(warning(FindingKind.LASER_NOT_IN_RIG))
    walked = WalkRecord(
        imported={"findings": [said]},
        odometry_figures=OdometryFigures(multiframes=9, lost=0, imu=True, lines=lines),
        graph=chain(20),
    )

    found = {one.kind: one.level for one in check_walk(walked)}
    asked = kinds.keys() | {FindingKind.LOOPS_NONE, FindingKind.LASER_NOT_IN_RIG}
    assert {kind: found[kind] for kind in asked & found.keys()} == kinds
