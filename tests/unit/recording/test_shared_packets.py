"""Packets of two sensors in one topic of a bag: by what they say, or by the frame of messages."""

from types import SimpleNamespace

import numpy as np
import pytest
from rosbags.typesys import get_types_from_msg

from recon4.errors import ConfigError
from recon4.model.rig import parse_rig
from recon4.recording.info.describe import describe
from recon4.recording.packets.hesai.models import MODELS as HESAIS
from recon4.recording.packets.messages import PACKET_MESSAGES
from recon4.recording.packets.one_sender import require_one_sender
from recon4.recording.packets.ouster.encode import metadata_json
from recon4.recording.packets.robosense.models import MODELS as ROBOSENSES
from recon4.recording.packets.senders import parts_of
from recon4.recording.rigs.choice import RigToComplete, Stream, rig_to_complete
from tests.builders import bag_path
from tests.ouster_models import nominal_metadata
from tests.robot_bags import RobotBag
from tests.security.fuzz.kinds_ouster import packets_of
from tests.unit.recording import test_hesai_packets, test_robosense_packets
from tests.unit.recording.packet_builders import T0_NS, WIDE, spin
from tests.unit.recording.point_bags import read

WITHIN = {"min_range_m": WIDE.min_range_m, "max_range_m": WIDE.max_range_m}
PACKETS = 120
"""Of a sensor: little more than what shows that they are of one."""
PACKET_OF = {
    "velodyne_msgs/msg/VelodyneScan": "velodyne_msgs/msg/VelodynePacket",
    "pandar_msgs/msg/PandarScan": "pandar_msgs/msg/PandarPacket",
    "hesai_ros_driver/msg/UdpFrame": "hesai_ros_driver/msg/UdpPacket",
    "robosense_msgs/msg/RobosenseScan": "robosense_msgs/msg/RobosensePacket",
}


class PacketBag(RobotBag):
    """Writes packets as the drivers of all makers do."""

    def packets(self, kind, packets):
        """A message of packets: time of arrival [ns] and bytes of each."""
        for name, text in PACKET_MESSAGES[kind].definitions.items():
            if name not in self.store.types:
                self.store.register(get_types_from_msg(text, name))
        t_ns = packets[-1][0]
        if kind in PACKET_OF:
            of = PACKET_OF[kind]
            content = {
                "header": self.header(t_ns),
                "packets": [self._packet(of, *packet) for packet in packets],
            }
        elif kind.endswith("RslidarPacket"):
            content = {"header": self.header(t_ns), "data": packets[0][1]}
            content |= {"is_difop": 0, "is_frame_begin": 0}
        else:
            content = {"buf": packets[0][1]}
        self.write("/packets", kind, t_ns, self.make(kind, **content))

    def _packet(self, of, t_ns, data):
        fixed = np.zeros(1500, np.uint8)
        fixed[: len(data)] = data
        whole = fixed if of.startswith(("pandar", "robosense")) else data
        fields = {"stamp": self.time(t_ns), "data": whole, "size": len(data), "is_difop": 0}
        own = self.store.types[of].__dataclass_fields__
        return self.make(of, **{name: fields[name] for name in own if name in fields})


def velodyne(name, **fields):
    return spin(PACKETS, model=name, **fields)


def hesai(name):
    stamp_us, _, payloads = test_hesai_packets.spin(HESAIS[name], PACKETS)
    return stamp_us * 1000, payloads


def robosense(name):
    return test_robosense_packets.spin(ROBOSENSES[name], PACKETS)


def ouster(model, serial, profile="RNG19_RFL8_SIG16_NIR16"):
    metadata = nominal_metadata(model, serial=serial, profile=profile)
    payloads = packets_of(metadata, 12)
    return T0_NS + 1_600_000 * np.arange(len(payloads)), payloads


def in_one(*sensors):
    """Packets of sensors in the order of arrival."""
    return sorted(
        ((int(t), data) for t_ns, rows in sensors for t, data in zip(t_ns, rows, strict=True)),
        key=lambda packet: packet[0],
    )


