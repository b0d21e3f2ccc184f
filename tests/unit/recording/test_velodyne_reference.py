"""Real packets against two decoders of other people.

``packets/nebula`` holds packets with point clouds of the Nebula driver. It differs from the physics
of the manuals in ways that its own numbers show, so each is written down and tested here:

- heights: it leaves out the vertical beam offsets (compared without them);
- azimuth in the last firing of a packet: it repeats that of the block, it does not interpolate;
- azimuth of returns that come from the odd blocks of dual mode: it takes that of the next firing,
  so that two returns of one shot point to different directions;
- VLP-32C: it lets the 32 lasers fire one after the other every 2.304 µs (73.7 µs in all, longer
  than the firing cycle of 55.296 µs), where the manual fires them in pairs;
- time in dual return mode: it counts two blocks of one firing as two firings. Its time stamps
  count from the start of the packet; it computes in single precision (0.12 µs).

``velodyne-decoder`` reads heights, pairs and dual mode as we do.
"""

import numpy as np
import pytest
import velodyne_decoder
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from scipy.spatial import cKDTree

from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import PacketSensor
from recon4.recording.packets.velodyne.data_packets import (
    PacketSource,
    decode_packets,
)
from recon4.recording.packets.velodyne.models import DATA_SIZE, DUAL, MODELS, velodyne_model
from recon4.recording.packets.velodyne.sound_packets import as_packets
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import rig_to_complete
from recon4.recording.samples.clean import join
from tests.unit.recording.packet_builders import WIDE, rig, sensor
from tests.warned import K, warned

PCD_VLP16 = np.dtype(
    [
        *[("xyz", "<f4", 3), ("intensity", "u1"), ("return_type", "u1"), ("channel", "<u2")],
        *[("azimuth", "<f4"), ("elevation", "<f4"), ("distance", "<f4"), ("time_stamp", "<u4")],
    ]
)


def packets_of_bag(folder):
    types = get_typestore(Stores.ROS2_HUMBLE)
    packet = "builtin_interfaces/Time stamp\nuint8[1206] data"
    scan = "std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets"
    types.register(get_types_from_msg(packet, "velodyne_msgs/msg/VelodynePacket"))
    types.register(get_types_from_msg(scan, "velodyne_msgs/msg/VelodyneScan"))
    bag = next(path for path in folder.iterdir() if path.is_dir())
    with AnyReader([bag], default_typestore=types) as reader:
        messages = [types.deserialize_cdr(raw, c.msgtype) for c, _, raw in reader.messages()]
    return np.stack([p.data for message in messages for p in message.packets])


def reference_cloud(folder, dtype):
    raw = next(folder.glob("*.pcd")).read_bytes()
    return np.frombuffer(raw.split(b"DATA binary\n", 1)[1], dtype)


def stamps_ns(payloads):
    return as_packets(payloads)["time_us"].astype(np.int64) * 1000


def decoded(payloads, model):
    shots = decode_packets(
        stamps_ns(payloads),
        payloads,
        PacketSource(0, velodyne_model(model), WIDE),
        report=ImportReport(),
    )
    return shots, in_packets(shots, payloads)


def in_packets(shots, payloads):
    """Row of the packet of each shot and its time in there [ns]."""
    start = stamps_ns(payloads)
    row = np.searchsorted(start, shots.t_ns, side="right") - 1
    return row, shots.t_ns - start[row]


def spherical(xyz):
    """Range [m], azimuth clockwise [deg], elevation [deg]."""
    distance = np.linalg.norm(xyz, axis=1)
    azimuth = np.rad2deg(np.arctan2(-xyz[:, 1], xyz[:, 0])) % 360
    return distance, azimuth, np.rad2deg(np.arcsin(xyz[:, 2] / distance))


def centered(shots, model):
    """Points without the vertical offsets of the beams."""
    table = MODELS[model]
    height = table.height_m[np.argsort(table.ring)][shots.ring]
    return shots.xyz.astype(np.float64) - np.column_stack([0 * height, 0 * height, height])


def angle_between(a_deg, b_deg):
    return (np.asarray(a_deg) - b_deg + 180) % 360 - 180


def keyed(laser, units, intensity, azimuth_deg):
    """Plane in which two returns are near if they are equal and point almost the same way."""
    key = (np.asarray(laser, dtype=np.int64) << 24) + (np.rint(units).astype(np.int64) << 8)
    return np.column_stack([10.0 * (key + intensity), azimuth_deg])


def sequence_of(t_ns):
    """0 or 1: which firing of a VLP-16 block a time in a packet belongs to."""
    return (np.asarray(t_ns, dtype=np.int64) + 200) // 55_296 % 2


def partners(wanted, offered, limit_deg=0.01):
    """Row of the nearest of the offered for each wanted, -1 beyond the limit."""
    off, row = cKDTree(offered).query(wanted, distance_upper_bound=limit_deg)
    return np.where(np.isfinite(off), row, -1)


