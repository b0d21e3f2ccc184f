"""Positions in files of receivers and of their post-processing, as they come."""

import gzip

import numpy as np
import pytest

from recon4.errors import CorruptFile, EmptyRecording, UnknownFormat
from recon4.model.gps_time import GPS_EPOCH_NS, utc_of_gps_ns
from recon4.model.samples import GnssQuality
from recon4.recording.gnss.files import is_gnss_file, read_gnss
from recon4.recording.gnss.receiver_logs import read_receiver_log
from recon4.recording.gnss.records import Dating
from recon4.recording.gnss.rtklib import read_rtklib
from recon4.recording.info.describe import describe
from recon4.recording.kinds import RecordingKind, recognize
from recon4.recording.report import ImportReport
from tests import gnss_logs as logs
from tests.gnss_logs import BEGIN_NS, PLACE
from tests.warned import derivations

LAT, LON, HEIGHT = PLACE
QUARTER_NS = 250_000_000


def read(tmp_path, data, name="a.log", report=None):
    path = tmp_path / name
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return read_gnss(path, report)


def assert_at_place(samples, *, within_deg=1e-9, within_m=1e-4):
    assert np.rad2deg(samples.lat_rad[0]) == pytest.approx(LAT, abs=within_deg)
    assert np.rad2deg(samples.lon_rad[0]) == pytest.approx(LON, abs=within_deg)
    assert samples.height_m[0] == pytest.approx(HEIGHT, abs=within_m)


# -- RTKLIB


@pytest.mark.parametrize(
    ("row", "options"),
    [
        (logs.pos_rows()[0], {}),
        (f"2313 112107.250 {LAT} {LON} {HEIGHT}", {}),
        (f"2024/05/06 07:08:09.250 {LAT} {LON} {HEIGHT}", {"time": "UTC"}),
        (f"2024/05/06 16:08:09.250 {LAT} {LON} {HEIGHT}", {"time": "JST"}),
        (f"2024/05/06,07:08:27.250,{LAT},{LON},{HEIGHT}", {}),
        (
            f"2024/05/06 07:08:27.250 49 12 0.0 16 36 0.0 {HEIGHT}",
            {"columns": "latitude(d'\") longitude(d'\") height(m)"},
        ),
        (
            "2024/05/06 07:08:27.250 4001750.4876 1192973.6333 4805311.1424",
            {"columns": "x-ecef(m) y-ecef(m) z-ecef(m)"},
        ),
    ],
)
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_solution_of_rtklib_is_at_its_place_and_time(tmp_path, row, options, encoding):
    found = read(tmp_path, logs.pos(row, **options).encode(encoding), "walk.pos").samples

    assert_at_place(found, within_deg=2e-9, within_m=2e-4)
    assert found.t_ns.tolist() == [BEGIN_NS + QUARTER_NS]
    assert found.quality.tolist() == [GnssQuality.RTK_FIXED]
    if "ecef" not in str(options):
        assert found.sd_enu_m.tolist() == [[0.01, 0.02, 0.03]]


@pytest.mark.parametrize(
    "base", [f"{LAT} {LON} {HEIGHT}", "4001750.4876 1192973.6333 4805311.1424"]
)
def test_a_baseline_is_placed_at_its_base(tmp_path, base):
    row = "2024/05/06 07:08:27.250 0.0 100.0 5.0"
    text = logs.pos(row, columns="e-baseline(m) n-baseline(m) u-baseline(m)")
    found = read(tmp_path, f"% ref pos   : {base}\n{text}", "a.pos").samples

    assert np.rad2deg(found.lat_rad[0]) == pytest.approx(LAT + 8.991e-4, abs=1e-7)
    assert found.height_m[0] == pytest.approx(HEIGHT + 5.0008, abs=1e-3)
    with pytest.raises(CorruptFile, match=r"east, north, up of a baseline.*'ref pos', got none"):
        read(tmp_path, text, "b.pos")


def test_heights_that_a_solution_does_not_explain_are_counted(tmp_path):
    for head, counted in (
        ("ellipsoidal", {}),
        ("geodetic", {"gnss_heights_orthometric": 1}),
        ("", {"gnss_heights_unstated": 1}),
    ):
        text = logs.pos(*logs.pos_rows()).removeprefix(logs.POS_HEAD)
        report = ImportReport()
        read(tmp_path, f"% (lat/lon/height=WGS84/{head},\n{text}" if head else text, "a", report)
        assert dict(report.counts) == counted


