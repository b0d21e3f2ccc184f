"""Folders with one file a frame: order, times, damaged files."""

import numpy as np
import pytest

from recon4.errors import CorruptFile
from recon4.recording.frame_files.folders import list_frames, natural
from recon4.recording.frame_files.times import name_time_ns, read_times
from recon4.recording.info.describe import describe
from tests.builders import T0_NS, room_cloud, write_bin, write_pcd, write_ply
from tests.unit.recording.ingested import frame_folder, run
from tests.warned import K, derivations, kinds, warned


@pytest.mark.parametrize("write", [write_pcd, write_ply, write_bin], ids=["pcd", "ply", "bin"])
def test_a_folder_of_frames_is_one_frame_a_file(tmp_path, write):
    folder = tmp_path / "frames"
    folder.mkdir()
    suffix = write.__name__[-3:]
    for k in (8, 9, 10):
        write(folder / f"{k}.{suffix}", {n: c[: k * 160] for n, c in room_cloud().items()})

    store = run(folder, out=tmp_path / "o")

    assert [len(f) for f in store] == [1280, 1440, 1600]
    assert store.index["t_ns"].tolist() == [0, 100_000_000, 200_000_000]
    assert warned(store.report, K.FRAMES_UNTIMED, rate_hz=10.0)


def test_a_folder_with_one_frame_works(tmp_path):
    assert len(run(frame_folder(tmp_path / "f", ["a.pcd"]), out=tmp_path / "o")) == 1


def test_a_single_file_is_one_frame(tmp_path):
    assert len(run(write_pcd(tmp_path / "a.pcd", room_cloud()), out=tmp_path / "o")) == 1


def test_times_in_the_file_names_are_used_and_gaps_reported(tmp_path):
    names = [f"{T0_NS + k * 100_000_000}.pcd" for k in (0, 1, 2, 3, 9)]

    store = run(frame_folder(tmp_path / "f", names), out=tmp_path / "o")

    assert store.index["t_ns"].tolist() == [int(name[:19]) for name in names]
    (gap,) = store.report["gaps"]
    assert gap["seconds"] == pytest.approx(0.6)


def test_one_damaged_file_is_left_out_and_counted(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd", "2.pcd", "3.pcd"])
    (folder / "2.pcd").write_bytes((folder / "2.pcd").read_bytes()[:-100])

    store = run(folder, out=tmp_path / "o")

    assert len(store) == 2
    assert store.report["outcome"] == "lossy"
    assert store.report["counts"]["files_corrupt"] == 1
    assert warned(store.report, K.FILE_LEFT_OUT, error="2.pcd: cut")


def test_only_damaged_files_are_an_error(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd"])
    (folder / "1.pcd").write_bytes((folder / "1.pcd").read_bytes()[:-100])

    with pytest.raises(CorruptFile, match=r"1\.pcd: cut"):
        run(folder, out=tmp_path / "o")


def test_a_frame_without_points_is_counted(tmp_path):
    folder = frame_folder(tmp_path / "f", ["1.pcd", "3.pcd"])
    write_pcd(folder / "2.pcd", {n: c[:0] for n, c in room_cloud().items()})

    store = run(folder, out=tmp_path / "o")

    assert [f.frame_id for f in store] == [0, 1]
    assert store.report["counts"]["frames_empty"] == 1


@pytest.mark.parametrize(
    ("stem", "expected"),
    [
        ("1673400472138016708", 1673400472138016708),
        ("1673400472138016", 1673400472138016000),
        ("1673400472.5", 1673400472500000000),
        ("2021-10-26-16-21-29-468", 1635265289468000000),
        ("top-2022-02-15-17-36-04-449", 1644946564449000000),
        ("1673400472138", 1673400472138000000),
        ("scan_1673400472138", 1673400472138000000),
        ("cloud-1673400472.25", 1673400472250000000),
        ("lidar2_1673400472_000000005", 1673400472000000005),
        ("2021-13-40-16-21-29-468", None),
        ("000012", None),
        ("scan2024", None),
        ("16734004721380167081", None),
    ],
)
def test_times_in_names(stem, expected):
    assert name_time_ns(stem) == expected


def test_times_in_names_with_two_endings_are_used(tmp_path):
    names = [f"LIDAR_TOP__{T0_NS // 1000 + k * 50_000}.pcd.bin" for k in range(3)]
    for name in names:
        write_bin(tmp_path / name, room_cloud())

    frames = list_frames(tmp_path)

    assert frames.times_from == "the file names"
    assert np.diff(frames.t_ns).tolist() == [50_000_000] * 2


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("# seconds\n0\n0.1036712345\n", [0, 103_671_234]),
        ("1.000000000000000000e+00\n1.5e+00\n", [1_000_000_000, 1_500_000_000]),
        ("1673400472.138016708\n", [1673400472138016708]),
        ("1673400472138\r\n1673400472238.5\r\n", [1673400472138000000, 1673400472238500000]),
        ("2011-09-26 13:02:25.951199337\n", [1317042145951199337]),
        ("2011-09-26T13:02:25Z\n\n", [1317042145000000000]),
    ],
)
def test_times_in_text_files(tmp_path, lines, expected):
    (tmp_path / "times.txt").write_bytes(lines.encode())

    assert read_times(tmp_path / "times.txt").tolist() == expected


