"""Packets as a replay sends them: later, and else the same, in every family."""

import numpy as np
import pytest

from recon4.model.samples import ImuSamples
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.hesai.encode import encode_jt16_inertial
from recon4.recording.packets.hesai.family import FAMILY as HESAI
from recon4.recording.packets.hesai.inertial import Jt16Inertial
from recon4.recording.packets.hesai.models import MODELS as HESAI_MODELS
from recon4.recording.packets.hesai.stamps import date_of, time_ns
from recon4.recording.packets.livox.family import FAMILY as LIVOX
from recon4.recording.packets.livox.models import LAYOUTS
from recon4.recording.packets.livox.sound import has_crc, stamps_ns
from recon4.recording.packets.ouster.encode import encode_imu, metadata_json
from recon4.recording.packets.ouster.family import FAMILY as OUSTER
from recon4.recording.packets.ouster.imu_packets import sound_imu
from recon4.recording.packets.ouster.layouts import LEGACY_IMU, PROFILES
from recon4.recording.packets.replay import Restamping
from recon4.recording.packets.robosense.encode import encode_imu as encode_airy_imu
from recon4.recording.packets.robosense.family import FAMILY as ROBOSENSE
from recon4.recording.packets.robosense.imu_packets import is_imu
from recon4.recording.packets.robosense.models import IMU_PACKET
from recon4.recording.packets.robosense.models import MODELS as ROBOSENSE_MODELS
from recon4.recording.packets.robosense.packets import stamps_of
from recon4.recording.packets.streams import recognized
from recon4.recording.packets.velodyne.family import FAMILY as VELODYNE
from recon4.recording.report import ImportReport
from tests.security.fuzz.kinds_livox import packets_of as livox_packets
from tests.security.fuzz.kinds_ouster import metadata_of
from tests.security.fuzz.kinds_ouster import opened as ouster_format
from tests.security.fuzz.kinds_ouster import packets_of as ouster_packets
from tests.unit.recording.packet_builders import spin
from tests.unit.recording.test_hesai_packets import opened as hesai_opened
from tests.unit.recording.test_hesai_packets import spin as hesai_spin
from tests.unit.recording.test_livox_packets import opened as livox_opened
from tests.unit.recording.test_robosense_packets import datagrams, device_of
from tests.unit.recording.test_robosense_packets import opened as robosense_opened
from tests.unit.recording.test_robosense_packets import spin as robosense_spin

SHIFT_NS = 400 * 86_400_000_000_000 + 12_345_678_901_000
"""More than a year, and no whole hours."""


def hesai_case(name):
    payloads = hesai_spin(HESAI_MODELS[name], packets=4)[2]
    return HESAI, payloads, hesai_opened(HESAI_MODELS[name], payloads)[0]


def livox_case(layout):
    payloads = livox_packets(layout, 4)
    head = datagrams_of(range(len(payloads)), [row.tobytes() for row in payloads])
    return LIVOX, payloads, livox_opened(layout, head)


def ouster_case(profile):
    metadata = metadata_of(profile)
    payloads = ouster_packets(metadata, 4)
    head = datagrams_of(range(len(payloads)), [row.tobytes() for row in payloads])
    return OUSTER, payloads, ouster_format(metadata_json(metadata), head, ImportReport())


def robosense_case(name):
    model = ROBOSENSE_MODELS[name]
    payloads = robosense_spin(model, 4)[1]
    return ROBOSENSE, payloads, robosense_opened(name, beside=datagrams(device_of(model)))


CASES = [
    *[pytest.param(hesai_case, name, id=f"Hesai {name}") for name in HESAI_MODELS],
    *[pytest.param(livox_case, one, id=f"Livox {one.sdk}.{one.data_type}") for one in LAYOUTS],
    *[pytest.param(ouster_case, name, id=f"Ouster {name}") for name in PROFILES],
    *[pytest.param(robosense_case, name, id=f"RoboSense {name}") for name in ROBOSENSE_MODELS],
]


@pytest.mark.parametrize(("case", "kind"), CASES)
def test_packets_of_later_have_the_same_points_at_later_times(case, kind):
    family, payloads, layout = case(kind)
    payloads = payloads.copy()
    payloads[-1, :20] ^= 0x5A  # damaged: it stays as it is

    later = family.restamped(payloads, SHIFT_NS, ())

    sound = layout.sound(payloads)
    assert sound.sum() == len(payloads) - 1
    assert np.array_equal(layout.sound(later), sound), "with right sums"
    assert np.array_equal(later[-1], payloads[-1])
    before, after = layout.stamps_ns(payloads[sound]), layout.stamps_ns(later[sound])
    assert np.array_equal(after, before + SHIFT_NS)
    shots, moved = layout.decode(before, payloads[sound]), layout.decode(before, later[sound])
    assert len(shots) and np.array_equal(shots.xyz, moved.xyz)
    assert np.array_equal(shots.t_ns, moved.t_ns)


