"""Bags of the driver of Hesai, from the file to points."""

import numpy as np
import pytest
from rosbags.typesys import get_types_from_msg

from recon4.errors import ConfigError
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.kinds import located_sources
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.hesai.models import MODELS
from recon4.recording.report import ImportReport
from recon4.recording.sources import Sources
from tests.builders import bag_path
from tests.robot_bags import RobotBag
from tests.unit.recording.hesai_packets import WIDE, table_of
from tests.unit.recording.test_hesai_packets import T0_US, decoded, spin
from tests.warned import K, kinds

UDP_PACKET, UDP_FRAME = "hesai_ros_driver/msg/UdpPacket", "hesai_ros_driver/msg/UdpFrame"
STAMP = "builtin_interfaces/Time stamp\n"


def written(folder, kind, payloads, *, in_message):
    """A bag with packets as the driver of the maker records them."""
    path = bag_path(folder, kind)
    with RobotBag(path, kind) as bag:
        texts = {
            UDP_PACKET: f"{STAMP}uint8[] data\nuint32 size\n",
            UDP_FRAME: "std_msgs/Header header\nhesai_ros_driver/UdpPacket[] packets\n",
        }
        for name, text in texts.items():
            bag.store.register(get_types_from_msg(text, name))
        for start in range(0, len(payloads), in_message):
            t_ns = T0_US * 1000 + start * 100_000
            packets = [
                bag.make(UDP_PACKET, stamp=bag.time(t_ns), data=data, size=len(data))
                for data in payloads[start : start + in_message]
            ]
            message = bag.make(UDP_FRAME, header=bag.header(t_ns), packets=packets)
            bag.write("/lidar_packets", UDP_FRAME, t_ns, message)
    return path


@pytest.mark.parametrize("kind", ["bag1", "db3", "mcap"])
def test_a_bag_of_the_makers_driver_is_read(kind, tmp_path):
    model = MODELS["XT32"]
    payloads = spin(model, packets=300)[2]
    path = written(tmp_path, kind, payloads, in_message=100)  # more than 64 kB a message
    table = table_of(model.angles, "XT32_correction.csv")
    (tmp_path / table.name).write_bytes(table.content)

    report = ImportReport()
    paths = located_sources(Sources.of(path)).recordings
    parts = open_recording(OpenRequest(paths, None, WIDE, report)).read()
    shots = [part for part in parts if isinstance(part, Shots)]

    expected, _ = decoded(model, payloads)
    assert [(one.label, one.model) for one in describe(path).sensors] == [
        ("/lidar_packets", "XT32")
    ]
    assert sum(map(len, shots)) == len(expected)
    xyz = np.concatenate([part.xyz for part in shots])
    np.testing.assert_allclose(xyz, expected.xyz, atol=1e-4)
    assert not {K.ANGLES_TYPICAL, K.ANGLES_UNREADABLE} & set(kinds(report))


def test_packets_of_no_maker_are_refused_with_what_to_do(tmp_path):
    noise = np.random.default_rng(0).integers(0, 256, (300, 1080), dtype=np.uint8)
    path = written(tmp_path, "db3", noise, in_message=100)

    with pytest.raises(ConfigError, match=r"_packets: these are packets of no LiDAR .*rig file"):
        list(open_recording(OpenRequest((path,), None, WIDE, ImportReport())).read())
