"""Messages of packets in all versions of their drivers."""

import numpy as np
import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from recon4.recording.formats.typestore import MessageTypes
from recon4.recording.packets.messages import DATA_MESSAGES, PACKET_MESSAGES

VERSIONS = [
    (kind, texts)
    for kind, row in PACKET_MESSAGES.items()
    for texts in (row.definitions, *row.versions)
]
PACKET = np.arange(1206, dtype=np.uint8)


def made(store, kind):
    """A message of a type with three packets, or one, whatever other fields it has."""
    fields = {}
    for name, (_, what) in store.fielddefs[kind][1]:
        if name in {"data", "buf"}:
            fields[name] = np.zeros(what[1] or len(PACKET), np.uint8)
            fields[name][: len(PACKET)] = PACKET
        elif name == "packets":
            fields[name] = [made(store, what[0][1]) for _ in range(3)]
        elif name in {"packet", "stamp", "header"}:
            fields[name] = made(store, what)
        else:
            usual = {"size": len(PACKET), "lidar_model": "x", "frame_id": "x"}
            fields[name] = usual.get(name, 7)
    return store.types[kind](**fields)


@pytest.mark.parametrize("ros1", [True, False])
@pytest.mark.parametrize(("kind", "texts"), VERSIONS)
def test_packets_of_every_version_of_a_message_are_read(kind, texts, ros1):
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    for name, text in texts.items():
        if name not in store.types:
            store.register(get_types_from_msg(text, name))
    write = store.serialize_ros1 if ros1 else store.serialize_cdr
    types = MessageTypes()

    for _ in range(2):
        content = types.decode(kind, bytes(write(made(store, kind), kind)), ros1=ros1)
        packets = PACKET_MESSAGES[kind].packets(content)

        assert len(packets) == (3 if "packets" in dir(content) else 1)
        assert {data[: len(PACKET)] for _, data in packets} == {PACKET.tobytes()}


def test_packets_of_nebula_and_of_device_data_have_their_messages():
    assert "nebula_msgs/msg/NebulaPackets" in DATA_MESSAGES
    assert PACKET_MESSAGES["robosense_msgs/msg/RobosenseInfoPacket"].samples