def test_damaged_lines_of_a_solution_are_counted_and_many_refused(tmp_path):
    rows = logs.pos_rows(30)
    report = ImportReport()
    rows[3] = rows[3].replace("49.", "149.")
    found = read(tmp_path, logs.pos(*rows), "a.pos", report).samples
    assert len(found) == 29
    assert report.counts["gnss_lines_damaged"] == 1
    rows[7:17] = ["rubbish"] * 10
    with pytest.raises(CorruptFile, match=r"a.pos: line 6: no latitude.*11 of 30 lines"):
        read(tmp_path, logs.pos(*rows), "a.pos")
    with pytest.raises(CorruptFile, match="expected times in GPST, UTC or JST, got 'BDT'"):
        read(tmp_path, logs.pos(*rows[:3], time="BDT"), "a.pos")
    with pytest.raises(EmptyRecording, match="no solution under the comments"):
        read(tmp_path, logs.pos(), "a.pos")


@pytest.mark.parametrize(("day", "leaps"), [("2016-12-31", 17), ("2017-01-01", 18)])
def test_gps_time_becomes_utc_with_the_leap_seconds_of_its_day(day, leaps):
    utc_ns = np.datetime64(f"{day}T00:00:00", "ns").astype(np.int64)
    assert utc_of_gps_ns(np.array([utc_ns + leaps * 10**9])).tolist() == [utc_ns]


# -- logs of receivers


def test_nav_pvt_is_read_with_its_kind_of_fix(tmp_path):
    kinds = {
        0x83: GnssQuality.RTK_FIXED,
        0x43: GnssQuality.RTK_FLOAT,
        0x03: GnssQuality.DIFFERENTIAL,
        0x01: GnssQuality.SINGLE,
    }
    data = b"".join(logs.nav_pvt(k, flags=flags) for k, flags in enumerate(kinds))
    data += logs.nav_pvt(9, flags=0) + logs.nav_pvt(10, valid=0x33)  # no fix; no whole second
    report = ImportReport()
    found = read(tmp_path, b"junk" + data, report=report)

    assert found.format == "UBX"
    assert_at_place(found.samples, within_deg=5e-8, within_m=5e-4)
    assert found.samples.quality.tolist() == list(kinds.values())
    assert found.samples.t_ns[0] == BEGIN_NS - QUARTER_NS
    assert found.samples.sd_enu_m[0] == pytest.approx([0.0099, 0.0099, 0.03], abs=1e-4)
    assert report.counts["gnss_no_fix"] == 2


def test_the_further_digits_of_hpposllh_are_used(tmp_path):
    found = read(tmp_path, logs.nav_pvt() + logs.nav_hpposllh()).samples
    assert np.rad2deg(found.lon_rad[0]) == pytest.approx(LON + 42e-9, abs=1e-10)
    assert found.height_m[0] == pytest.approx(HEIGHT + 4e-4, abs=1e-6)


def test_a_damaged_message_is_counted_and_those_around_it_are_read(tmp_path):
    bad = bytearray(logs.nav_pvt(1))
    bad[40] ^= 1
    report = ImportReport()
    found = read(tmp_path, logs.nav_pvt(0) + bytes(bad) + logs.nav_pvt(2), report=report)
    assert len(found.samples) == 2
    assert report.counts["gnss_messages_damaged"] == 1


def test_a_file_of_damaged_messages_is_refused_in_bounded_time(tmp_path):
    path = tmp_path / "a.ubx"
    path.write_bytes(b"\xb5\x62\x01\x07\x5c\x00" * 25_000)
    assert not is_gnss_file(path)
    with pytest.raises(CorruptFile, match=r"a\.ubx: expected messages.*20000 with a wrong"):
        read_receiver_log(path, ImportReport())


@pytest.mark.parametrize("log", [logs.bestpos, logs.bestposa, logs.inspvax])
def test_a_novatel_log_is_at_its_place_and_time(tmp_path, log):
    found = read(tmp_path, log() * 2).samples

    assert_at_place(found)
    assert found.t_ns[0] == BEGIN_NS
    assert found.quality[0] == GnssQuality.RTK_FIXED
    assert found.sd_enu_m[0] == pytest.approx([0.01, 0.02, 0.03], abs=1e-6)
    if log is logs.inspvax:
        assert np.rad2deg(found.rpy_ned_rad[0]) == pytest.approx([1, 2, 3])
    else:
        assert np.isnan(found.rpy_ned_rad).all()