def test_a_stamp_of_velodyne_is_moved_within_the_hour():
    payloads = spin(4)[1]
    later = VELODYNE.restamped(payloads, 3_599_000_000_000, ())
    stamps = [p[:, 1200:1204].copy().view("<u4")[:, 0].astype(int) for p in (payloads, later)]
    assert np.array_equal(stamps[1], (stamps[0] + 3_599_000_000) % 3_600_000_000)
    rest = [np.delete(p, range(1200, 1204), axis=1) for p in (payloads, later)]
    assert np.array_equal(*rest)


def test_inertial_packets_are_moved_like_the_points():
    t_ns = 10**18 + 5_000_000 * np.arange(4)
    imu = ImuSamples(t_ns, np.full((4, 3), 0.1), np.full((4, 3), 3.0))

    ouster = OUSTER.restamped(encode_imu(t_ns, imu.accel_m_s2, imu.gyro_rad_s), SHIFT_NS, ())
    packets = ouster.view(LEGACY_IMU)[:, 0]
    assert sound_imu(ouster).all()
    for name in ("sent_ns", "accel_ns", "gyro_ns"):
        assert np.array_equal(packets[name].astype(int), t_ns + SHIFT_NS)

    airy = ROBOSENSE.restamped(encode_airy_imu(imu), SHIFT_NS, ())
    stamp = np.ascontiguousarray(airy.view(IMU_PACKET)[:, 0]["stamp"])
    assert is_imu(airy).all()
    assert np.array_equal(stamps_of(stamp, ns=False)[0], t_ns + SHIFT_NS)

    jt16 = encode_jt16_inertial(t_ns // 1000, np.ones((4, 6), int))
    later, found = Jt16Inertial().samples(HESAI.restamped(jt16, SHIFT_NS, ()))
    assert found.all()
    assert np.array_equal(later.t_ns, t_ns + SHIFT_NS)


def test_dates_keep_the_form_that_they_have():
    payloads = hesai_spin(HESAI_MODELS["XT32"], packets=4)[2]
    made, _ = hesai_opened(HESAI_MODELS["XT32"], payloads)
    later = HESAI.restamped(payloads, SHIFT_NS, ())
    at = made.packets.layout.tail_at + made.packets.layout.tail.date
    assert (payloads[:, at] >= 70).all() == (later[:, at] >= 70).all()
    early = date_of(np.array([1_700_000_000]))
    early[:, 0] -= 100  # as a Pandar40P counts its years
    assert time_ns(early, np.zeros(1, np.uint32))[0] == 1_700_000_000 * 10**9


def test_real_captures_are_moved_by_the_family_that_reads_them(data):
    for file in sorted(data("packets/ouster").glob("OS-[02]*10.pcap")):
        batch = next(read_pcap(file, ImportReport()))
        moved = Restamping().payloads(batch, SHIFT_NS)
        assert all(of_lidar for _, of_lidar in moved), file.name
        after = datagrams_of(batch.t_ns.tolist(), [payload for payload, _ in moved])
        assert recognized(after).family == recognized(batch).family == "Ouster"


def test_sums_of_livox_are_right_and_wrong_ones_stay_wrong():
    layout = next(one for one in LAYOUTS if one.sdk == 2)
    payloads = livox_packets(layout, 4).copy()
    payloads[2, 100] ^= 1
    later = LIVOX.restamped(payloads, SHIFT_NS, ())
    assert has_crc(later).tolist() == [True, True, False, True]
    assert np.array_equal(stamps_ns(later, 2), stamps_ns(payloads, 2) + SHIFT_NS)


def test_what_is_of_no_family_is_sent_as_it_was():
    batch = datagrams_of([1, 2, 3], [b"", b'{"t_ns": 7}', bytes(1206)])
    assert [payload for payload, _ in Restamping().payloads(batch, 5)][:2] == [b"", b'{"t_ns": 7}']
    assert [moved for _, moved in Restamping().payloads(batch, 5)][:2] == [False, False]
