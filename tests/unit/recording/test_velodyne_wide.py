"""VLS-128 and HDL-64E against a recording's reference and against velodyne-decoder."""

import sqlite3
import struct
from pathlib import Path

import numpy as np
import pytest
import velodyne_decoder
from scipy.spatial import cKDTree

from recon4.errors import ConfigError
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.velodyne.family import FAMILY as VELODYNE
from recon4.recording.packets.velodyne.laser_calibration import (
    calibration_in_status,
    calibration_of_file,
)
from recon4.recording.packets.velodyne.models import DATA_PACKET, DATA_SIZE
from recon4.recording.packets.velodyne.wide_encode import encode_wide
from recon4.recording.packets.velodyne.wide_models import VLS128, hdl64_model
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.packet_builders import sensor
from tests.warned import derivations

ENTRY = np.dtype([("sec", "<i4"), ("ns", "<u4"), ("data", "u1", DATA_SIZE), ("pad", "u1", 2)])
FAR = IngestSettings(min_range_m=0.0, max_range_m=262.0)
CALIBRATIONS = Path(velodyne_decoder.__file__).parent / "calibrations"


def datagrams(payloads):
    return datagrams_of([10**18] * len(payloads), [row.tobytes() for row in payloads])


def decoded(model, payloads, companions=()):
    report = ImportReport()
    layout = VELODYNE.open(
        PacketSensor(
            row=0,
            sensor=sensor(model=model),
            head=datagrams(payloads[:50]),
            companions=companions,
            settings=FAR,
            report=report,
        )
    )
    payloads = payloads[layout.sound(payloads)]
    return layout, layout.decode(layout.stamps_ns(payloads), payloads), report


def scans_of_bag(folder):
    """Packets of each message: 36 bytes of header, then packets of 1216 bytes."""
    (file,) = folder.glob("*/*.db3")
    with sqlite3.connect(f"file:{file}?immutable=1", uri=True) as bag:
        rows = [row for (row,) in bag.execute("SELECT data FROM messages ORDER BY id")]
    entries = [np.frombuffer(row[36:] + b"\0\0", ENTRY)["data"] for row in rows]
    return [np.ascontiguousarray(entry) for entry in entries]


