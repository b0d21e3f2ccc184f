"""The verdict on a 2-D map names what nothing confirms."""

from dataclasses import replace

import numpy as np
import pytest
from msgspec.structs import replace as replace_struct

from recon4.findings.verdict import verdict_of
from recon4.findings.witnesses.planar import PlanarRecord, check_planar
from recon4.findings.wording import text_of
from recon4.model.figures import Map2dFigures, Odometry2dFigures, Scan2dFigures
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import ImportNotes
from recon4.model.pose_graph import EdgeKind, Verdict, known_judgment
from recon4.model.trajectory import Trajectory
from recon4.model.usability import Usability
from recon4.recording.report import warning
from recon4.slam2d.steps import empty_steps
from tests.project_builder import loop_walk, verified_graph


def of_kind(record, kind):
    return [one for one in check_planar(record) if one.kind is kind]


def facts(verdict):
    """A map without fault whose loop closures all have one verdict."""
    graph = verified_graph(loop_walk())
    edges = tuple(
        edge.judged(known_judgment(verdict)) if edge.kind is EdgeKind.LOOP else edge
        for edge in graph.edges
    )
    steps = empty_steps(graph.t_ns)
    return PlanarRecord(
        scans=Scan2dFigures(scans=len(graph), beams=360, odometry=True),
        imported=ImportNotes(),
        odometry=Odometry2dFigures(scans=len(graph), lost=0, keyframes=9, searched=0, resets=0),
        map=Map2dFigures(
            cell_m=0.05, size=(10, 10), free_m2=1.0, crossing_ratio=0.0, largest_sd_m=0.01
        ),
        steps=replace(steps, weak_sd_m=np.zeros(len(graph))),
        trajectory=Trajectory(graph.t_ns, graph.T_map_body),
        graph=graph.with_edges(edges),
        path_length_m=20.0,
    )


@pytest.mark.parametrize(
    ("verdict", "said"), [(Verdict.ACCEPTED, False), (Verdict.UNVERIFIED, True)]
)
def test_loop_closures_that_no_alternative_path_confirms_are_said_beside_a_good_verdict(
    verdict, said
):
    found = check_planar(facts(verdict))

    assert verdict_of(found).usability is Usability.GOOD
    notes = [one for one in found if one.kind is FindingKind.LOOPS_UNVERIFIED]
    assert [one.level for one in notes] == ([Level.NOTE] if said else [])


@pytest.mark.parametrize(("tilt_deg", "level"), [(5.0, Level.CHECK), (40.0, Level.DO_NOT_USE)])
def test_what_readers_say_of_the_mount_counts_and_the_rest_are_notes(tilt_deg, level):
    said = (warning(FindingKind.SCANS_LATE, scans=3), warning(FindingKind.LASER_TILTED))
    record = facts(Verdict.ACCEPTED)
    record = replace(
        record,
        imported=ImportNotes(findings=said),
        scans=replace_struct(record.scans, tilt_deg=tilt_deg),
    )

    assert [one.level for one in of_kind(record, FindingKind.SCANS_LATE)] == [Level.NOTE]
    assert [one.level for one in of_kind(record, FindingKind.LASER_TILTED)] == [level]


@pytest.mark.parametrize(
    ("mount", "tilt_deg", "level"),
    [
        ("", 0.0, Level.NOTE),
        ("the rig file: roll 180°", 0.0, Level.CHECK),
        ("the rig file: roll 140°", 40.0, Level.DO_NOT_USE),
    ],
)
def test_scans_that_had_to_be_mirrored_contradict_a_stated_mount(mount, tilt_deg, level):
    record = facts(Verdict.ACCEPTED)
    scans = replace_struct(record.scans, mirrored=True, mount=mount, tilt_deg=tilt_deg)

    (found,) = of_kind(replace(record, scans=scans), FindingKind.BEAM_ORDER)

    assert found.level is level
    assert ("contradicts" in text_of(found)) == bool(mount) and mount in text_of(found)
    assert not of_kind(record, FindingKind.BEAM_ORDER)


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"by_rig": "0 0 0.3 3.141593 0 0"}, "the rig file: xyz 0.000 0.000 0.300 m, roll 180.0"),
        (
            {
                "by_recording": "0 0 1 0 0 0",
                "parent": "base_link",
                "child": "laser",
                "sources": "tf",
            },
            "the recording: xyz 0.000 0.000 1.000 m, roll 0.0 pitch 0.0 yaw 0.0° "
            "(base_link -> laser, tf)",
        ),
    ],
)
def test_who_states_the_mount_of_mirrored_scans_is_said_with_its_numbers(values, said):
    record = facts(Verdict.ACCEPTED)
    scans = replace_struct(record.scans, mirrored=True, stated=values)

    (found,) = of_kind(replace(record, scans=scans), FindingKind.BEAM_ORDER)

    assert found.level is Level.CHECK
    assert f"This contradicts {said}" in text_of(found)


@pytest.mark.parametrize(
    ("odometry", "level", "said"), [(True, Level.NOTE, "says how"), (False, Level.CHECK, "unknown")]
)
def test_a_silent_laser_is_worse_where_no_odometry_says_how_it_moved(odometry, level, said):
    record = facts(Verdict.ACCEPTED)
    t_ns = record.steps.t_ns.copy()
    t_ns[5:] += 7_000_000_000
    silent = replace(
        record,
        steps=replace(record.steps, t_ns=t_ns),
        scans=replace_struct(record.scans, odometry=odometry),
    )

    (found,) = of_kind(silent, FindingKind.SCANS_SILENT)

    assert found.level is level and said in text_of(found)
    assert f"{(t_ns[4] - t_ns[0]) / 1e9:.1f} s after the start" in text_of(found)
