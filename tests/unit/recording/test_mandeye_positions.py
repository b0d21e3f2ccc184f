"""Positions that a MANDEYE device writes beside its points."""

import shutil

import numpy as np
import pytest

from recon4.model.samples import GnssSamples
from recon4.recording.info.describe import describe
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream, rig_to_complete
from recon4.recording.samples.clean import join
from recon4.settings import IngestSettings
from tests.builders import T0_NS
from tests.unit.recording.test_mandeye import write_walk

RIG = rig_to_complete([Stream("a", "Mid-360")])


@pytest.fixture(scope="module")
def walk(tmp_path_factory):
    folder = tmp_path_factory.mktemp("mandeye") / "walk"
    write_walk(folder, RIG, seconds=1.0)
    return folder


@pytest.fixture
def copy(walk, tmp_path):
    return shutil.copytree(walk, tmp_path / "walk")


def gga(k):
    """A GGA sentence of a moment, with its checksum."""
    place = f"4912.{k:05d},N,01635.00000,E"
    text = f"GNGGA,10{k // 60:02d}{k % 60:02d}.00,{place},4,12,0.8,250.5,M,44.2,M,1,"
    check = 0
    for character in text.encode():
        check ^= character
    return f"${text}*{check:02X}"


def write_positions(folder, *, ending="gnss", fixes=10):
    """Files of positions of two parts, as the devices write them."""
    for part in range(2):
        lines = []
        for k in range(fixes):
            t_ns = T0_NS + part * 5_000_000_000 + k * 200_000_000
            lat = 49.0 + (12.0 + k * 1e-5) / 60.0
            cells = (
                f"{t_ns} {lat:.9f} 16.58333333333 250.5 0.8 12 44.2 1 10:0:{k} 4 {t_ns // 10**6}"
            )
            lines.append(cells if ending == "gnss" else f"{t_ns} {t_ns // 10**6} {gga(k)} ")
        (folder / f"gnss{part:04d}.{ending}").write_text("\n".join([*lines, ""]), "utf-8")


def positions(folder):
    report = ImportReport()
    recording = open_recording(OpenRequest((folder,), RIG, IngestSettings(), report))
    found = [item for item in recording.read() if isinstance(item, GnssSamples)]
    return (join(found) if found else None), report


@pytest.mark.parametrize("ending", ["gnss", "nmea"])
def test_positions_of_the_device_are_read_with_ellipsoidal_heights(copy, ending):
    write_positions(copy, ending=ending)
    fixes, report = positions(copy)

    assert len(fixes) == report.counts["gnss_samples"] == 20
    assert fixes.t_ns[0] == T0_NS and (np.diff(fixes.t_ns) > 0).all()
    np.testing.assert_allclose(np.rad2deg(fixes.lat_rad[3]), 49.0 + 12.00003 / 60.0, atol=1e-9)
    np.testing.assert_allclose(fixes.height_m, 294.7, atol=1e-6)
    assert set(fixes.quality.tolist()) == {4}
    assert "GNSS positions in 2 files" in describe(copy).samples


def test_positions_are_read_once_and_those_without_a_fix_are_counted(copy):
    write_positions(copy, ending="nmea")
    write_positions(copy)
    path = copy / "gnss0001.gnss"
    path.write_text(path.read_text("utf-8").replace(" 4 ", " 0 "), "utf-8")
    fixes, report = positions(copy)

    assert len(fixes) == report.counts["gnss_no_fix"] == 10


@pytest.mark.parametrize(
    "line", ["", "1 2", f"{T0_NS} 95.0 16.0 250 1 9 44 1 1:1:1 4 1", "x " * 11]
)
def test_a_damaged_position_is_dropped_and_a_damaged_file_left_out(copy, line):
    write_positions(copy, fixes=40)
    path = copy / "gnss0000.gnss"
    path.write_text(path.read_text("utf-8") + line + "\n", "utf-8")
    (copy / "gnss0001.gnss").write_text("no positions\n" * 9, "utf-8")
    fixes, report = positions(copy)

    assert len(fixes) == 40 and report.counts["gnss_lines_damaged"] == int(bool(line))
    assert report.counts["files_corrupt"] == 1


def test_heights_that_are_none_and_unknown_qualities_are_not_trusted(copy):
    write_positions(copy)
    path = copy / "gnss0000.gnss"
    text = path.read_text("utf-8").replace(" 250.5 ", " nan ").replace(" 4 ", " 77 ")
    path.write_text(text, "utf-8")
    (copy / "gnss0001.gnss").unlink()
    fixes, _ = positions(copy)

    assert len(fixes) == 10 and np.isnan(fixes.height_m).all()
    assert set(fixes.quality.tolist()) == {1}


def test_a_time_that_is_beyond_all_clocks_is_a_damaged_line(copy):
    write_positions(copy, ending="nmea", fixes=40)
    path = copy / "gnss0000.nmea"
    path.write_text(path.read_text("utf-8") + f"{T0_NS} {'9' * 400} {gga(1)}\n", "utf-8")

    _, report = positions(copy)

    assert report.counts["gnss_lines_damaged"] == 1