def written(folder, kind, packets, *, in_message=30, storage="db3"):
    path = bag_path(folder, storage)
    with PacketBag(path, storage) as bag:
        for start in range(0, len(packets), in_message):
            bag.packets(kind, packets[start : start + in_message])
    return path


def rig_of(*models, sources=None):
    names = sources or models
    return rig_to_complete(
        [Stream(n, m, topic=f"/packets#{n}") for n, m in zip(names, models, strict=True)]
    )


CASES = {
    "velodyne_msgs/msg/VelodyneScan": {
        "x.HDL-32E": ("HDL-32E", velodyne),
        "x.VLP-16": ("VLP-16", velodyne),
    },
    "pandar_msgs/msg/PandarScan": {"x.QT64": ("QT64", hesai), "x.XT32": ("XT32", hesai)},
    "hesai_ros_driver/msg/UdpFrame": {"x.QT128": ("QT128", hesai), "x.XT16": ("XT16", hesai)},
    "robosense_msgs/msg/RobosenseScan": {
        "x.Bpearl-0.0": ("Bpearl", robosense),
        "x.Helios-0.0": ("Helios 5515", robosense),
    },
    "rslidar_msg/msg/RslidarPacket": {
        "x.Bpearl-3.4": ("Bpearl V4", robosense),
        "x.Helios-0.0": ("Helios 5515", robosense),
    },
}
"""Type of the message -> the sources of its packets, and what they are of."""


@pytest.mark.parametrize("kind", CASES)
def test_packets_tell_their_model(kind):
    stamp = SimpleNamespace(sec=1, nanosec=0)
    header = SimpleNamespace(frame_id="x", stamp=stamp)
    for source, (model, make) in CASES[kind].items():
        (_, payload), *_ = in_one(make(model))
        packet = SimpleNamespace(stamp=stamp, data=payload, size=len(payload))
        content = SimpleNamespace(header=header, packets=[packet], data=payload)
        assert [str(one) for one in parts_of(kind, content)] == [source]


@pytest.mark.parametrize(
    ("kind", "in_message", "points"),
    [
        ("velodyne_msgs/msg/VelodyneScan", 30, {"HDL-32E": 12 * 32, "VLP-16": 24 * 16}),
        ("rslidar_msg/msg/RslidarPacket", 1, {"Bpearl V4": 12 * 32, "Helios 5515": 12 * 32}),
    ],
)
def test_packets_of_two_models_in_one_topic_are_those_of_two_sensors(
    kind, in_message, points, tmp_path
):
    sent = {model: make(model) for model, make in CASES[kind].values()}
    path = written(tmp_path, kind, in_one(*sent.values()), in_message=in_message)
    _, shots, report = read(path, rig=rig_of(*points, sources=list(CASES[kind])), **WITHIN)

    for row, (model, each) in enumerate(points.items()):
        t_ns = np.concatenate([one.t_ns for one in shots if one.sensor == row])
        assert len(t_ns) == each * PACKETS
        assert abs(int(t_ns[0]) - int(sent[model][0][0])) < 2_000_000
    assert not report.lost() and report.counts["packets_missing"] == 0


def test_two_ousters_in_one_topic_are_separated_by_their_serial_numbers(tmp_path):
    serials = ("122300000001", "122300000002")
    sent = [ouster("OS1-32", serial) for serial in serials]
    path = written(tmp_path, "ouster_ros/msg/PacketMsg", in_one(*sent), in_message=1)
    for serial in serials:
        metadata = nominal_metadata("OS1-32", serial=serial)
        (tmp_path / f"{serial}.json").write_bytes(metadata_json(metadata))

    info = describe(path)

    assert [(s.label, s.model) for s in info.sensors] == [
        (f"/packets#{serial}", "OS1-32") for serial in serials
    ]
    assert [one.topic for one in parse_rig(info.first_rig, where="rig").sensors] == [
        s.label for s in info.sensors
    ]


