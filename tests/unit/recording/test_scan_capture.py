"""Captured datagrams of a 2-D laser or a profiler: the same as their bag or log, and bad ones."""

import json
from dataclasses import replace

import numpy as np
import pytest

from recon4.errors import ConfigError, EmptyRecording, RecordingError
from recon4.model.laser_scans import LaserScans
from recon4.model.ports import PORTS
from recon4.model.rig import format_rig, load_rig, parse_rig
from recon4.model.samples import ImuSamples
from recon4.progress import Silent
from recon4.recording.info.describe import describe
from recon4.recording.ingest import ingest
from recon4.recording.lasers.laser2d import is_laser2d, read_laser2d
from recon4.recording.lasers.scan_capture import ScanCapture
from recon4.recording.lasers.scan_datagrams import (
    HeadMessage,
    ScanMessage,
    decode_scan_datagram,
    encode_head,
    encode_scan,
)
from recon4.recording.lasers.tuning import SCAN_DATAGRAMS
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings
from recon4.simulation.line_bag import open_line_bag
from recon4.store.frames import FrameStore
from recon4.store.line_store import load_laser_scans, load_lines
from tests.laser_rows import angles_of, rows_of, with_rows
from tests.planar_walks import furnished_room, scanned, write_carmen
from tests.scan_captures import DELAY_NS, captured, scan_datagrams, write_capture
from tests.security.fuzz.kinds_robosense import packets_of
from tests.warned import K, warned

START_NS = 1_700_000_000_000_000_000
LASER = parse_rig('[[sensor]]\nname = "laser2d"\nkind = "laser2d"', where="test")


@pytest.fixture(scope="module")
def scans():
    truth = np.stack([np.linspace(-2.0, 2.0, 60), np.zeros(60), np.zeros(60)], axis=1)
    found = scanned(furnished_room(), truth).scans
    return replace(found, t_ns=found.t_ns + START_NS)


def read(path, rig=LASER):
    report = ImportReport()
    items = list(ScanCapture((path,), rig, report=report).read())
    parts = [item for item in items if isinstance(item, LaserScans)]
    t_ns = np.concatenate([part.t_ns for part in parts]) if parts else np.zeros(0, np.int64)
    return t_ns, report, items


def test_a_capture_of_a_log_is_read_as_the_log(tmp_path, scans):
    write_carmen(tmp_path / "walk.log", scans)
    captured(tmp_path / "walk.log", tmp_path / "walk.pcap")

    of_log = read_laser2d([tmp_path / "walk.log"], ImportReport())
    found = read_laser2d([tmp_path / "walk.pcap"], ImportReport())

    assert is_laser2d(tmp_path / "walk.pcap")
    np.testing.assert_array_equal(found.t_ns, of_log.t_ns)
    np.testing.assert_array_equal(found.range_m, of_log.range_m)
    np.testing.assert_array_equal(found.odometry, of_log.odometry)
    np.testing.assert_array_equal(angles_of(found), angles_of(of_log))
    assert "60 scans of 271 beams" in "\n".join(describe(tmp_path / "walk.pcap").lines())


def line_bag(folder):
    t_ns = START_NS + 10_000_000 * np.arange(400, dtype=np.int64)
    lines = LaserScans.of_rows(
        t_ns,
        np.random.default_rng(2).uniform(2.0, 9.0, (400, 51)).astype(np.float32),
        angles=(-0.5, 0.02),
        range_max_m=100.0,
        time_step_s=1e-4,
    )
    scans = with_rows(lines[slice(0, 400, 10)], rows_of(lines)[::10, ::-1])
    with open_line_bag(folder) as bag:
        bag.head("/profiler/head", t_ns, 0.9 * 1e-9 * (t_ns - START_NS))
        bag.scans("/profiler/line", lines, np.full((400, 51), 7, np.uint8))
        bag.scans("/laser2d/scan", scans)
    return folder


def test_the_lines_of_a_capture_are_those_of_the_bag(tmp_path):
    rig = load_rig("wuerzburg")
    bag = line_bag(tmp_path / "bag")
    capture = captured(bag, tmp_path / "walk.pcap", rig)
    stores = []
    for recording in (bag, capture):
        out = tmp_path / f"of-{recording.name}"
        ingest(Sources((recording,), rig), out, settings=IngestSettings(), progress=Silent())
        stores.append(out)

    of_bag, of_capture = (FrameStore.open(out) for out in stores)
    lines = [load_lines(out) for out in stores]
    lasers = [load_laser_scans(out) for out in stores]

    text = "\n".join(describe(capture).lines())

    assert not is_laser2d(capture)
    assert "10.0.0.9:8312 profiler: 400 line scans, 100." in text
    assert "10.0.0.9:8311 2-D laser: 40 scans, 10.0 a second" in text
    assert len(of_bag) == len(of_capture) > 30
    for row in range(len(of_bag)):
        np.testing.assert_array_equal(of_bag[row].xyz, of_capture[row].xyz)
        np.testing.assert_array_equal(of_bag[row].dt_ns, of_capture[row].dt_ns)
        np.testing.assert_array_equal(of_bag[row].intensity, of_capture[row].intensity)
    np.testing.assert_array_equal(lines[0].head_rad, lines[1].head_rad)
    np.testing.assert_array_equal(lasers[0].range_m, lasers[1].range_m)
    np.testing.assert_array_equal(angles_of(lasers[0]), angles_of(lasers[1]))


