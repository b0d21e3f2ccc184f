"""Folders with files of several kinds, and samples beside a recording."""

import pytest
import trimesh

from recon4.cli.main import main
from recon4.errors import UnknownFormat
from recon4.locales.languages import ENVIRONMENT
from recon4.recording import kinds
from recon4.recording.frame_files.folders import list_frames
from recon4.recording.info.describe import describe
from recon4.recording.info.nearby_samples import unread_samples
from recon4.recording.kind_problems import known_kinds
from recon4.recording.kinds import (
    RecordingKind,
    located,
    located_elsewhere,
    located_sources,
    recognize,
)
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from tests.builders import T0_NS, Bag, bag_path, room_cloud, write_pcd
from tests.unit.recording.ingested import frame_folder, imu_csv, run
from tests.warned import derivations


def test_a_folder_with_recordings_of_two_kinds_is_refused_and_both_are_named(tmp_path, pcap):
    folder = frame_folder(tmp_path / "walk", ["model.pcd"])
    (folder / "recording.pcap").write_bytes(pcap.read_bytes())

    with pytest.raises(UnknownFormat) as caught:
        recognize(folder)

    assert "model.pcd (frames" in str(caught.value)
    assert "recording.pcap (packets of LiDARs (pcap))" in str(caught.value)


def test_a_file_that_only_has_the_ending_of_frames_leaves_the_kind_of_its_folder(tmp_path, pcap):
    (tmp_path / "recording.pcap").write_bytes(pcap.read_bytes())
    (tmp_path / "firmware.bin").write_bytes(b"\xff" * 37)
    (tmp_path / "drawings.3d").mkdir()

    assert recognize(tmp_path) is RecordingKind.PCAP


def test_a_mesh_beside_a_recording_is_passed_over_and_said(tmp_path, pcap):
    folder = walk_with_model(tmp_path, pcap)
    report = ImportReport()

    recording = open_recording(OpenRequest((folder,), None, IngestSettings(), report))

    assert recording.kind == RecordingKind.PCAP
    assert "model.ply is a mesh, not a recording: passed over." in derivations(report)


def test_a_mesh_alone_is_no_recording(tmp_path, pcap):
    folder = walk_with_model(tmp_path, pcap)

    with pytest.raises(UnknownFormat, match="a mesh: a finished model"):
        recognize(folder / "model.ply")


def test_a_folder_of_compressed_files_says_that_they_must_be_unpacked(tmp_path):
    for k in range(3):
        (tmp_path / f"{k}.pcd.gz").write_bytes(b"\x1f\x8b")

    with pytest.raises(UnknownFormat, match="unpack its 3 compressed files first"):
        recognize(tmp_path)


def test_a_folder_of_frames_passes_over_the_model_of_the_place(tmp_path):
    folder = frame_folder(tmp_path / "walk", ["0.ply", "1.ply"])
    write_mesh(folder / "model.ply")

    assert [file.name for file in list_frames(folder).files] == ["0.ply", "1.ply"]


def test_the_only_recording_in_a_subfolder_is_read_and_said(tmp_path, pcap):
    walk = walk_with_model(tmp_path, pcap)
    sources = Sources((tmp_path,))

    assert located_sources(sources).recordings == (walk,)
    assert located_elsewhere(sources) == [f"{tmp_path}: its only recording is read, {walk}"]
    assert describe(tmp_path).path.endswith("/walk")
    assert located(walk) == walk


def test_a_folder_of_several_recordings_names_them_as_candidates(tmp_path, pcap):
    for name in ("monday", "tuesday"):
        walk_with_model(tmp_path, pcap, name)

    with pytest.raises(UnknownFormat, match="holds 2 recordings: monday, tuesday; give one") as two:
        recognize(tmp_path)

    assert two.value.candidates == (tmp_path / "monday", tmp_path / "tuesday")


def test_files_of_two_kinds_are_candidates_where_each_is_a_recording(tmp_path, pcap):
    folder = frame_folder(tmp_path / "walk", ["map.pcd"])
    (folder / "walk.pcap").write_bytes(pcap.read_bytes())

    with pytest.raises(UnknownFormat) as caught:
        recognize(folder)

    assert set(caught.value.candidates) == {folder / "map.pcd", folder / "walk.pcap"}