def test_messages_of_two_equal_models_are_separated_by_their_frames(tmp_path):
    path = bag_path(tmp_path, "mcap")
    packets = in_one(velodyne("VLP-16"))
    with PacketBag(path, "mcap") as bag:
        for start in range(0, PACKETS, 30):
            for bag.frame in ("left", "right"):
                bag.packets("velodyne_msgs/msg/VelodyneScan", packets[start : start + 30])
    names = ["left.VLP-16", "right.VLP-16"]
    _, shots, report = read(path, rig=rig_of("VLP-16", "VLP-16", sources=names), **WITHIN)

    number = [sum(len(s) for s in shots if s.sensor == row) for row in (0, 1)]
    assert number[0] == number[1] == report.counts["points"] // 2
    with pytest.raises(RigToComplete, match=r"left\.VLP-16.*\n.*right\.VLP-16"):
        read(path)


@pytest.mark.parametrize("off_ns", [-7_000_000, 400_000_000_000])
def test_two_equal_models_in_turns_are_refused(off_ns, tmp_path):
    """Their clocks agree, or are not those of one master."""
    one = in_one(velodyne("VLP-16"))
    other = in_one(velodyne("VLP-16", clock_off_ns=off_ns))
    turns = [p for k in range(0, PACKETS, 30) for part in (one, other) for p in part[k : k + 30]]
    path = written(tmp_path, "velodyne_msgs/msg/VelodyneScan", turns)

    with pytest.raises(ConfigError, match=r"sensors of one model .*their times go back"):
        read(path, **WITHIN)


def test_two_equal_models_packet_by_packet_are_refused(tmp_path):
    one = velodyne("VLP-16")
    other = velodyne("VLP-16", t0_ns=T0_NS + 31_000_000)
    path = written(tmp_path, "velodyne_msgs/msg/VelodyneScan", in_one(one, other))

    with pytest.raises(ConfigError, match="their directions jump to and fro"):
        read(path, **WITHIN)


def test_two_solid_ones_packet_by_packet_are_refused():
    step_ns = 1_000_000
    payloads = np.arange(400, dtype=np.int64)[:, None].view(np.uint8).copy()
    layout = SimpleNamespace(
        size=8, packet_s=1e-9 * step_ns, azimuth_cdeg=lambda _: None, likely_models=lambda _: (),
        sound=lambda rows: np.ones(len(rows), bool),
        stamps_ns=lambda rows: rows.view(np.int64)[:, 0] * step_ns // 2,
    )  # fmt: skip
    of = SimpleNamespace(
        head=test_hesai_packets.datagrams(payloads), sensor=SimpleNamespace(topic="/m1")
    )

    with pytest.raises(ConfigError, match=r"/m1: .* come 2\.0 times as often"):
        require_one_sender(layout, of)
    layout.packet_s /= 2
    require_one_sender(layout, of)


def test_damaged_stamps_are_not_those_of_another_sensor():
    number = np.arange(400, dtype=np.int64)
    number[50::50] += np.array([60_000, -70_000, 80_000, 9_000_000, -50_000, 10**9, 123_456])
    layout = SimpleNamespace(
        size=8, packet_s=1e-3, azimuth_cdeg=lambda _: None, likely_models=lambda _: (),
        sound=lambda rows: np.ones(len(rows), bool),
        stamps_ns=lambda rows: rows.view(np.int64)[:, 0] * 1_000_000,
    )  # fmt: skip
    sensor = SimpleNamespace(topic="/m1")
    head = test_hesai_packets.datagrams(number[:, None].view(np.uint8).copy())

    require_one_sender(layout, SimpleNamespace(head=head, sensor=sensor))


def test_what_is_of_none_of_the_sensors_is_counted(tmp_path):
    hdl, vlp = velodyne("HDL-32E"), velodyne("VLP-16")
    strange = hdl[1][:5].copy()
    strange[:, -1] = 0x99
    packets = in_one(hdl, vlp, (hdl[0][110:115] + 1, strange))
    path = written(tmp_path, "velodyne_msgs/msg/VelodyneScan", packets)
    rig = rig_of("HDL-32E", "VLP-16", sources=["x.HDL-32E", "x.VLP-16"])
    _, shots, report = read(path, rig=rig, **WITHIN)

    assert {s.sensor for s in shots} == {0, 1} and report.counts["messages_of_no_lidar"] == 1
    assert any("of none of the LiDARs in their topic" in text for text in report.lost())