def test_what_of_a_novatel_log_is_not_read_is_said(tmp_path):
    report = ImportReport()
    data = logs.bestpos() + logs.inspvax() + logs.inspvax(status=6) + logs.bestpos(time_status=20)
    found = read(tmp_path, data, report=report)

    assert found.format == "NovAtel INSPVAX"
    assert np.isnan(found.samples.rpy_ned_rad).any(axis=1).tolist() == [False, True]
    assert derivations(report) == [
        "Positions are those of INSPVAX; not read beside them: BESTPOS (1)."
    ]
    assert report.counts["gnss_no_fix"] == 1
    with pytest.raises(EmptyRecording, match=r"no fix in this log.*gnss_no_fix=2"):
        read(tmp_path, logs.bestpos(kind=0) * 2)


def test_sentences_have_the_date_that_the_log_tells_anywhere(tmp_path):
    zda = logs.nmea("GNZDA,070809.00,06,05,2024,00,00")
    gst = logs.nmea("GNGST,070809.00,,,,,0.02,0.01,0.03")
    found = read(tmp_path, logs.gga() + gst + logs.gga(1) + zda)

    assert found.dating is Dating.UTC
    assert found.samples.t_ns.tolist() == [BEGIN_NS, BEGIN_NS + 10**9]
    assert_at_place(found.samples, within_m=1e-3)
    assert found.samples.sd_enu_m[0].tolist() == [0.01, 0.02, 0.03]
    assert np.isnan(found.samples.sd_enu_m[1]).all()


def test_sentences_without_a_date_are_of_the_day_of_the_points(tmp_path):
    found = read(tmp_path, logs.gga() + logs.gga(1))
    assert (found.format, found.dating) == ("NMEA", Dating.DAY)
    assert found.dated(BEGIN_NS + 11 * 3600 * 10**9).t_ns[0] == BEGIN_NS
    assert found.dated(BEGIN_NS - 11 * 3600 * 10**9).t_ns[0] == BEGIN_NS
    assert found.dated(5 * 10**9).t_ns[0] == found.samples.t_ns[0]  # a clock from power-on


# -- SBET


def test_an_sbet_is_of_the_week_of_the_points_with_the_accuracies_beside_it(tmp_path):
    report = ImportReport()
    (tmp_path / "smrmsg_walk.out").write_bytes(logs.smrmsg())
    found = read(tmp_path, logs.sbet(), "sbet_walk.out", report)
    samples = found.dated(BEGIN_NS + 3 * 86400 * 10**9)

    assert (found.format, found.dating) == ("SBET", Dating.WEEK)
    assert samples.t_ns[0] == BEGIN_NS
    assert_at_place(samples)
    assert np.rad2deg(samples.rpy_ned_rad[0]) == pytest.approx([1, 2, 30])
    assert samples.sd_enu_m[0] == pytest.approx([0.01, 0.02, 0.03])
    assert set(samples.quality) == {GnssQuality.RTK_FIXED}
    assert derivations(report) == ["Accuracies of sbet_walk.out are those of smrmsg_walk.out."]


def test_an_sbet_without_accuracies_is_no_fixed_solution(tmp_path):
    report = ImportReport()
    found = read(tmp_path, logs.sbet(), "walk.sbet", report).samples
    assert set(found.quality) == {GnssQuality.SINGLE}
    assert np.isnan(found.sd_enu_m).all()
    assert "no smrmsg file" in derivations(report)[0]


def test_what_is_no_file_of_a_receiver_is_said_as_such(tmp_path):
    rng = np.random.default_rng(1)
    noise = tmp_path / "noise.bin"
    noise.write_bytes(rng.bytes(136 * 50))
    assert not is_gnss_file(noise)
    cut = tmp_path / "cut.sbet"
    cut.write_bytes(logs.sbet()[:-5])
    assert not is_gnss_file(cut)
    with pytest.raises(UnknownFormat, match="missing columns t_ns, lat_deg, lon_deg"):
        read(tmp_path, "a,b,c\n1,2,3\n", "a.csv")


@pytest.mark.parametrize(
    "data", [logs.pos(*logs.pos_rows(3)).encode(), logs.nav_pvt() * 2, logs.sbet()]
)
def test_info_describes_such_a_file(tmp_path, data):
    path = tmp_path / "file.out"
    path.write_bytes(data)
    assert recognize(path) is RecordingKind.GNSS_FILE
    assert "GNSS positions" in "\n".join(describe(path).lines())


# -- real files


