"""What tests of reading recordings share."""

import pytest

from tests.builders import write_room_pcap


@pytest.fixture(scope="module")
def pcap(tmp_path_factory):
    return write_room_pcap(tmp_path_factory.mktemp("pcap") / "room.pcap", seconds=1.0)