def walk_with_model(folder, pcap, name="walk"):
    walk = folder / name
    walk.mkdir()
    (walk / "recording.pcap").write_bytes(pcap.read_bytes())
    write_mesh(walk / "model.ply")
    return walk


def write_mesh(path):
    trimesh.creation.box().export(path)


def test_samples_in_a_folder_of_frames_leave_its_kind(tmp_path):
    folder = frame_folder(tmp_path / "walk", ["0.pcd", "1.pcd"])
    imu_csv(folder / "imu.csv")

    assert recognize(folder) is RecordingKind.FRAMES


def test_samples_beside_a_recording_that_nobody_named_are_mentioned(tmp_path):
    cloud = tmp_path / "0.pcd"
    write_pcd(cloud, room_cloud())
    imu = imu_csv(tmp_path / "imu.csv")
    (tmp_path / "notes.csv").write_text("anything\n")

    [text] = unread_samples(Sources((cloud,)))

    assert f"--imu {imu}" in text
    assert unread_samples(Sources((cloud,), imu=imu)) == []
    assert unread_samples(Sources((cloud, imu))) == []


def test_info_names_samples_that_lie_beside_a_recording(tmp_path, pcap):
    (tmp_path / "walk.pcap").write_bytes(pcap.read_bytes())
    imu_csv(tmp_path / "imu.csv")

    for given in (tmp_path, tmp_path / "walk.pcap"):
        (text,) = (text for text in describe(given).missing if text.startswith("IMU"))
        assert "imu.csv beside it has them" in text and "command: --imu FILE" in text


def test_info_names_positions_beside_a_recording_that_has_some_itself(tmp_path):
    path = bag_path(tmp_path, "bag1")
    with Bag(path, "bag1") as bag:
        for k in range(12):
            bag.cloud("/points", T0_NS + k * 100_000_000, room_cloud())
            bag.fix("/fix", T0_NS + k * 100_000_000, 50.0, 8.0, 100.0)
    (path.parent / "gnss.csv").write_text(f"t_ns,lat_deg,lon_deg\n{T0_NS},50,8\n")

    (text,) = (text for text in describe(path).missing if text.values["what"] == "gnss")

    assert (
        text == "positions of gnss.csv beside it (page: IMU and GNSS files; command: --gnss FILE)"
    )


@pytest.mark.parametrize("command", ["info", "import"])
def test_a_folder_of_many_files_is_listed_few_times(tmp_path, monkeypatch, command):
    folder = frame_folder(tmp_path / "walk", [f"{k}.pcd" for k in range(3)])
    listed = []
    list_once = kinds._kinds_in

    def counted(path):
        listed.append(path)
        return list_once(path)

    monkeypatch.setattr(kinds, "_kinds_in", counted)

    if command == "info":
        describe(folder)
    else:
        run(folder, out=tmp_path / "frames")

    assert len(listed) <= (2 if command == "info" else 1)


def test_what_is_no_recording_is_said_in_the_language_of_the_terminal(
    tmp_path, pcap, capsys, monkeypatch
):
    monkeypatch.setenv(ENVIRONMENT, "de")
    (tmp_path / "photo.pcap").write_bytes(b"\xff\xd8\xff\xe0 photo")
    two = frame_folder(tmp_path / "two", ["map.pcd"])
    (two / "walk.pcap").write_bytes(pcap.read_bytes())
    complaints = {
        tmp_path
        / "photo.pcap": "photo.pcap: von keinem Leser erkannt (sieht aus wie ein JPEG-Bild",
        tmp_path / "nothing": "nothing gibt es nicht",
        two: "two: enthält Aufzeichnungen von 2 Arten: map.pcd (Einzelscans",
    }

    for path, said in complaints.items():
        assert main(["info", str(path)]) == 1
        assert said in capsys.readouterr().err


def test_all_kinds_are_named_where_no_reader_recognizes_a_file():
    assert known_kinds() == f"known: {', '.join(RecordingKind)}"