def _errors_m(lat, lon, truth):
    """Horizontal distances from places [deg] to others [m]."""
    north = np.deg2rad(lat - truth[0]) * 6_371_000.0
    return np.hypot(north, np.deg2rad(lon - truth[1]) * 6_371_000.0 * np.cos(np.deg2rad(lat)))


def test_a_fixed_solution_between_houses_is_not_as_good_as_it_says(data):
    folder = data("gnss/rtklib/urban-kinematic")
    found = read_gnss(folder / "rover_rtk.pos").samples
    with gzip.open(folder / "reference.csv.gz", "rt") as file:
        truth = np.genfromtxt(file, delimiter=",", skip_header=1, usecols=(0, 1, 2, 3))
    of_week_ns = np.rint(truth[:, 0] * 10.0).astype(np.int64) * 100_000_000
    t_ns = utc_of_gps_ns(
        GPS_EPOCH_NS + truth[:, 1].astype(np.int64) * int(Dating.WEEK) + of_week_ns
    )
    row = np.searchsorted(t_ns, found.t_ns - 50_000_000)
    together = np.abs(t_ns[row] - found.t_ns) < 10_000_000
    assert together.mean() > 0.99
    off_m = _errors_m(np.rad2deg(found.lat_rad), np.rad2deg(found.lon_rad), truth[row, 2:4].T)
    fixed = together & (found.quality == GnssQuality.RTK_FIXED)
    usual, most = np.percentile(off_m[fixed], [50, 95])

    assert usual == pytest.approx(0.07, abs=0.02)
    assert most == pytest.approx(2.1, abs=0.3)
    assert np.median(found.sd_enu_m[fixed, 0]) < 0.01


def test_utc_of_a_solution_is_that_of_the_receivers_own_messages(data):
    folder = data("gnss/walk-imu")
    solution = read_gnss(folder / "gnss_1730_sf.pos").samples
    report = ImportReport()
    own = read_gnss(folder / "gnss_1730.ubx", report).samples

    assert np.abs(solution.t_ns - own.t_ns).max() < 2_000_000
    assert np.abs(solution.lat_rad - own.lat_rad).max() < 1e-12
    assert np.array_equal(solution.quality, own.quality)
    # That solution has heights above sea level, and does not say so.
    assert np.median(solution.height_m - own.height_m) == pytest.approx(21.39, abs=0.01)
    assert derivations(report) == [
        "gnss_1730.ubx: positions are those of UBX; not read: NMEA (536)."
    ]


def test_an_aircraft_flies_where_its_sbet_heads(data):
    found = read_gnss(data("gnss/applanix/als") / "sbet.out").samples
    north = found.lat_rad[-1] - found.lat_rad[0]
    east = (found.lon_rad[-1] - found.lon_rad[0]) * np.cos(found.lat_rad[0])
    course = np.rad2deg(np.arctan2(east, north)) % 360.0
    assert np.rad2deg(found.rpy_ned_rad[100, 2]) == pytest.approx(course, abs=6.0)  # drift by wind


def test_a_novatel_log_is_as_its_driver_decoded_it(data):
    found = read_gnss(data("gnss/novatel") / "BESTPOS.GPS").samples
    assert len(found) == 1000
    assert found.height_m[0] == pytest.approx(1059.7447 - 16.9)
    assert found.sd_enu_m[0].tolist() == [1.5644, 1.8736, 2.8763]


def test_a_solution_of_no_time_is_a_damaged_line(tmp_path):
    path = tmp_path / "a.pos"
    lines = [f"2026/11/27 10:00:{k}.0 48.1 16.3 200 1 9" for k in range(10, 50)]
    head = "% GPST latitude(deg) longitude(deg) height(m) Q ns"
    path.write_text(
        "\n".join([head, *lines, "2026/11/27 9999999999:00:00.0 48.1 16.3 200 1 9", ""]), "utf-8"
    )
    report = ImportReport()

    assert len(read_rtklib(path, report).samples) == 40
    assert report.counts["gnss_lines_damaged"] == 1


def test_a_base_that_is_nowhere_on_the_earth_is_refused(tmp_path):
    path = tmp_path / "a.pos"
    lines = ["% ref pos : 128.2 16.6 250.0"]
    lines += ["% GPST e-baseline(m) n-baseline(m) u-baseline(m) Q ns"]
    lines += [f"2026/11/27 10:00:0{k}.0 1.0 2.0 3.0 1 9" for k in range(9)]
    path.write_text("\n".join([*lines, ""]), "utf-8")

    with pytest.raises(CorruptFile, match=r"expected a base on the earth.*128\.2"):
        read_rtklib(path, ImportReport())
