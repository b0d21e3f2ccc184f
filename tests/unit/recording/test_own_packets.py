"""Messages of packets by the definition that a bag brings."""

import struct

import numpy as np
import pytest

from recon4.errors import CorruptFile
from recon4.recording.clouds.point_fields import EXACT_TIME
from recon4.recording.formats.point_messages import POINT_MESSAGES, point_reader
from recon4.recording.formats.typestore import MessageTypes, own_schemas
from recon4.recording.packets.messages import PACKET_MESSAGES

LIVOX = "livox_ros_driver/msg/CustomMsg"
SCAN = "velodyne_msgs/msg/VelodyneScan"
LINE = "=" * 80
PACKET = np.arange(1206, dtype=np.uint8).tobytes()


def scan(packet, *, ros1=True, before="", packets="VelodynePacket[] packets"):
    header = "std_msgs/Header header\n"
    own = "time stamp" if ros1 else "builtin_interfaces/Time stamp"
    body = packet.replace("STAMP", own)
    return f"{before}{header}{packets}\n{LINE}\nMSG: velodyne_msgs/VelodynePacket\n{body}\n"


def header(ros1):
    if ros1:
        return struct.pack("<IiII", 9, 5, 6, 1) + b"x"
    return bytes((0, 1, 0, 0)) + struct.pack("<iII", 5, 6, 2) + b"x\0" + bytes(2)


@pytest.mark.parametrize("ros1", [True, False])
def test_a_fork_with_more_fields_in_another_order_is_read_by_its_own_definition(ros1):
    text = scan("uint8[1206] data\nuint16 sequence\nSTAMP", ros1=ros1)
    data = header(ros1) + struct.pack("<I", 3)
    for k in range(3):
        data += PACKET
        data += b"" if ros1 else bytes(-(len(data) - 4) % 2)
        data += struct.pack("<H", 7)
        data += b"" if ros1 else bytes(-(len(data) - 4) % 4)
        data += struct.pack("<iI", 100 + k, 50)

    content = MessageTypes({SCAN: text}).decode(SCAN, data, ros1=ros1)

    packets = PACKET_MESSAGES[SCAN].packets(content)
    assert packets == [(10**9 * (100 + k) + 50, PACKET) for k in range(3)]


def test_definitions_as_drivers_have_them_are_read_by_the_known_ones():
    known = scan("STAMP\nuint8[1206] data", before="# A scan.\nuint32 PACKETS = 260\n\n")

    assert not own_schemas({SCAN: known, "sensor_msgs/msg/Imu": "float64 x", "a/msg/B": ""})
    assert not own_schemas({SCAN: "no definition ["})


def test_a_fork_without_what_is_needed_says_what_is_missing():
    with pytest.raises(CorruptFile, match=r"velodyne_msgs/VelodyneScan without packets\.data"):
        own_schemas({SCAN: scan("STAMP\nuint8[1206] raw\nuint8 more")})


@pytest.mark.parametrize("kind", sorted(PACKET_MESSAGES))
def test_every_message_of_packets_can_have_more_fields(kind):
    row = PACKET_MESSAGES[kind]
    for texts in (row.definitions, *row.versions):
        others = "".join(f"{LINE}\nMSG: {n}\n{t}" for n, t in texts.items() if n != kind)

        (schema,) = own_schemas({kind: f"{texts[kind]}float32 more\n{others}"}).values()

        assert schema.fields[-1].name == "more"


EARLY = (
    """Header header
uint64 timebase
uint32 timestep
uint32 point_num
uint8 lidar_id
uint8[3] rsvd
CustomPoint[] points
"""
    + f"{LINE}\nMSG: livox_ros_driver/CustomPoint\n"
    + """float32 x
float32 y
float32 z
uint8 reflectivity
uint8 line
"""
)


def test_points_of_the_first_driver_of_livox_have_the_time_of_an_even_step():
    data = header(True) + struct.pack("<QIIB3xI", 10**18, 5000, 3, 2, 3)
    data += b"".join(struct.pack("<fffBB", k, 2, 3, 90 + k, k) for k in range(3))
    reader = point_reader(LIVOX, EARLY)

    table = reader.read(data, ros1=True).table

    assert (table[EXACT_TIME] - 10**18).tolist() == [0, 5000, 10000]
    assert table["intensity"].tolist() == [90, 91, 92]
    assert "noise" not in table


def test_a_fork_of_the_driver_of_livox_may_name_its_reflectivity_an_intensity():
    text = POINT_MESSAGES[LIVOX].definition.replace("reflectivity", "intensity")
    data = header(True) + struct.pack("<QIB3xI", 10**18, 1, 2, 1)
    data += struct.pack("<IfffBBB", 7, 1, 2, 3, 90, 0, 1)

    table = point_reader(LIVOX, text).read(data, ros1=True).table

    assert (table["intensity"].tolist(), table[EXACT_TIME].tolist()) == ([90], [10**18 + 7])


def test_a_packet_of_an_ouster_may_have_a_header_with_its_time():
    data = header(True) + struct.pack("<I", 6) + b"packet"
    content = MessageTypes().decode("ouster_ros/msg/PacketMsg", data, ros1=True)

    assert PACKET_MESSAGES["ouster_ros/msg/PacketMsg"].packets(content) == [
        (5 * 10**9 + 6, b"packet")
    ]