def test_every_point_of_the_dual_return_vlp16_reference_is_found(data):
    folder = data("packets/nebula/velodyne/vlp16")
    payloads = packets_of_bag(folder)
    cloud = reference_cloud(folder, PCD_VLP16)
    shots, (packet, since_ns) = decoded(payloads, "VLP-16")
    assert set(as_packets(payloads)["return_mode"]) == {DUAL}

    # The cloud is the last revolution: that of the last message and what spills over.
    rows = np.flatnonzero(packet >= len(payloads) - 160)
    distance, azimuth, elevation = (column[rows] for column in spherical(centered(shots, "VLP-16")))
    pair = since_ns[rows] // 110_592
    wire = as_packets(payloads)["blocks"]["azimuth_cdeg"] / 100
    from_last = np.where(pair == 5, wire[packet[rows], 10], azimuth)
    from_strongest = wire[packet[rows], np.minimum(2 * pair + 2, 10)]
    laser = shots.ring[rows] + 16 * sequence_of(since_ns[rows])
    same = (laser, distance / 0.002, shots.intensity[rows])
    wanted = keyed(
        cloud["channel"] + 16 * sequence_of(cloud["time_stamp"]),
        cloud["distance"] / 0.002,
        cloud["intensity"],
        np.rad2deg(cloud["azimuth"]),
    )
    last = partners(wanted, keyed(*same, from_last))
    strongest = partners(wanted, keyed(*same, from_strongest))

    def agrees(found, blocks):
        excess_ns = cloud["time_stamp"].astype(np.int64) - since_ns[rows][found]
        return (found >= 0) & (np.abs(excess_ns - blocks[found] * 110_592) < 130)

    in_even = agrees(last, pair) | agrees(last, np.where(pair == 5, 6, pair))
    in_odd = agrees(strongest, pair + 1)
    assert len(cloud) == 14831
    assert np.all(in_even | in_odd)
    assert in_even.sum() > 14400
    found = np.where(in_even, last, strongest)
    assert np.abs(distance[found] - cloud["distance"]).max() < 1e-5
    ref_elevation = np.rad2deg(np.arcsin(cloud["elevation"]))  # the field holds the sine
    assert np.abs(elevation[found] - ref_elevation).max() < 0.001


def test_every_point_of_the_vlp32c_reference_is_found(data):
    folder = data("packets/nebula/velodyne/vlp32")
    payloads = packets_of_bag(folder)
    cloud = reference_cloud(folder, "<f4").reshape(-1, 3).astype(np.float64)
    shots, (packet, since_ns) = decoded(payloads, "VLP-32C")

    table = MODELS["VLP-32C"]
    distance, azimuth, elevation = spherical(centered(shots, "VLP-32C"))
    ref_distance, ref_azimuth, ref_elevation = spherical(cloud)
    ref_ring = np.argmin(
        np.abs(ref_elevation[:, None] - np.rad2deg(np.sort(table.elevation_rad))), 1
    )
    block = since_ns // 55_296
    laser = np.argsort(table.ring)[shots.ring]
    wire = as_packets(payloads)["blocks"]["azimuth_cdeg"].astype(int)
    step = (np.roll(wire, -1, axis=1) - wire) % 36000
    step[:, 11] = 0
    shared = wire[packet, block] + step[packet, block] * laser * 2.304 / 55.296
    as_reference = (shared + table.azimuth_offset_cdeg[laser]) / 100 % 360
    first = np.flatnonzero(packet < 77)
    wanted = keyed(ref_ring, ref_distance / 0.004, 0, ref_azimuth)
    offered = keyed(shots.ring[first], distance[first] / 0.004, 0, as_reference[first])
    found = partners(wanted, offered)
    assert np.all(found >= 0)
    found = first[found]

    assert len(cloud) == 26216
    assert np.abs(distance[found] - ref_distance).max() < 1e-5
    assert np.abs(elevation[found] - ref_elevation).max() < 0.001
    assert np.abs(angle_between(as_reference[found], ref_azimuth)).max() < 0.01
    # And ours, with pairs, is at most 16 lasers of 2.304 µs away from it.
    assert np.abs(angle_between(azimuth[found], ref_azimuth)).max() < 0.15


def by_velodyne_decoder(payloads, model):
    payloads = payloads.copy()
    payloads[:, -1] = MODELS[model].product  # it refuses packets with another product byte
    config = velodyne_decoder.Config(
        model=getattr(velodyne_decoder.Model, model.replace("-", "")), min_range=0, max_range=1000
    )
    decoder = velodyne_decoder.StreamDecoder(config)
    seconds = stamps_ns(payloads) / 1e9
    scans = [
        decoder.decode(t, packet.tobytes())
        for t, packet in zip(seconds.tolist(), payloads, strict=True)
    ]
    scans = [scan for scan in [*scans, decoder.finish()] if scan is not None]
    t_ns = [scan[0].device * 1e9 + scan[1][:, 4].astype(np.float64) * 1e9 for scan in scans]
    return np.concatenate(t_ns) % 3.6e12, np.concatenate([scan[1] for scan in scans])