def test_every_point_of_the_vls128_reference_is_found_and_no_other(data):
    """Nebula takes each block for a firing: only lasers 96 to 127 turn on, to whole 0.01°.

    It leaves out the heights of the beams, and cuts the revolution inside the first and last
    packets of the message.
    """
    folder = data("packets/nebula/velodyne/vls128")
    (path,) = folder.glob("*.pcd")
    cloud = np.frombuffer(path.read_bytes().split(b"DATA binary\n", 1)[1], "<f4").reshape(-1, 3)
    payloads = scans_of_bag(folder)[1]
    layout, shots, _ = decoded("VLS-128", payloads)

    start_ns = layout.stamps_ns(payloads)
    packet = np.searchsorted(start_ns, shots.t_ns, side="right") - 1
    block = (shots.t_ns - start_ns[packet]) // 55_274 * 4
    laser = np.argsort(VLS128.elevation_rad)[shots.ring]
    wire = payloads.view(DATA_PACKET)[:, 0]["blocks"]["azimuth_cdeg"].astype(int)
    step = np.append(np.diff(wire, axis=1) % 36000, np.zeros((len(wire), 1), int), axis=1)
    turn = step[packet, block + laser // 32] * (VLS128.laser_time_s / VLS128.sequence_s)[laser]
    azimuth = np.rint(wire[packet, block] + turn + VLS128.azimuth_cdeg[laser])
    azimuth, elevation = np.deg2rad(azimuth / 100), VLS128.elevation_rad[laser]
    centered = shots.xyz - np.outer(VLS128.origin_m[2][laser], [0, 0, 1])
    range_m = np.linalg.norm(centered, axis=1)
    ray = [np.cos(elevation) * np.cos(azimuth), -np.cos(elevation) * np.sin(azimuth)]
    as_reference = range_m[:, None] * np.column_stack([*ray, np.sin(elevation)])

    off_m, row = cKDTree(as_reference).query(cloud)
    assert len(cloud) == 208680
    assert np.mean(off_m < 0.005) > 0.9996
    assert np.all(off_m < 0.001 + np.deg2rad(0.03) * np.linalg.norm(cloud, axis=1))
    left_out = np.setdiff1d(np.arange(len(shots)), row[off_m < 0.005])
    inside = (packet[left_out] > 10) & (packet[left_out] < len(payloads) - 13)
    assert inside.sum() < 0.0005 * len(cloud)
    # And ours, with the turn of every laser, is at most 16/20 of a step of 0.2° away from it.
    off_rad = np.linalg.norm(centered[row] - cloud, axis=1) / range_m[row]
    assert np.rad2deg(off_rad[off_m < 0.005]).max() < 0.175


def wall(count, model, *, dual=False, step_cdeg=20):
    """Times [µs], azimuths and returns in front of a smooth wall; second returns are nearer."""
    returns = 2 if dual else 1
    blocks = 12 // model.rows
    firings = 1 if dual and model.twins_beside else blocks // returns
    number = firings * np.arange(count)[:, None] + np.arange(blocks) // returns
    t_us = 1_000_000 + np.rint(1e6 * model.sequence_s * number[:, 0]).astype(np.int64)
    azimuth = 1000 + step_cdeg * number
    laser = np.arange(model.lasers)
    distance = 6000 + (5 * azimuth[:, :, None] + 37 * laser) % 3000
    second = (np.arange(blocks) % returns)[:, None]
    distance = distance - 400 * second
    intensity = np.broadcast_to(60 + laser // 2 + 20 * second, distance.shape)
    return t_us, azimuth, np.stack([distance, intensity], axis=-1)


def by_velodyne_decoder(payloads, model, calibration, t_us):
    read = velodyne_decoder.Calibration.read(str(calibration))
    config = velodyne_decoder.Config(model=model, calibration=read, min_range=0, max_range=1000)
    decoder = velodyne_decoder.StreamDecoder(config)
    times = (t_us / 1e6).tolist()
    scans = [decoder.decode(t, p.tobytes()) for t, p in zip(times, payloads, strict=True)]
    scans = [scan for scan in [*scans, decoder.finish()] if scan is not None]
    return np.concatenate([scan[1] for scan in scans])


@pytest.mark.parametrize("dual", [False, True])
@pytest.mark.parametrize(
    ("kind", "name"),
    [
        ("S2", "HDL-64E_S2.1-sztaki.yml"),
        ("S3", "HDL-64E_S3-VeloView.yml"),
        ("S3", "HDL-64E_S3-xiesc.yml"),
    ],
)
def test_velodyne_decoder_gives_the_same_points_of_an_hdl64(kind, name, dual):
    path = CALIBRATIONS / name
    file = Companion(path.name, path.read_bytes())
    model = hdl64_model(calibration_of_file(file), s3=kind == "S3")
    t_us, azimuth, returns = wall(40, model, dual=dual)
    payloads = encode_wide(t_us, azimuth, returns, model=model, dual=dual)
    layout, shots, report = decoded("HDL-64E", payloads, [file])

    theirs = by_velodyne_decoder(
        payloads, getattr(velodyne_decoder.Model, f"HDL64E_{kind}"), path, t_us
    )

    assert f"an HDL-64E {kind}" in derivations(report)[0]
    assert layout.packet_s == pytest.approx(model.packet_s(dual=dual))
    assert len(shots) == len(theirs) == 40 * 12 * 32
    assert np.all(np.diff(shots.t_ns) >= 0)
    off_m, row = cKDTree(theirs[:, :3].astype(np.float64)).query(shots.xyz)
    # It rounds azimuths to 0.01°, which is 1.5 mm here.
    assert off_m.max() < 0.005
    near = off_m < 0.005
    assert np.abs(shots.intensity[near] - theirs[row[near], 3]).max() <= 1.01
    first_us = theirs[:, 4].min()
    late = (shots.t_ns[near] - shots.t_ns.min()) / 1000 - 1e6 * (theirs[row[near], 4] - first_us)
    assert np.abs(late).max() < 0.1
    assert shots.echo.sum() == (len(shots) // 2 if dual else 0)


def test_a_vls128_of_two_returns_has_one_firing_a_packet():
    t_us, azimuth, returns = wall(30, VLS128, dual=True)
    payloads = encode_wide(t_us, azimuth, returns, model=VLS128, dual=True)
    single = encode_wide(*wall(10, VLS128), model=VLS128)

    layout, shots, _ = decoded("VLS-128", payloads)
    found = VELODYNE.recognize(datagrams(payloads), ())
    _, once, _ = decoded("VLS-128", single)

    assert (found.model, found.mode) == ("VLS-128", "dual")
    assert layout.packet_s == found.packet_s == pytest.approx(55.274e-6)
    assert (len(shots), int(shots.echo.sum())) == (30 * 256, 30 * 128)
    assert shots.t_ns[:2].tolist() == [t_us[0] * 1000 - 8700] * 2
    # Laser 127 fires 16 slots of 20 after the first: at 16/20 of the step of 0.2°.
    last = shots.ring == np.argsort(np.argsort(VLS128.elevation_rad))[127]
    x, y = shots.xyz[last][0, :2]
    turned = np.rad2deg(np.arctan2(-y, x)) - VLS128.azimuth_cdeg[127] / 100
    assert turned == pytest.approx(10 + 0.2 * 16 / 20, abs=0.002)
    assert (len(once), once.echo.max()) == (10 * 384, 0)


def test_an_hdl64_without_its_calibration_is_refused_with_the_file_that_it_needs():
    model = hdl64_model(calibration_of_file(hdl64_yaml()), s3=True)
    payloads = encode_wide(*wall(10, model), model=model)

    assert VELODYNE.recognize(datagrams(payloads), ()).model == "HDL-64E"
    with pytest.raises(ConfigError, match=r"YAML of the ROS driver .* or the db\.xml"):
        decoded("HDL-64E", payloads)


def hdl64_yaml():
    path = CALIBRATIONS / "HDL-64E_S3-VeloView.yml"
    return Companion(path.name, path.read_bytes())


def test_the_xml_of_veloview_has_the_same_numbers_as_the_yaml():
    yaml = calibration_of_file(hdl64_yaml())
    items = "".join(
        f"<item><px><id_>{k}</id_><rotCorrection_>{np.rad2deg(yaml.rot_rad[k])}</rotCorrection_>"
        f"<vertCorrection_>{np.rad2deg(yaml.elevation_rad[k])}</vertCorrection_>"
        f"<distCorrection_>{100 * yaml.far_m[k]}</distCorrection_>"
        f"<distCorrectionX_>{100 * yaml.near_m[k, 0]}</distCorrectionX_>"
        f"<distCorrectionY_>{100 * yaml.near_m[k, 1]}</distCorrectionY_>"
        f"<vertOffsetCorrection_>{100 * yaml.up_m[k]}</vertOffsetCorrection_>"
        f"<horizOffsetCorrection_>{100 * yaml.aside_m[k]}</horizOffsetCorrection_>"
        f"<focalDistance_>{100 * yaml.focal[k, 0]}</focalDistance_>"
        f"<focalSlope_>{yaml.focal[k, 1]}</focalSlope_></px></item>"
        for k in range(64)
    )
    least = "".join(f"<item>{value}</item>" for value in yaml.focal[:, 2])
    text = (
        f"<!DOCTYPE boost_serialization>\n<DB><points_>{items}</points_>"
        f"<minIntensity_><count>64</count>{least}</minIntensity_></DB>"
    )

    xml = calibration_of_file(Companion("db.xml", text.encode()))

    for name in ("rot_rad", "elevation_rad", "far_m", "near_m", "up_m", "aside_m"):
        np.testing.assert_allclose(getattr(xml, name), getattr(yaml, name), atol=1e-9)
    np.testing.assert_allclose(xml.focal[:, :3], yaml.focal[:, :3])


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"lasers: [1, 2]\nlaser_id: 3",
        b"lasers:\n- {laser_id: 0, rot_correction: .nan, vert_correction: 0}",
        b"laser_id: [" * 3000,
        b"<id_>--</id_><rotCorrection_>e</rotCorrection_>",
        b"\xff\xfelaser_id",
        b"".join(b"- {laser_id: %d, vert_correction: 0.1}\n" % k for k in range(128)),
    ],
)
def test_other_files_are_no_calibration(content):
    assert calibration_of_file(Companion("a.yaml", content)) is None


def test_the_calibration_is_read_from_the_status_bytes_of_the_packets():
    """One byte a packet: 7 rows of the table, then 9 of time and temperature."""
    yaml = calibration_of_file(hdl64_yaml())
    rows = b"".join(
        struct.pack(
            "<BhhhhhhhhhBB7x",
            k,
            round(np.rad2deg(yaml.elevation_rad[k]) * 100),
            round(np.rad2deg(yaml.rot_rad[k]) * 100),
            *(round(1000 * value) for value in (yaml.far_m[k], *yaml.near_m[k])),
            *(round(1000 * value) for value in (yaml.up_m[k], yaml.aside_m[k])),
            *(0, 0, 40, 255),
        )
        for k in range(64)
    )
    block = b"UNIT#\x18\x18" + rows + bytes(21)
    assert len(block) == 1820
    stream = block[900:] + block[:900]  # it begins anywhere
    kinds = b"HMSDNYGTV"
    packets = []
    for at in range(0, len(stream), 7):
        packets += [(kind, 9) for kind in kinds]
        packets += [(49 + k, value) for k, value in enumerate(stream[at : at + 7])]
    payloads = np.zeros((len(packets), DATA_SIZE), np.uint8)
    payloads[:, -2:] = packets

    found = calibration_in_status(payloads)

    assert np.abs(found.elevation_rad - yaml.elevation_rad).max() < np.deg2rad(0.0051)
    assert np.abs(found.far_m - yaml.far_m).max() < 0.00051
    assert np.abs(found.near_m - yaml.near_m).max() < 0.00051
    assert len(payloads) == 4160
    assert calibration_in_status(payloads[:-20]) is None
