"""Projects as Python programs see them: made, interrupted, opened, altered."""

import json
import tarfile
from pathlib import Path

import numpy as np
import pytest

from recon4 import api
from recon4.cli.main import main
from recon4.store.checked import Altered
from recon4.store.project import Project, read_artifacts
from tests.moved_points import move_points
from tests.planar_walks import along, furnished_room, scanned, write_carmen
from tests.project_builder import approve_project, build_project

ARCHIVE = Path(__file__).parents[2] / "data" / "project-format1.tar.xz"
FILES = {"imu": "imu.csv", "rig": "rig.toml"}


def sources(folder):
    return api.Sources.of(
        folder / "recording.pcap", **{name: folder / file for name, file in FILES.items()}
    )


def test_a_wrong_setting_is_named_before_anything_is_made(here, tmp_path):
    wrong = {"map.voxel": 0.05, "calibration.beams": "perhaps"}

    with pytest.raises(api.errors.ConfigError, match=r"map\.voxel.*calibration\.beams"):
        api.process(sources(here / "recording"), tmp_path / "out", settings=wrong)
    assert not (tmp_path / "out").exists()


def test_values_of_settings_may_be_numbers_flags_and_words(here):
    chosen = {"map.voxel_m": 0.05, "odometry.use_gnss": True, "map.surface": "fitted"}

    project = api.process(sources(here / "recording"), here / "walk", settings=chosen)

    # All of these are in force already: nothing ran again.
    record = json.loads((project.folder / "summary.json").read_text("utf-8"))
    assert all(stage["reused"] for stage in record["stages"])
    assert record["settings"]["map"]["voxel_m"] == 0.05
    assert project.summary.points == len(project.tiles)


def test_samples_beside_the_recording_that_are_not_read_are_a_warning(here, tmp_path):
    def stop(*_):
        raise api.errors.Cancelled("enough")

    recording = here / "recording" / "recording.pcap"
    with (
        pytest.warns(UserWarning, match=r"imu\.csv"),
        pytest.raises(api.errors.Cancelled),
    ):
        api.process(recording, tmp_path / "out", on_progress=stop)


def test_progress_is_reported_and_raising_in_it_stops_the_run(here, tmp_path):
    seen = []

    def watch(what, done, total):
        seen.append((what, done, total))
        if done >= 3:
            raise api.errors.Cancelled("enough")

    with pytest.raises(api.errors.Cancelled, match="enough"):
        api.process(sources(here / "recording"), tmp_path / "out", on_progress=watch)
    assert seen[0][1] == 0 and seen[-1][1] >= 3
    with pytest.raises(api.errors.StoreError, match="has no finished run"):
        api.open_project(tmp_path / "out")


def test_a_project_of_an_earlier_version_opens(tmp_path):
    with tarfile.open(ARCHIVE) as archive:
        archive.extractall(tmp_path, filter="data")
    signer = "0a5bf0639cc2939158dcc2f82c27995a755021f45d521d59a423cd32bae1ff50"
    (tmp_path / ".recon4").mkdir()
    main(["keys", "add", "Server before", signer, "--root", str(tmp_path)])

    project = api.open_project(tmp_path / "format1")

    assert project.summary.path_length_m == pytest.approx(9.2, abs=0.2)
    assert project.summary.verdict.reasons == ("It was made by a version that judged no maps.",)
    assert len(project.trajectory) > 92 and len(project.odometry) >= 92
    assert len(project.tiles) == project.summary.points


def test_warnings_of_earlier_versions_are_findings(tmp_path):
    build_project(tmp_path / "office", points=100)
    path = tmp_path / "office" / "summary.json"
    record = json.loads(path.read_text("utf-8")) | {"format": 2, "preset": "indoor"}
    record.pop("findings", None)
    path.write_text(json.dumps(record | {"name": "office", "created": "", "warnings": ["No IMU."]}))

    (found,) = api.open_project(tmp_path / "office").findings

    assert (found.kind, found.level, found.text) == ("EARLIER-REMARK", "check", "No IMU.")


def test_a_summary_that_makes_no_sense_is_an_error(tmp_path):
    build_project(tmp_path / "office", points=100)
    (tmp_path / "office" / "summary.json").write_text('{"format": 3, "name": 7}')

    with pytest.raises(api.errors.StoreError, match=r"summary\.json cannot be read.*name"):
        api.open_project(tmp_path / "office")


def test_the_graph_is_the_one_of_the_map(here):
    project = api.open_project(here / "walk")

    assert project.graph.verdict_counts() == dict(project.summary.edges)
    at_nodes = project.trajectory.at(project.graph.t_ns)
    assert np.abs(at_nodes.t - project.graph.T_map_body.t).max() < 0.05


def test_points_that_were_changed_after_the_approval_are_refused(tmp_path):
    root = tmp_path / "office"
    build_project(root, points=2000)
    approve_project(root, tmp_path / ".recon4" / "signing.key")
    tiles = api.read_tiles(root)
    assert sum(len(tile.xyz_m()) for tile in tiles) == 2000
    move_points(read_artifacts(root)["map"])

    with pytest.raises(Altered):
        [tile.xyz_m() for tile in api.read_tiles(root)]
    plane = api.SlicePlane.horizontal(1.0, thickness_m=2.0)
    with pytest.raises(Altered):
        api.write_slice(root, plane, tmp_path / "slice.csv")
    assert not (tmp_path / "slice.csv").exists()
    assert api.write_slice(root, plane, tmp_path / "slice.csv", draft=True) > 0


def test_a_project_that_another_process_works_on_can_be_read(here):
    with Project.open(here / "walk"):
        assert len(api.open_project(here / "walk").graph) > 1


def test_the_unit_of_a_model_must_be_known(here):
    model = here / "recording" / "model.ply"

    with pytest.raises(api.errors.ConfigError, match="unit: expected one of m, dm"):
        api.evaluate(here / "walk", here / "recording" / "truth.tum", model=model, unit="furlong")


def test_a_map_of_a_2d_laser_has_poses_and_a_graph_but_no_tiles(tmp_path):
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0], [0.0, 1.0]])
    walk = scanned(furnished_room(), along(corners))
    write_carmen(tmp_path / "walk.log", walk.scans)

    project = api.process(tmp_path / "walk.log", tmp_path / "out")

    assert len(project.trajectory) == len(project.odometry) > 100
    assert project.graph.verdict_counts() == dict(project.summary.edges)
    assert project.findings and all(one.text for one in project.findings)
    assert (project.folder / "map.png").is_file() and project.summary.points == 0
    with pytest.raises(api.errors.StoreError, match="out has no points: it is a 2-D map"):
        _ = project.tiles


def test_a_project_without_a_map_says_so(tmp_path):
    build_project(tmp_path / "begun", with_map=False)

    with pytest.raises(api.errors.StoreError, match="no map yet"):
        api.read_tiles(tmp_path / "begun")
