"""Trajectories that Inertial Explorer and its relatives export as text."""

import numpy as np
import pytest

from recon4.errors import CorruptFile, EmptyRecording
from recon4.model.samples import GnssQuality
from recon4.recording.gnss.files import is_gnss_file, read_gnss
from recon4.recording.gnss.records import Dating
from recon4.recording.report import ImportReport
from tests import gnss_logs as logs
from tests.gnss_logs import BEGIN_NS, LEAP_S, PLACE, WEEK_S
from tests.unit.recording.test_gnss_files import QUARTER_NS, assert_at_place, read

PLAIN = f"{PLACE[0]:12.7f} {PLACE[1]:12.7f} {PLACE[2]:8.3f}"
PLACE_NAMES = "    Latitude    Longitude    H-Ell"
PLACE_UNITS = "       (deg)        (deg)      (m)"


def test_an_export_is_at_its_place_and_time_with_attitude_and_accuracy(tmp_path):
    found = read(tmp_path, logs.exported_rows(3), "walk.txt")

    assert found.dating is Dating.UTC
    assert_at_place(found.samples)
    assert found.samples.t_ns[0] == BEGIN_NS + QUARTER_NS
    assert list(found.samples.quality) == [GnssQuality.RTK_FIXED] * 3
    np.testing.assert_allclose(found.samples.sd_enu_m[0], (0.01, 0.02, 0.03))
    np.testing.assert_allclose(np.rad2deg(found.samples.rpy_ned_rad[0]), (1.5, -2.5, 93.0))


@pytest.mark.parametrize(
    ("time", "names", "units", "dating", "t_ns"),
    [
        (f"{BEGIN_NS // 10**9}.250", "       UTCTime", "         (sec)", Dating.UTC, BEGIN_NS),
        (
            "05/06/2024 07:08:09.250",
            "   UTCDate      UTCTime",
            "     (MDY)        (HMS)",
            0,
            BEGIN_NS,
        ),
        (
            "06.05.2024 07:08:27.250",
            "   GPSDate      GPSTime",
            "     (DMY)        (HMS)",
            0,
            BEGIN_NS,
        ),
        ("07:08:09.250", "     UTCTime", "       (HMS)", Dating.DAY, BEGIN_NS % (86400 * 10**9)),
        (f"{WEEK_S}.250", "   GPSTime", "     (sec)", Dating.WEEK, WEEK_S * 10**9),
    ],
)
def test_times_are_what_the_columns_say(tmp_path, time, names, units, dating, t_ns):
    text = logs.exported(f"{time} {PLAIN}", names=names + PLACE_NAMES, units=units + PLACE_UNITS)
    found = read(tmp_path, text, "walk.txt")

    assert found.dating == dating
    assert found.samples.t_ns[0] == t_ns + QUARTER_NS
    assert_at_place(found.samples)


@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_degrees_minutes_and_seconds_south_of_the_equator(tmp_path, encoding):
    text = logs.exported(
        f"{WEEK_S}.000 -0 30 36.0 16 36 0.0 250.25 1",
        names="  GPSTime     Latitude    Longitude    H-Ell Q",
        units="    (sec)  (+/-D M S)  (+/-D M S)      (m)",
    )
    samples = read(tmp_path, text.encode(encoding), "walk.txt").samples

    assert np.rad2deg(samples.lat_rad[0]) == pytest.approx(-0.51)
    assert np.rad2deg(samples.lon_rad[0]) == pytest.approx(16.6)
    assert samples.height_m[0] == 250.25


def test_heights_above_sea_level_are_counted(tmp_path):
    text = logs.exported(
        f"{WEEK_S} {PLAIN}",
        names="  GPSTime    Latitude    Longitude    H-MSL",
        units="    (sec)" + PLACE_UNITS,
    )
    report = ImportReport()
    read(tmp_path, text, "walk.txt", report)

    assert report.counts["gnss_heights_orthometric"] == 1


@pytest.mark.parametrize(
    ("row", "names", "units", "error"),
    [
        (f"{WEEK_S} {PLAIN}", "  UTCTime", "    (sec)", "export GPSTime with Week"),
        (f"{WEEK_S} 91.0 16.6 250.0", "  GPSTime", "    (sec)", "place on the earth"),
        (f"nan {PLAIN}", "  GPSTime", "    (sec)", "line 7: expected seconds, got 'nan'"),
        (f"{WEEK_S} 49.2", "  GPSTime", "    (sec)", "expected 4 cells or more, got 2"),
    ],
)
def test_what_cannot_be_read_is_refused_with_its_reason(tmp_path, row, names, units, error):
    text = logs.exported(row, names=names + PLACE_NAMES, units=units + PLACE_UNITS)

    with pytest.raises(CorruptFile, match=error):
        read(tmp_path, text, "walk.txt")


def test_an_export_without_rows_is_empty_and_without_height_refused(tmp_path):
    names, units = "  GPSTime    Latitude    Longitude", "    (sec)       (deg)        (deg)"

    with pytest.raises(EmptyRecording):
        read(tmp_path, logs.exported(names=names + "   H-Ell", units=units + "     (m)"), "a.txt")
    with pytest.raises(CorruptFile, match="expected a column H-Ell or H-MSL"):
        read(tmp_path, logs.exported(f"{WEEK_S} 49.2 16.6", names=names, units=units), "b.txt")


def test_damaged_lines_are_counted_and_tables_are_no_exports(tmp_path):
    report = ImportReport()
    rows = logs.exported_rows(40)
    samples = read(tmp_path, rows + f"{LEAP_S} half a line\n", "walk.txt", report).samples

    assert len(samples) == 40
    assert report.counts["gnss_lines_damaged"] == 1
    table = tmp_path / "gnss.csv"
    table.write_text("time,latitude,longitude,height\n1.0,49.2,16.6,250.0\n")
    assert not is_gnss_file(table)
    assert read_gnss(tmp_path / "walk.txt").format == "Inertial Explorer"
