"""Recordings of several days in one folder, or given together."""

import shutil

import pytest

from recon4.errors import UnknownFormat
from recon4.recording.info.describe import describe
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS, storage_file, write_room_bag, write_room_pcap
from tests.unit.recording.ingested import run
from tests.warned import derivations

DAY_NS = 86_400_000_000_000


@pytest.mark.parametrize("given_together", [False, True])
def test_captures_of_several_days_are_no_single_walk_but_candidates(tmp_path, given_together):
    files = [tmp_path / "a.pcap", tmp_path / "b.pcap"]
    for day, file in enumerate(files):
        write_room_pcap(file, seconds=0.2, t0_ns=T0_NS + day * DAY_NS)
    paths = files if given_together else [tmp_path]

    with pytest.raises(UnknownFormat, match=r"2 recordings .* a\.pcap \(20.*; b\.pcap") as caught:
        open_recording(OpenRequest(tuple(paths), None, IngestSettings(), ImportReport()))

    assert caught.value.candidates == tuple(files)


def test_info_names_captures_of_several_days_as_candidates(tmp_path):
    for day in range(2):
        file = tmp_path / f"{day}.pcap"
        write_room_pcap(file, seconds=0.2, t0_ns=T0_NS + day * DAY_NS)

    with pytest.raises(UnknownFormat) as caught:
        describe(tmp_path)

    assert [path.name for path in caught.value.candidates] == ["0.pcap", "1.pcap"]


@pytest.mark.parametrize("kind", ["bag1", "mcap", "db3"])
def test_bags_of_several_days_in_one_folder_are_candidates(tmp_path, kind):
    folder = tmp_path / "bags"
    folder.mkdir()
    for day in range(2):
        (tmp_path / f"{day}").mkdir()
        bag = write_room_bag(tmp_path / f"{day}", kind, seconds=0.2, t0_ns=T0_NS + day * DAY_NS)
        file = storage_file(bag)
        file.rename(folder / f"{day}{file.suffix}")

    with pytest.raises(UnknownFormat, match="2 recordings of different times") as caught:
        describe(folder)

    assert [path.stem for path in caught.value.candidates] == ["0", "1"]


def test_files_of_one_walk_with_a_break_between_them_are_read_together(tmp_path):
    for part in range(2):
        file = tmp_path / f"{part}.pcap"
        write_room_pcap(file, seconds=0.2, t0_ns=T0_NS + part * DAY_NS // 10)

    info = describe(tmp_path)

    assert info.seconds == pytest.approx(8640.0, abs=1.0)
    assert [sensor.count for sensor in info.sensors] == [300]  # of both files


@pytest.mark.parametrize("kind", ["pcap", "bag1", "mcap", "db3"])
def test_a_part_that_is_there_twice_is_read_once(tmp_path, kind):
    folder = tmp_path / "walk"
    folder.mkdir()
    for part, name in enumerate("cab"):  # the names are in another order than the times
        (tmp_path / name).mkdir()
        options = {"seconds": 0.4, "t0_ns": T0_NS + part * 400_000_000}
        if kind == "pcap":
            file = write_room_pcap(tmp_path / name / "a.pcap", **options)
        else:
            file = storage_file(write_room_bag(tmp_path / name, kind, **options))
        shutil.copy(file, folder / f"{name}{file.suffix}")
    once = run(folder, out=tmp_path / "once")
    shutil.copy(folder / f"a{file.suffix}", folder / f"x{file.suffix}")

    twice = run(folder, out=tmp_path / "twice")

    said = f"x{file.suffix} has the same bytes as a{file.suffix}: left out."
    assert said in derivations(twice.report)
    assert twice.report["counts"] == once.report["counts"]
    assert twice.index["t_ns"].tolist() == once.index["t_ns"].tolist()


def test_a_capture_whose_clocks_were_set_back_is_not_reversed(tmp_path):
    first, then = (
        write_room_pcap(tmp_path / name, seconds=0.4, t0_ns=T0_NS - back_ns)
        for name, back_ns in (("a.pcap", 0), ("b.pcap", 20_000_000_000))
    )
    first.write_bytes(first.read_bytes() + then.read_bytes()[24:])

    info = describe(first)

    assert info.seconds == pytest.approx(0.8, abs=0.01)
    assert [round(gap.seconds, 1) for gap in info.gaps] == [-20.4]