def test_a_line_that_is_no_time_is_named(tmp_path):
    (tmp_path / "times.txt").write_text("0.0\n0,1\n")

    with pytest.raises(CorruptFile, match=r"times\.txt, line 2: expected seconds or a date"):
        read_times(tmp_path / "times.txt")


def test_kitti_raw_timestamps_lie_beside_the_folder_of_the_frames(tmp_path):
    folder = frame_folder(tmp_path / "data", ["0.pcd", "1.pcd"])
    stamps = ("2011-09-26 13:02:25.951199337", "2011-09-26 13:02:26.054870000")
    (tmp_path / "timestamps.txt").write_text("\n".join(stamps))

    store = run(folder, out=tmp_path / "o")

    assert store.index["t_ns"].tolist() == [1317042145951199337, 1317042146054870000]
    assert not warned(store.report, K.FRAMES_UNTIMED)


@pytest.mark.parametrize(
    ("lines", "kind", "values"),
    [
        ("0.0\n0.1\n0.2\n", K.TIMES_NUMBER, {"times": 3, "files": 2}),
        ("0.1\n0.1\n", K.TIMES_UNSORTED, {"first": 2, "damaged": 1, "times": 2}),
    ],
)
def test_times_that_do_not_fit_are_named_before_10_hz_are_assumed(tmp_path, lines, kind, values):
    folder = frame_folder(tmp_path / "f", ["0.pcd", "1.pcd"])
    (folder / "times.txt").write_text(lines)

    report = run(folder, out=tmp_path / "o").report

    assert warned(report, kind, **values)
    assert warned(report, K.FRAMES_UNTIMED, rate_hz=10.0)
    assert warned(describe(folder), kind, **values)