def test_a_capture_without_a_rig_takes_the_shipped_one(tmp_path):
    capture = captured(line_bag(tmp_path / "bag"), tmp_path / "walk.pcap")

    ingest(Sources((capture,)), tmp_path / "out", settings=IngestSettings(), progress=Silent())

    report = json.loads((tmp_path / "out" / "report.json").read_text())
    assert report["rig"] == "wuerzburg"
    assert report["line_scans"] == 400


def test_scans_that_are_shuffled_or_doubled_are_counted(tmp_path, scans):
    sent = scan_datagrams(scans)
    swapped = [*sent[:10], sent[11], sent[10], *sent[12:20], sent[19], *sent[20:]]
    write_capture(tmp_path / "walk.pcap", swapped)

    t_ns, report, _ = read(tmp_path / "walk.pcap")

    assert len(t_ns) == len(scans) - 1
    assert report.counts["scans_out_of_order"] == 1
    assert report.counts["scans_repeated"] == 1
    assert warned(report, K.SCANS_LATE)


@pytest.mark.parametrize("jump_s", [-3600.0, 3600.0, -2.0])
def test_a_clock_that_jumps_is_continued_by_the_arrival(tmp_path, scans, jump_s):
    rest = scans[slice(30, 60)]
    jumped = replace(rest, t_ns=rest.t_ns + round(jump_s * 1e9))
    late = [(t - round(jump_s * 1e9), port, data) for t, port, data in scan_datagrams(jumped)]
    write_capture(tmp_path / "walk.pcap", scan_datagrams(scans[slice(0, 30)]) + late)

    t_ns, report, _ = read(tmp_path / "walk.pcap")

    np.testing.assert_array_equal(t_ns, scans.t_ns)
    assert report.counts["clock_jumps"] == report.counts["clock_jumps_of_laser2d"] == 1
    (jump,) = report.findings
    assert jump.kind is K.CLOCK_JUMP
    assert jump.values["jump_s"] == pytest.approx(jump_s, abs=0.05)


def test_a_jump_of_the_recorders_clock_leaves_the_scans_as_they_are(tmp_path, scans):
    sent = scan_datagrams(scans)
    write_capture(
        tmp_path / "walk.pcap",
        [
            (t + (1_500_000_000 if k > 30 else 0), port, data)
            for k, (t, port, data) in enumerate(sent)
        ],
    )

    t_ns, report, _ = read(tmp_path / "walk.pcap")

    np.testing.assert_array_equal(t_ns, scans.t_ns)
    assert report.counts["clock_jumps"] == 0


def test_a_silent_laser_is_no_jump(tmp_path, scans):
    sent = scan_datagrams(scans)
    write_capture(tmp_path / "walk.pcap", [*sent[:5], *sent[55:]])

    t_ns, report, _ = read(tmp_path / "walk.pcap")

    np.testing.assert_array_equal(t_ns, np.concatenate([scans.t_ns[:5], scans.t_ns[55:]]))
    assert not report.findings


@pytest.mark.parametrize(
    "payload",
    [
        b"",
        b"{",
        b"[1, 2]",
        b'{"ranges": []}',
        b'{"ranges": [1.0], "angle_min": 0.0}',
        b'{"ranges": ["a"], "angle_min": 0.0, "angle_increment": 0.1}',
        b'{"ranges": [1.0], "angle_min": 0.0, "angle_increment": 0.1, "t_ns": -5}',
        b'{"ranges": [1.0], "angle_min": 0.0, "angle_increment": 0.1, "range_max": NaN}',
        b'{"ranges": [1.0], "angle_min": 0.0, "angle_increment": 0.1, "odometry": [1.0]}',
        b'{"ranges":' + b"[" * 30_000,
        b'{"head_rad": "x"}',
        bytes(1206),
    ],
)
def test_a_datagram_that_is_no_scan_is_counted(tmp_path, scans, payload):
    assert decode_scan_datagram(payload) is None
    sent = scan_datagrams(scans)
    write_capture(
        tmp_path / "walk.pcap", [*sent[:9], (sent[9][0], PORTS.laser2d, payload), *sent[9:]]
    )

    t_ns, report, _ = read(tmp_path / "walk.pcap")

    assert len(t_ns) == len(scans)
    assert report.counts["scans_damaged"] == 1


@pytest.mark.parametrize(
    "angles",
    [
        b'"angle_min": 0.0, "angle_increment": 0.0',
        b'"angle_min": -135.0, "angle_increment": 0.25',
        b'"angle_min": 0.0, "angle_increment": 1e300',
    ],
)
def test_angles_that_are_no_radians_are_left_out(tmp_path, scans, angles):
    text = b'{"ranges": [1.0, 2.0], ' + angles + b"}"
    write_capture(
        tmp_path / "walk.pcap", [*scan_datagrams(scans), (START_NS * 2, PORTS.laser2d, text)]
    )

    t_ns, report, _ = read(tmp_path / "walk.pcap")

    assert len(t_ns) == len(scans)
    assert report.counts["scans_damaged"] == 1


