"""The quality report, from real artifacts of a small made-up run."""

import json
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from recon4.errors import StoreError
from recon4.evaluation.evaluate import evaluate
from recon4.findings.drift import drift_closed
from recon4.geometry.se3 import SE3
from recon4.mapping.tile_writer import TileWriter
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.pose_graph import Edge, EdgeKind, PoseGraph, Reason, Verdict, known_history
from recon4.model.rig import RigCalibration, load_rig
from recon4.model.rig_origin import RigOrigin
from recon4.model.trajectory import Trajectory
from recon4.pose_graph.files import save_graph
from recon4.report.assessment import assess
from recon4.report.edges import edge_rows, spanning
from recon4.report.facts import InputFile, ReportFacts, StageTiming
from recon4.report.html import changed_settings, render, write_report
from recon4.settings import override, preset
from recon4.store.arrays import save_trajectory

EVIL = "<script>alert('x')</script><img src=http://evil.example/a onerror=alert(1)>\"'{{ 7 * 7 }}"
DERIVED = ["earlier ring", {"kind": "INTENSITY-SCALED", "values": {"where": "front"}}]
STEP_NS = 100_000_000


class Tags(HTMLParser):
    """Collects the tags, attributes and text of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.text = ""
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]

    def handle_data(self, data: str) -> None:
        self.text += data


def loop_walk(n: int = 200, *, drift_m: float = 0.0) -> Trajectory:
    s = np.linspace(0.0, 2 * np.pi, n)
    places = np.stack([4 * np.cos(s), 3 * np.sin(s), 1.5 + 0 * s], axis=1)
    places[:, 0] += drift_m * np.linspace(0.0, 1.0, n)
    twists = np.zeros((n, 6))
    twists[:, 2] = s
    return Trajectory(np.arange(n, dtype=np.int64) * STEP_NS, SE3(SE3.exp(twists).R, places))


def edge(
    walk: Trajectory, i: int, j: int, kind: EdgeKind, verdict: Verdict, **facts: object
) -> Edge:
    T_i_j = walk.T_a_b[10 * i].inverse() @ walk.T_a_b[10 * j]
    judgments = known_history(verdict, facts.pop("reason", Reason.NONE))
    return Edge(i=i, j=j, T_i_j=T_i_j, kind=kind, judgments=judgments, **facts)


def graph_of(walk: Trajectory) -> PoseGraph:
    odometry = [edge(walk, k, k + 1, EdgeKind.ODOMETRY, Verdict.ACCEPTED) for k in range(19)]
    good = {"error_m": 0.02, "limit_m": 0.1, "overlap": 0.8, "verification_m": 0.01}
    bad = {"reason": Reason.VERIFICATION, "verification_m": 0.4}
    loops = [
        edge(walk, 0, 19, EdgeKind.LOOP, Verdict.ACCEPTED, **good),
        edge(walk, 1, 18, EdgeKind.LOOP, Verdict.UNVERIFIED, error_m=0.03, limit_m=0.1),
        edge(walk, 2, 9, EdgeKind.LOOP, Verdict.REJECTED, reason=Reason.OVERLAP, overlap=0.1),
        edge(walk, 3, 12, EdgeKind.LOOP, Verdict.REJECTED, **bad),
    ]
    rows = np.arange(20)
    return PoseGraph(rows * 10, walk.t_ns[rows * 10], walk.T_a_b[rows * 10], (*odometry, *loops))


def write_map(folder: Path) -> None:
    rng = np.random.default_rng(0)
    n = 20_000
    xyz = rng.uniform([-6, -5, 0], [6, 5, 3], (n, 3)).astype(np.float32)
    xyz[: n // 2, 1] = np.sign(xyz[: n // 2, 1]) * 5
    columns = {
        "xyz": xyz,
        "intensity": rng.integers(0, 100, n).astype(np.uint16),
        "intensity_normalized": rng.uniform(0, 100, n).astype(np.float32),
        "t_ns": np.arange(n, dtype=np.int64),
    }
    folder.mkdir()
    with TileWriter(folder, list(columns), tile_m=20.0) as writer:
        writer.append((0, 0, 0), columns)


def made_facts(folder: Path) -> ReportFacts:
    folders = {
        name: folder / name for name in ("frames", "odometry", "verification", "level", "intensity")
    }
    for one in folders.values():
        one.mkdir()
    write_map(folder / "map")
    truth = loop_walk()
    save_trajectory(folders["odometry"] / "trajectory.npz", loop_walk(drift_m=0.5))
    save_trajectory(folders["level"] / "trajectory.npz", truth)
    save_graph(folders["verification"], graph_of(truth))
    np.savez(
        folders["odometry"] / "steps.npz",
        t_mid_ns=truth.t_ns,
        error_m=np.full(200, 0.01),
        share=np.full(200, 0.9),
        lost=np.zeros(200, dtype=bool),
    )
    counts = {"points": 5_000_000}
    imported = {"outcome": "lossy", "warnings": [EVIL], "derived": DERIVED, "counts": counts}
    (folders["frames"] / "report.json").write_text(json.dumps(imported))
    placed = {
        "georeferenced": True,
        "t_ns": [k * 10**9 for k in range(9)],
        "residual_enu_m": [[0.01, -0.02, 0.03]] * 9,
        "used": [True] * 9,
    }
    (folders["level"] / "georeference.json").write_text(json.dumps({"georeference": placed}))
    np.savez(
        folders["intensity"] / "diagnostics.npz",
        channel_count=np.full(32, 1000),
        channel_before=np.stack([np.linspace(20, 60, 32), np.ones(32)]),
        channel_after=np.stack([np.full(32, 40.0), np.ones(32)]),
        channel_same_count=np.full(32, 500),
        channel_same=np.stack([np.linspace(0.8, 1.2, 32), np.ones(32)]),
    )
    return ReportFacts(
        title="office walk",
        created="2026-11-21T10:00:00Z",
        preset="indoor",
        settings=override(preset("indoor"), ["map.voxel_m=0.05"]),
        artifacts=folders | {"map": folder / "map"},
        stages=(
            StageTiming("frames", 2.0, 3.0, 200_000_000),
            StageTiming("map", 8.0, 9.0, 900_000_000),
        ),
        inputs=(InputFile("walk.pcap", 1_234_567, "ab" * 32),),
        versions={"recon4": "0.1.0", "python": "3.11"},
    )


@pytest.fixture
def facts(tmp_path: Path) -> ReportFacts:
    """Those of a run whose points are not drawn."""
    facts = made_facts(tmp_path)
    for drawn in ("map", "intensity"):
        del facts.artifacts[drawn]
    return facts


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> tuple[ReportFacts, str]:
    """Facts and their report, which tests only read."""
    facts = made_facts(tmp_path_factory.mktemp("facts"))
    return facts, render(assess(facts))


def test_the_report_says_what_was_found(page: tuple[ReportFacts, str]) -> None:
    text = Tags(page[1]).text

    for words in (
        "office walk",
        "Check this map",
        "Tracking was not lost in any of 200 multiframes.",
        "1 loop closures accepted.",
        "no pose by more than 50.0 cm",
        "The recording was read as: lossy.",
        "5\u202f000\u202f000",
        "local map frame, z up (meters)",
        "map.voxel_m",
        "ab" * 32,
        "900.0 MB",
        "path discrepancy > 10 cm",
        "rejected automatically",
        "Residuals of the 9 fixes used as GNSS priors; 0 were not used.",
        "deviation was 11.91 and is 0.00",
        "deviation falls from 11.9 % to 0.0 %",
        "earlier ring",
        "front: intensity 0..1 is stored times 255.",
    ):
        assert words in text, words


def test_names_and_texts_from_files_are_shown_as_text(facts: ReportFacts) -> None:
    inputs = (InputFile(EVIL, 1, "0"),)
    hostile = replace(
        facts, title=EVIL, rig=EVIL, crs=EVIL, inputs=inputs, created=EVIL,
        versions={EVIL: EVIL}, stages=(StageTiming(EVIL, 1.0, 1.0, 1),),
    )  # fmt: skip

    page = Tags(render(assess(hostile)))

    assert "script" not in page.tags
    assert "img" not in page.tags
    assert not [name for name, _ in page.attributes if name.startswith("on")]
    assert page.text.count("alert('x')") >= 8
    assert "49" not in page.text.split("alert('x')")[1][:80]


def test_the_page_asks_nothing_of_the_network(page: tuple[ReportFacts, str]) -> None:
    _, text = page
    found = Tags(text)

    assert not {"script", "link", "iframe", "object", "embed", "form"} & set(found.tags)
    sources = [v for name, v in found.attributes if name in {"src", "href", "xlink:href", "action"}]
    assert sources
    assert all(value.startswith(("data:image/png;base64,", "#")) for value in sources)
    assert "https://" not in text


def test_the_same_facts_give_the_same_page(page: tuple[ReportFacts, str]) -> None:
    facts, text = page
    assert render(assess(facts)) == text


def test_lost_tracking_is_the_first_thing_said(facts: ReportFacts, tmp_path: Path) -> None:
    lost = np.zeros(200, dtype=bool)
    lost[50:60] = True
    np.savez(tmp_path / "odometry" / "steps.npz", t_mid_ns=loop_walk().t_ns, lost=lost)

    text = Tags(render(assess(facts))).text

    assert "Do not use this map" in text
    assert "lost in 10 of 200 multiframes (5.0 %), first 5.0 s after the start" in text


def test_no_accepted_loop_is_a_warning(facts: ReportFacts, tmp_path: Path) -> None:
    graph = graph_of(loop_walk())
    save_graph(tmp_path / "verification", graph.with_edges(graph.edges[:19]))

    text = render(assess(facts))
    assert "No loop closure was accepted" in text
    assert "largest correction" in text
    assert "largest drift corrected" not in text


def test_a_recording_of_one_place_has_no_empty_table_of_pairs(
    facts: ReportFacts, tmp_path: Path
) -> None:
    graph = graph_of(loop_walk())
    save_graph(tmp_path / "verification", graph.with_edges(()))

    text = Tags(render(assess(facts))).text

    assert "None: the recording has too few nodes for a pair." in text
    assert "verdict" not in text.split("Loop closures and odometry edges")[1].split("Positions")[0]


def test_a_report_without_any_artifact_can_still_be_written(
    facts: ReportFacts, tmp_path: Path
) -> None:
    bare = replace(facts, artifacts={}, stages=(), inputs=(), versions={})

    write_report(tmp_path / "report.html", assess(bare))

    assert "The run has no results to assess." in (tmp_path / "report.html").read_text("utf-8")


def test_a_map_without_points_has_no_charts_of_it(facts: ReportFacts, tmp_path: Path) -> None:
    empty = tmp_path / "empty"
    empty.mkdir()
    with TileWriter(empty, ["xyz", "intensity"], tile_m=10.0):
        pass

    assert "<image" not in render(assess(replace(facts, artifacts={"map": empty})))


def test_a_damaged_artifact_is_refused_by_name(facts: ReportFacts, tmp_path: Path) -> None:
    (tmp_path / "level" / "georeference.json").write_text("{")

    with pytest.raises(StoreError, match=r"level/georeference\.json"):
        render(assess(facts))


def test_a_name_that_is_not_text_does_not_stop_the_report(
    facts: ReportFacts, tmp_path: Path
) -> None:
    inputs = (InputFile(b"walk-\xff.pcap".decode("utf-8", "surrogateescape"), 1, "0"),)

    write_report(tmp_path / "r.html", assess(replace(facts, inputs=inputs)))

    assert "walk-?.pcap" in (tmp_path / "r.html").read_text("utf-8")


def test_an_evaluation_is_shown_with_its_figures(facts: ReportFacts, tmp_path: Path) -> None:
    walk, truth = (tmp_path / name / "trajectory.npz" for name in ("level", "odometry"))
    found = evaluate(walk, truth=truth)

    text = Tags(render(assess(replace(facts, evaluation=found)))).text

    assert "Accuracy against ground truth" in text
    assert f"{100 * found.aligned.position_m.rmse:.2f}" in text


def test_only_settings_that_differ_from_the_preset_are_listed() -> None:
    changed = changed_settings(override(preset("indoor"), ["map.voxel_m=0.05"]), "indoor")

    assert changed == [("map.voxel_m", "0.01", "0.05")]


def test_drift_is_the_distance_after_the_first_poses_were_made_equal() -> None:
    turned = SE3.from_rpy(0.1, 0.2, 0.3, t=[5, 6, 7])
    odometry = Trajectory(loop_walk().t_ns, turned @ loop_walk(drift_m=0.5).T_a_b)

    drift = drift_closed(odometry, loop_walk(), graph_of(loop_walk()))

    assert drift is not None
    assert drift.end_m == pytest.approx(0.5)
    assert drift.loop_before_m == pytest.approx([0.5 * 190 / 199], abs=1e-9)
    assert drift.loop_after_m == pytest.approx([0.0], abs=1e-9)


def test_edges_are_counted_by_verdict_reason_and_kind() -> None:
    rows = {(row.verdict, row.reason): row for row in edge_rows(graph_of(loop_walk()), limit_m=0.1)}

    assert rows["accepted", ""].counts[0] == 19
    assert rows["rejected automatically", "overlap < t_o"].total == 1
    assert sum(row.total for row in rows.values()) == 23


def test_every_step_knows_how_many_edges_span_it() -> None:
    spans = spanning(graph_of(loop_walk()))

    # odometry everywhere, the loop 0-19 everywhere, the unverified 1-18 all but at the ends
    assert spans.tolist() == [2, *[3] * 17, 2]


def test_the_rig_is_compared_parameter_by_parameter(facts: ReportFacts, tmp_path: Path) -> None:
    rows = (("rotation", "x", "rad", 0.024, 0.0005, "off"), ("clock", "", "s", 0.0, None, "off"))
    parameters = [
        {
            "sensor": "<vertical>",
            "quantity": quantity,
            "axis": axis,
            "unit": unit,
            "change": change,
            "sd": sd,
            "status": status,
        }
        for quantity, axis, unit, change, sd, status in rows
    ]
    figures = {"parameters": parameters, "outcome": "the rig file differs", "windows": 4}
    (tmp_path / "calibration").mkdir()
    (tmp_path / "calibration" / "calibration.json").write_text(json.dumps({"figures": figures}))
    artifacts = {**facts.artifacts, "calibration": tmp_path / "calibration"}

    page = Tags(render(assess(replace(facts, artifacts=artifacts))))

    assert "+1.375 ± 0.029 °" in page.text
    assert "<vertical> rotation x: off" in page.text
    assert "standard deviation. the rig file differs." in page.text
    assert ("data-name", "rig-rad") in page.attributes
    assert ("data-name", "rig-s") not in page.attributes  # without any standard deviation


@pytest.mark.parametrize(
    ("applied", "levels"),
    [(True, [Level.CHECK, Level.NOTE]), (False, [Level.CHECK, Level.DO_NOT_USE])],
)
def test_what_no_calibration_corrects_stays_a_warning(
    facts: ReportFacts, tmp_path: Path, applied: bool, levels: list[Level]
) -> None:
    off = {"sensor": "v", "quantity": "rotation", "axis": "x", "unit": "rad", "change": 0.02,
           "sd": 0.001, "status": "off"}  # fmt: skip
    unit = {"kind": "gyroscope unit", "value": 57.3}
    figures = {"parameters": [off], "outcome": "o", "imu_faults": [unit], "applied": applied}
    (tmp_path / "calibration").mkdir()
    (tmp_path / "calibration" / "calibration.json").write_text(json.dumps({"figures": figures}))
    artifacts = {**facts.artifacts, "calibration": tmp_path / "calibration"}

    found = assess(replace(facts, artifacts=artifacts)).findings

    level = {one.kind: one.level for one in found}
    assert [level[FindingKind.IMU_UNIT], level[FindingKind.RIG_CONTRADICTED]] == levels


def test_the_report_quotes_serial_numbers_and_calibration_of_the_rig(facts: ReportFacts) -> None:
    note = RigCalibration(
        date="2026-01-02", method="joint", sd_deg=0.02, sd_mm=1.1, sd_ms=0.1, sd_antenna_mm=3.7
    )
    rig = replace(load_rig("4recon"), calibration=note)
    rig = replace(rig, sensors=(replace(rig.sensors[0], serial="<AF17>"), rig.sensors[1]))
    day_ns = 1_795_348_800_000_000_000  # 2026-11-22
    origin = RigOrigin.of(rig, recorded_ns=day_ns, max_age_days=30)

    page = Tags(render(assess(replace(facts, rig_origin=origin))))

    assert "serial number <AF17>" in page.text
    assert "serial number not known" in page.text
    assert "2026-01-02, 324 days before the walk" in page.text
    assert "3.7 mm" in page.text