@pytest.mark.parametrize(
    ("name", "model"),
    [
        ("veloview/vlp-16-test-90deg-1-50-frames.pcap", "VLP-16"),
        ("veloview/monterey-first-100-packets.pcap", "HDL-32E"),
        ("mrpt/sample_velodyne_vlp16_gps.pcap", "VLP-16"),
        ("mrpt/sample_velodyne_hdl32.pcap", "HDL-32E"),
    ],
)
def test_velodyne_decoder_gives_the_same_points(data, name, model):
    path = data("packets") / name
    (batch,) = read_pcap(path, ImportReport())
    payloads = batch.payloads(np.flatnonzero(batch.length == DATA_SIZE), DATA_SIZE)

    shots, _ = decoded(payloads, model)
    t_ns, points = by_velodyne_decoder(payloads, model)

    assert len(shots) == len(points)
    np.testing.assert_array_equal(shots.intensity, points[:, 3])
    assert np.abs(shots.t_ns % 3.6e12 - t_ns).max() < 10  # its times are single precision
    distance, azimuth, _ = spherical(shots.xyz)
    its_distance, its_azimuth, _ = spherical(points[:, :3].astype(np.float64))
    assert np.abs(distance - its_distance).max() < 2e-3
    # It averages the rotation rate over packets; we take the step of the very block. The encoder
    # of a real sensor jitters by a few 0.01°.
    off = np.abs(angle_between(azimuth, its_azimuth))
    assert np.percentile(off, 99) < 0.02
    assert off.max() < 0.05
    # HDL-32E: it rounds the elevations to 0.01° as the manual prints them; they are thirds.
    assert np.abs(shots.xyz[:, 2] - points[:, 2]).max() < 0.5e-3 + 6e-5 * distance.max()


def test_the_recordings_of_veloview_are_read_with_what_they_say(data):
    report = ImportReport()
    recording = PacketCapture(
        [data("packets/veloview/vlp-16-test-90deg-1-50-frames.pcap")],
        rig(sensor("pucks", model="VLP-16")),
        settings=WIDE,
        report=report,
    )

    points = sum(len(part) for part in recording.read() if isinstance(part, Shots))

    assert points == 700400
    assert report.counts["packets"] == 1902
    assert not [name for name in report.counts if name.startswith("packets_")]
    assert recording.rotation_hz["pucks"] == pytest.approx(19.98, abs=0.01)
    assert warned(report, K.MODEL_CONTRADICTED, says="HDL-32E (0x21)", model="VLP-16")


def test_monterey_is_on_gps_time_with_positions_and_inertial_samples(data):
    report = ImportReport()
    recording = PacketCapture(
        [data("packets/veloview/monterey-first-100-packets.pcap")],
        rig_to_complete,
        settings=WIDE,
        report=report,
    )

    parts = list(recording.read())

    shots = [part for part in parts if isinstance(part, Shots) and len(part)]
    samples = [part for part in parts if not isinstance(part, Shots)]
    gnss = next(part.gnss for part in samples if part.gnss)
    imu = join([part.imu for part in samples if part.imu])
    assert (recording.rig.sensors[0].model, len(imu)) == ("HDL-32E", 299)
    # $GPRMC,220632 on 2012-12-11; the first shot 1.2 s later.
    assert gnss.t_ns[0] == np.datetime64("2012-12-11T22:06:32", "ns").astype(np.int64)
    assert shots[0].t_ns[0] == pytest.approx(gnss.t_ns[0] + 1.204e9, abs=1e6)
    assert np.rad2deg(gnss.lat_rad[0]) == pytest.approx(37 + 7.8324 / 60)
    # The car stands, then drives off forward; z is up.
    forward = imu.accel_m_s2[:, 0]
    assert imu.accel_m_s2[:, 2].mean() == pytest.approx(9.4, abs=0.2)
    assert forward[-100:].mean() - forward[:60].mean() == pytest.approx(1.2, abs=0.2)


def test_ninety_percent_of_a_real_recording_survive_ten_percent_of_garbage(data):
    path = data("packets/mrpt/sample_velodyne_vlp16_gps.pcap")
    (batch,) = read_pcap(path, ImportReport())
    rows = np.flatnonzero(batch.length == DATA_SIZE)
    payloads = batch.payloads(rows, DATA_SIZE)
    rng = np.random.default_rng(7)
    hit = rng.random(len(payloads)) < 0.1
    spoiled = payloads.copy()
    spoiled[hit] = rng.integers(0, 256, (int(hit.sum()), DATA_SIZE), dtype=np.uint8)

    clean, _ = decoded(payloads[~hit], "VLP-16")
    report = ImportReport()
    decoder = open_decoder(PacketSensor(row=0, sensor=sensor(), settings=WIDE, report=report))
    parts = [decoder.push(batch.t_ns[rows], spoiled), decoder.flush()]

    assert sum(len(part) for part in parts) == len(clean)
    assert report.counts["packets_wrong_flag"] == hit.sum()