def test_numbers_that_python_writes_and_json_does_not_have_are_no_returns():
    text = b'{"ranges": [1.5, NaN, Infinity, null], "angle_min": 0, "angle_increment": 0.1}'

    message = decode_scan_datagram(text)

    assert isinstance(message, ScanMessage)
    assert message.ranges == [1.5, None, None, None]


def test_a_scan_without_any_return_is_counted(tmp_path, scans):
    blind = replace(scans, range_m=np.full_like(scans.range_m, np.nan))
    write_capture(tmp_path / "walk.pcap", scan_datagrams(blind))

    _, report, _ = read(tmp_path / "walk.pcap")

    assert report.counts["scans_without_returns"] == len(scans)


def test_without_a_time_the_arrival_counts(tmp_path):
    text = b'{"ranges": [1.0, 2.0], "angle_min": 0.0, "angle_increment": 0.1}'
    write_capture(tmp_path / "walk.pcap", [(START_NS, PORTS.laser2d, text)])

    t_ns, _, _ = read(tmp_path / "walk.pcap")

    assert t_ns.tolist() == [START_NS]


def test_samples_of_an_imu_come_before_the_scans_of_their_time(tmp_path, scans):
    sample = b'{"gx_rad_s": 0.1, "gy_rad_s": 0.0, "gz_rad_s": 0.0}'
    sent = [(int(t) + DELAY_NS, 8309, sample) for t in scans.t_ns]
    both = sorted([*sent, *scan_datagrams(scans)], key=lambda one: one[0])
    write_capture(tmp_path / "walk.pcap", both)

    _, report, items = read(tmp_path / "walk.pcap")

    assert isinstance(items[0], ImuSamples)
    assert report.counts["imu_samples"] == len(scans)


def test_another_sender_is_left_out_where_the_rig_has_an_address(tmp_path, scans):
    text = format_rig(LASER).replace('address = ""', 'address = "10.0.0.8"')
    write_capture(tmp_path / "walk.pcap", scan_datagrams(scans))

    t_ns, _, _ = read(tmp_path / "walk.pcap", parse_rig(text, where="test"))

    assert len(t_ns) == 0


def test_one_port_for_both_scanners_is_refused(tmp_path):
    text = format_rig(load_rig("wuerzburg")).replace(f"port = {PORTS.profiler}", "port = 8311")

    with pytest.raises(ConfigError, match="both send to port 8311"):
        ScanCapture((tmp_path / "x",), parse_rig(text, where="test"), report=ImportReport())


def test_a_capture_of_other_datagrams_has_no_scans(tmp_path):
    write_capture(tmp_path / "walk.pcap", [(START_NS, PORTS.laser2d, b'{"t_ns": 1}')])

    assert not is_laser2d(tmp_path / "walk.pcap")
    with pytest.raises(EmptyRecording, match="no datagrams of a 2-D laser"):
        read_laser2d([tmp_path / "walk.pcap"], ImportReport())


def test_scans_beside_packets_of_a_lidar_of_any_make_are_no_walk_of_a_laser(tmp_path, scans):
    sent = scan_datagrams(scans)
    packets = packets_of("Helios 5515")
    data = [(t_ns, 6699, row.tobytes()) for (t_ns, *_), row in zip(sent, packets, strict=False)]
    write_capture(tmp_path / "walk.pcap", sorted([*sent, *data]))

    assert not is_laser2d(tmp_path / "walk.pcap")


def test_a_head_that_stands_all_the_time_is_refused(tmp_path):
    scan = ScanMessage(ranges=[3.0] * 20, angle_min=-0.5, angle_increment=0.05)
    sent = []
    for k in range(600):
        t_ns = START_NS + 10_000_000 * k
        sent.append((t_ns, PORTS.profiler, encode_head(0.3, t_ns)))
        sent.append((t_ns + 1, PORTS.profiler, encode_scan(scan, t_ns)))
    write_capture(tmp_path / "walk.pcap", sent)

    with pytest.raises(RecordingError, match="expected a head that turns"):
        read(tmp_path / "walk.pcap", load_rig("wuerzburg"))


def test_a_scan_with_too_many_beams_is_sent_without_its_intensities():
    rng = np.random.default_rng(1)
    ranges = rng.uniform(1.0, 30.0, 4000).astype(np.float32)
    scan = ScanMessage(
        ranges=ranges, angle_min=0.0, angle_increment=1e-3, intensities=rng.uniform(0, 1, 4000)
    )

    payload = encode_scan(scan, START_NS)
    found = decode_scan_datagram(payload)

    assert len(payload) < SCAN_DATAGRAMS.bytes
    np.testing.assert_array_equal(np.array(found.ranges, np.float32), ranges)
    assert found.intensities == []


def test_the_angle_of_a_head_is_decoded():
    assert decode_scan_datagram(encode_head(0.25, START_NS)) == HeadMessage(
        head_rad=0.25, t_ns=START_NS
    )