def test_numbers_that_are_missing_leave_their_time_empty(tmp_path):
    folder = frame_folder(tmp_path / "f", [f"{k}.pcd" for k in (0, 3, 6, 9, 24, 27, 30)])

    store = run(folder, out=tmp_path / "o")

    assert (store.index["t_ns"] // 100_000_000).tolist() == [0, 1, 2, 3, 8, 9, 10]
    assert store.report["counts"]["files_absent"] == 4
    assert warned(store.report, K.TIME_GAP, seconds=0.5)
    (said,) = [text for text in derivations(store.report) if "lack" in text]
    assert (
        said == "The names of the files lack 4 numbers of 0.pcd to 30.pcd: their time stays empty."
    )


def test_numbers_of_chosen_frames_are_no_row(tmp_path):
    folder = frame_folder(tmp_path / "f", [f"{k}.pcd" for k in (0, 3, 7, 12, 13, 19)])

    assert (list_frames(folder).t_ns // 100_000_000).tolist() == [0, 1, 2, 3, 4, 5]


@pytest.mark.parametrize("first", [0, 1])
def test_times_of_all_frames_belong_to_the_numbers_of_those_that_are_left(tmp_path, first):
    numbers = [first + k for k in (0, 1, 2, 5, 6, 9)]
    folder = frame_folder(tmp_path / "f", [f"{k:04d}.pcd" for k in numbers])
    (folder / "times.txt").write_text("".join(f"{k * k}\n" for k in range(1, 11)))

    frames = list_frames(folder)

    assert (frames.t_ns // 10**9).tolist() == [1, 4, 9, 36, 49, 100]
    assert not frames.findings


def test_a_copy_and_a_map_among_numbered_frames_are_left_out(tmp_path):
    names = [f"scan_{k}.pcd" for k in range(20)]
    folder = frame_folder(tmp_path / "f", [*names, "scan_3 (1).pcd"])
    write_pcd(folder / "GlobalMap.pcd", {n: c[:99] for n, c in room_cloud().items()})

    store = run(folder, out=tmp_path / "o")

    assert len(store) == 20
    said = " ".join(derivations(store.report))
    assert "scan_3 (1).pcd has the same bytes as scan_0.pcd: left out." in said
    assert "GlobalMap.pcd has no number as the other 20 files have" in said


_TIMES_OF_FILES = {
    "backward": [11, 10, 9, 8, 7, 6, 5, 4, 3, 2, 1, 0],
    "shuffled": [3, 0, 7, 1, 11, 2, 9, 4, 10, 5, 8, 6],
}


@pytest.mark.parametrize("by", [*_TIMES_OF_FILES, "names"])
def test_files_whose_numbers_are_in_another_order_are_sorted_by_their_times(tmp_path, by):
    steps = _TIMES_OF_FILES.get(by, _TIMES_OF_FILES["shuffled"])
    t_ns = [T0_NS + step * 100_000_000 for step in steps]
    stamps = [f"_{t}" if by == "names" else "" for t in t_ns]
    folder = frame_folder(tmp_path / "f", [f"{k}{text}.pcd" for k, text in enumerate(stamps)])
    if by != "names":
        (folder / "times.txt").write_text("".join(f"{t}\n" for t in t_ns))

    frames = list_frames(folder)

    assert [natural(file)[0][1] for file in frames.files] == np.argsort(steps).tolist()
    assert np.all(np.diff(frames.t_ns) == 100_000_000)
    text = f"{frames.out_of_order} of 12 files: numbers in another order than their times, sorted"
    assert [one.text for one in describe(folder).repaired] == [text]
    counts = run(folder, out=tmp_path / "o").report["counts"]
    assert counts["files_out_of_order"] == frames.out_of_order > 0


def test_times_listed_in_the_order_of_a_plain_sort_belong_to_the_files_of_that_order(tmp_path):
    folder = frame_folder(tmp_path / "f", [f"{k}.pcd" for k in range(12)])
    listed = sorted(range(12), key=str)
    (folder / "times.txt").write_text("".join(f"{0.1 * k}\n" for k in listed))

    frames = list_frames(folder)

    assert [file.name for file in frames.files] == [f"{k}.pcd" for k in range(12)]
    assert frames.t_ns.tolist() == [k * 100_000_000 for k in range(12)]


def test_times_that_start_again_each_minute_are_not_sorted(tmp_path):
    folder = frame_folder(tmp_path / "f", [f"{k:02d}.pcd" for k in range(12)])
    seconds = [round(k * 0.7 % 3.3, 3) for k in range(12)]
    (folder / "times.txt").write_text("".join(f"{s}\n" for s in seconds))

    assert K.TIMES_UNSORTED in kinds(describe(folder))


def test_deskewed_clouds_have_no_motion_inside(tmp_path):
    folder = tmp_path / "f"
    folder.mkdir()
    for name in ("0.bin", "1.bin"):
        write_bin(folder / name, room_cloud())

    plain = run(folder, out=tmp_path / "a")
    deskewed = run(folder, out=tmp_path / "b", deskewed=True)

    assert plain[0].dt_ns.max() > 50_000_000
    assert deskewed[0].dt_ns.max() == 0
    assert K.POINTS_TIMED_BY_AZIMUTH in kinds(plain.report)
    assert K.POINTS_TIMED_BY_AZIMUTH not in kinds(deskewed.report)


def test_names_are_sorted_by_their_numbers(tmp_path):
    names = [tmp_path / n for n in ("10.pcd", "8.pcd", "a2.pcd", "a10.pcd")]

    assert [p.name for p in sorted(names, key=natural)] == ["8.pcd", "10.pcd", "a2.pcd", "a10.pcd"]


def test_names_of_several_sensors_in_one_folder_are_a_warning(tmp_path):
    clock = "2022-02-15-17-36-04-"
    mixed = [f"{n}-{clock}{k}{m}4.pcd" for k in (1, 2, 3) for m, n in enumerate(("left", "top"))]
    one = [f"left-{clock}{k}14.pcd" for k in (1, 2, 3)]

    found = describe(frame_folder(tmp_path / "mixed", mixed))
    assert warned(found, K.FRAMES_MIXED, ways=2, some="'left', 'top'")
    assert not warned(describe(frame_folder(tmp_path / "one", one)), K.FRAMES_MIXED)
