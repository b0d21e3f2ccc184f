"""From packets to a finished project folder, by the command line."""

import json
import shutil

import laspy
import numpy as np
import pye57
import pytest

from recon4.cli.main import main
from recon4.evaluation.evaluate import evaluate
from recon4.findings.walk_record import final_trajectory
from recon4.first_view.files import FIRST_FILES, write_first_files
from recon4.mapping.tiles import TileSet
from recon4.settings import preset, to_json
from recon4.slices.map_crs import frame_of
from recon4.store.hashing import hash_file
from recon4.store.project import read_artifacts
from recon4.workflows.map_results import RESULTS
from tests.short_capture import process_short


@pytest.fixture(scope="module")
def project(short_project, tmp_path_factory):
    """A copy of the finished project of a short recording."""
    return shutil.copytree(short_project, tmp_path_factory.mktemp("project") / "office")


@pytest.fixture(scope="module")
def process(short_recording):
    """Runs the command that made it."""

    def run(out, *more):
        return main([*process_short(short_recording, out), *more])

    return run


def test_every_result_is_there_and_vouched_for_by_its_hash(project):
    summary = json.loads((project / "summary.json").read_text())

    assert set(summary["hashes"]["results"]) == set(RESULTS)
    for name, sha256 in summary["hashes"]["results"].items():
        assert hash_file(project / name) == sha256


def test_the_summary_has_inputs_settings_and_stages(project):
    summary = json.loads((project / "summary.json").read_text())

    assert summary["rig"] == "4RECON"
    assert summary["preset"] == "indoor"
    assert summary["settings"]["map"]["voxel_m"] == 0.1
    assert summary["settings"]["odometry"] == to_json(preset("indoor"))["odometry"]
    assert set(summary["hashes"]["inputs"]) == {"recording.pcap", "imu.csv"}
    assert [stage["stage"] for stage in summary["stages"]] == [
        *("frames", "odometry", "calibration", "graph", "verification"),
        *("refine", "level", "intensity", "classes", "map", "audit"),
    ]
    assert all(stage["seconds"] > 0 and stage["peak_bytes"] > 0 for stage in summary["stages"])
    assert summary["lost"] == 0
    edges = json.loads((project / "edges.json").read_text())["edges"]
    verdicts = [edge["verdict"] for edge in edges]
    assert summary["edges"] == {v: verdicts.count(v) for v in summary["edges"]}
    assert sum(summary["edges"].values()) == len(edges)


def test_the_walk_is_tracked_to_a_centimeter(project, office_recording):
    found = evaluate(project, truth=office_recording / "truth.tum")

    # The last pose is the end of the last revolution, a moment after the end of the truth.
    assert found.coverage_ratio > 0.98
    assert found.aligned.position_m.rmse < 0.01


def test_the_map_has_what_its_page_reads_first(project, tmp_path):
    artifacts = read_artifacts(project)
    tiles, walk = TileSet.open(artifacts["map"]), final_trajectory(artifacts)

    write_first_files(tmp_path / "first", tiles, frame_of(artifacts), walk_m=walk.T_a_b.t)

    made = {path.name: path.read_bytes() for path in (tmp_path / "first").iterdir()}
    assert {*made} == {"index.json", "xyz.bin", "normalized.bin"}
    for name, data in made.items():
        assert (artifacts["map"] / FIRST_FILES / name).read_bytes() == data


def test_the_map_is_level_and_has_the_points_it_says(project):
    summary = json.loads((project / "summary.json").read_text())

    with laspy.open(project / "map.laz") as file:
        points = file.read()
    x, y, z = (np.asarray(points[axis]) for axis in "xyz")
    on_floor = abs(z - np.median(z[z < np.percentile(z, 5)])) < 0.15
    A = np.stack([x[on_floor], y[on_floor], np.ones(on_floor.sum())], axis=1)
    slope = np.linalg.lstsq(A, z[on_floor], rcond=None)[0][:2]

    assert len(points) == summary["points"]
    assert np.rad2deg(np.linalg.norm(slope)) < 2.0  # seconds do not tell a bias from a tilt


def test_running_again_reuses_every_stage_and_gives_the_same_bytes(project, process):
    before = json.loads((project / "summary.json").read_text())

    assert process(project) == 0

    after = json.loads((project / "summary.json").read_text())
    assert all(stage["reused"] for stage in after["stages"])
    for name in set(RESULTS) - {"report.html"}:  # it says when it was made
        assert after["hashes"]["results"][name] == before["hashes"]["results"][name]


@pytest.mark.study
def test_a_changed_map_setting_reruns_the_map_only(project, process):
    assert process(project, "--set", "map.voxel_m=0.2") == 0

    summary = json.loads((project / "summary.json").read_text())
    assert [s["stage"] for s in summary["stages"] if not s["reused"]] == ["map", "audit"]


def test_verify_finds_the_project_whole(project, capsys):
    assert main(["verify", str(project)]) == 0
    assert "0 damaged" in capsys.readouterr().out


def test_the_map_is_exported_but_without_gnss_not_to_a_crs(project, tmp_path, capsys):
    assert main(["export", str(project), str(tmp_path / "map.ply")]) == 0
    assert (tmp_path / "map.ply").read_bytes().startswith(b"ply\n")
    for name in ("map.copc.laz", "map.e57"):
        assert main(["export", str(project), str(tmp_path / name)]) == 0
    with laspy.CopcReader.open(str(tmp_path / "map.copc.laz")) as copc:
        points = len(copc.query())
    with pye57.E57(str(tmp_path / "map.e57")) as e57:
        assert sum(e57.get_header(k).point_count for k in range(e57.scan_count)) == points > 0
    capsys.readouterr()

    assert main(["export", str(project), str(tmp_path / "m.laz"), "--crs", "EPSG:32633"]) == 1
    assert "no GNSS in the recording" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("empty.pcap", b"", "empty.pcap"),
        ("letter.pcap", b"Dear Sir or Madam, " * 40, "letter.pcap"),
        ("missing.pcap", None, "no such file"),
    ],
)
def test_a_bad_recording_is_one_line_and_leaves_no_artifact(
    tmp_path, capsys, name, content, message
):
    if content is not None:
        (tmp_path / name).write_bytes(content)

    assert main(["process", str(tmp_path / name), "--out", str(tmp_path / "p")]) == 1

    said = capsys.readouterr().err.splitlines()[-1]
    assert said.startswith("recon4: ")
    assert message in said
    assert list(tmp_path.glob("p/artifacts/*")) == []
    assert not (tmp_path / "p").exists()
