"""The whole way from a log of a 2-D laser to a project folder."""

import json
from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from recon4.archive.verify import verify
from recon4.cli.main import main
from recon4.errors import ConfigError, EmptyRecording, StoreError
from recon4.geometry.se2 import transform
from recon4.model.rig import load_rig
from recon4.model.usability import Usability
from recon4.pipeline import process
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.sources import Sources
from recon4.settings import Settings, override
from recon4.simulation.line_bag import open_line_bag
from recon4.slam2d import occupancy
from recon4.slam2d.grid_files import read_overview
from recon4.store.hashing import hash_file
from recon4.workflows.planar_results import RESULTS_2D
from recon4_app.projects.import_folders import ImportFolders
from recon4_app.projects.store import ProjectStore
from recon4_app.viewer.client.view import ViewState
from recon4_app.viewer.scene.build import bounds, describe
from recon4_app.viewer.scene.nodes import ImageNode
from recon4_app.viewer.scene.source import ProjectSource
from tests.g2o_reader import read_g2o
from tests.laser_rows import rows_of, with_rows
from tests.planar_walks import (
    along,
    blank_corridor,
    furnished_room,
    mirrored,
    ring_corridor,
    ring_walk,
    scanned,
    write_carmen,
)
from tests.said import texts


@pytest.fixture(scope="module")
def room():
    corners = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0], [3.0, 1.0], [0.0, 1.0]])
    return scanned(furnished_room(), along(corners))


@pytest.fixture(scope="module")
def mapped(tmp_path_factory, room):
    folder = tmp_path_factory.mktemp("mapped")
    write_carmen(folder / "walk.log", room.scans)
    return folder, process(Sources((folder / "walk.log",)), folder / "out")


def run(folder, scans, **given):
    write_carmen(folder / "walk.log", scans)
    return process(Sources((folder / "walk.log",), **given), folder / "out")


def other_reasons(summary):
    """Why the map is not good, besides the loop closure of so short a walk, which is unverified."""
    return [text for text in summary.verdict.reasons if "unverified" not in text]


def test_a_log_becomes_a_project_with_all_its_results(mapped, room):
    folder, summary = mapped
    out = folder / "out"

    written = json.loads((out / "summary.json").read_text("utf-8"))

    assert written == json.loads(json.dumps(summary.to_json()))
    assert written["map"] == "2d"
    assert {name: hash_file(out / name) for name in RESULTS_2D} == written["hashes"]["results"]
    assert other_reasons(summary) == []
    assert summary.scans == len(room.scans)
    assert summary.path_length_m == pytest.approx(11.4, abs=0.6)
    trajectory = read_tum(out / "trajectory.tum")
    distance, _ = room.errors(
        np.stack(
            [
                trajectory.T_a_b.t[:, 0],
                trajectory.T_a_b.t[:, 1],
                np.arctan2(trajectory.T_a_b.R[:, 1, 0], trajectory.T_a_b.R[:, 0, 0]),
            ],
            axis=1,
        )
    )
    assert distance.max() < 0.02
    assert not verify(out, Silent()).damaged


def test_a_second_run_reuses_every_stage(mapped):
    folder, first = mapped

    second = process(Sources((folder / "walk.log",)), folder / "out")

    assert all(stage.reused for stage in second.stages)
    assert [stage.key for stage in second.stages] == [stage.key for stage in first.stages]


def test_a_setting_of_the_grid_makes_only_the_map_again(mapped):
    folder, _ = mapped
    settings = override(Settings(), ["grid2d.cell_m=0.1"])

    summary = process(Sources((folder / "walk.log",)), folder / "out", settings=settings)

    assert [stage.stage for stage in summary.stages if not stage.reused] == ["map_2d", "audit"]
    assert summary.grid.cell_m == 0.1


def test_the_command_names_the_map(tmp_path, room, capsys):
    write_carmen(tmp_path / "walk.log", room.scans[:40])

    code = main(["process", str(tmp_path / "walk.log"), "--out", str(tmp_path / "out")])

    text = capsys.readouterr().out
    assert code == 0
    assert "40 scans (0 lost)" in text
    assert "verdict: good" in text
    assert "map.yaml" in text


def test_a_bag_of_a_laser_becomes_a_map_too(tmp_path, room):
    with open_line_bag(tmp_path / "bag") as bag:
        bag.scans("/scan", replace(room.scans[:40], odometry=None))

    summary = process(Sources((tmp_path / "bag",)), tmp_path / "out")

    assert summary.scans == 40
    assert (tmp_path / "out" / "map.png").is_file()


def test_a_blank_corridor_is_said_not_to_be_usable(tmp_path):
    walk = scanned(blank_corridor(), along(np.array([[0.0, 0.0], [16.0, 0.0]])), odometry=False)

    summary = run(tmp_path, walk.scans)

    assert summary.verdict.usability is Usability.DO_NOT_USE
    assert "hardly observes one direction" in " ".join(summary.verdict.reasons)
    assert summary.verdict.unobserved[0].end_s - summary.verdict.unobserved[0].start_s > 15.0
    assert summary.grid.largest_sd_m > 5.0


def test_a_silent_laser_without_odometry_is_part_of_the_verdict(tmp_path):
    walk = scanned(ring_corridor(), ring_walk(0.4), odometry=False)
    t_s = (walk.scans.t_ns - walk.scans.t_ns[0]) / 1e9

    summary = run(tmp_path, walk.scans[(t_s < 5.0) | (t_s > 10.0)])

    assert "for 5.2 s. The longest silence begins 4.9 s after" in " ".join(texts(summary.findings))
    assert summary.verdict.usability is not Usability.GOOD
    assert "is unknown" in " ".join(summary.verdict.reasons)


def test_a_map_whose_cells_had_to_be_enlarged_says_so(tmp_path, room, monkeypatch):
    monkeypatch.setattr(
        occupancy, "OCCUPANCY", structs.replace(occupancy.OCCUPANCY, max_cells=20_000)
    )

    summary = run(tmp_path, room.scans[:40])

    assert summary.grid.enlarged == 4
    assert summary.verdict.usability is Usability.CHECK
    assert "its cells are 0.2 m, 4 times as large" in " ".join(summary.verdict.reasons)


def test_scans_that_are_not_used_stand_in_the_verdict(tmp_path, room):
    with open_line_bag(tmp_path / "some") as bag:
        bag.scans("/scan", replace(room.scans, angle_step_rad=broken_steps(room.scans, every=10)))
    with open_line_bag(tmp_path / "most") as bag:
        bag.scans("/scan", replace(room.scans, angle_step_rad=broken_steps(room.scans, every=1)))

    some, most = (
        process(Sources((tmp_path / name,)), tmp_path / f"map-{name}") for name in ("some", "most")
    )

    count = len(room.scans)
    assert some.verdict.usability is Usability.CHECK
    assert some.verdict.reasons[0].startswith(f"{(count + 9) // 10} of {count} scans of the 2-D")
    assert most.verdict.usability is Usability.DO_NOT_USE
    assert "cannot be decoded" in most.verdict.reasons[0]


def broken_steps(scans, *, every):
    """Steps between beams of which every n-th is 0, which no scan can have; never the last 40."""
    broken = np.arange(len(scans)) % every == 0
    broken[-40:] &= every > 1
    return np.where(broken, 0.0, scans.angle_step_rad)


def test_mirrored_scans_are_repaired_and_said(tmp_path, room):
    summary = run(tmp_path, mirrored(room.scans))

    assert "wrong order" in " ".join(texts(summary.findings))
    assert other_reasons(summary) == []


def test_a_log_without_a_usable_scan_is_refused(tmp_path, room):
    far = with_rows(room.scans[:10], np.full_like(rows_of(room.scans[:10]), 35.0))

    with pytest.raises(EmptyRecording, match="none of the 10 scans has enough returns between"):
        run(tmp_path, replace(far, range_max_m=80.0))


def test_a_rig_does_not_belong_to_a_log(tmp_path, room):
    with pytest.raises(ConfigError, match="processed without a rig"):
        run(tmp_path, room.scans[:5], rig=load_rig("4recon"))
    assert not (tmp_path / "out" / "project.json").exists()


def test_the_graph_is_readable_by_other_solvers(mapped):
    graph = read_g2o(mapped[0] / "out" / "graph.g2o")

    assert len(graph) > 20


def test_the_pages_offer_the_files_of_a_2d_map(mapped):
    folder, _ = mapped

    project = ProjectStore(folder, ImportFolders(())).get("out")

    assert set(RESULTS_2D) <= {file.name for file in project.files}
    stages = ["scans_2d", "odometry_2d", "graph_2d", "verification", "map_2d", "audit"]
    assert [stage.stage for stage in project.stages] == stages
    assert project.viewable
    assert not project.has_map
    assert project.problem == ""


def test_the_viewer_shows_the_map_its_trajectory_and_its_edges(mapped, room, tmp_path):
    content = ProjectSource(mapped[0] / "out", tmp_path).content

    nodes = describe(content, ViewState())
    (image,) = [node for node in nodes if isinstance(node, ImageNode)]
    rows, columns = np.nonzero(image.rgba[..., 0] > 200)
    height, width = image.rgba.shape[:2]
    right = ((columns + 0.5) / width - 0.5) * image.width_m
    up = (0.5 - (rows + 0.5) / height) * image.height_m
    p_map = np.stack([right, up], axis=1) + image.position_m[:2]
    distance = distance_to_walls(transform(room.truth[0], p_map))
    assert np.mean(distance < 0.1) > 0.9
    assert any(node.path.startswith("/trajectory/") for node in nodes)
    assert any(node.path.startswith("/edges/") for node in nodes)
    assert bounds(content).size_m > 8.0


def distance_to_walls(p):
    walls = furnished_room()
    start, along_wall = walls[:, :2], walls[:, 2:] - walls[:, :2]
    away = p[:, None] - start
    share = np.einsum("nwi,wi->nw", away, along_wall) / np.einsum("wi,wi->w", *[along_wall] * 2)
    nearest = start + np.clip(share, 0.0, 1.0)[..., None] * along_wall
    return np.linalg.norm(p[:, None] - nearest, axis=2).min(axis=1)


def test_a_damaged_map_is_named(mapped, tmp_path):
    (tmp_path / "map.png").write_bytes((mapped[0] / "out" / "map.png").read_bytes()[:60])
    (tmp_path / "map.yaml").write_bytes((mapped[0] / "out" / "map.yaml").read_bytes())

    with pytest.raises(StoreError, match="the 2-D map cannot be read"):
        read_overview(tmp_path)
