"""What a replay sends: captured packets of any family, and samples, with the times of now."""

import json
import socket

import numpy as np

from recon4.live.replay import replay
from recon4.progress import Silent
from recon4.recording.packets.livox.models import LAYOUTS
from recon4.recording.packets.livox.sound import has_crc, stamps_ns
from recon4.recording.packets.velodyne.encode import PcapWriter
from tests.security.fuzz.kinds_livox import packets_of


def test_rounds_of_a_livox_and_its_samples_follow_each_other_in_time(tmp_path):
    layout = next(one for one in LAYOUTS if one.sdk == 2)
    payloads = packets_of(layout, 5)
    arrived_ns = 10**18 + 1_000_000 * np.arange(5)
    samples = np.stack([np.frombuffer(b'{"t_ns": %d}' % t, np.uint8) for t in arrived_ns])
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as listener:
        listener.bind(("127.0.0.1", 0))
        port = listener.getsockname()[1]
        with PcapWriter(tmp_path / "walk.pcap") as file:
            file.write(arrived_ns, payloads, source="192.168.1.3", port=port)
            file.write(arrived_ns, samples, source="192.168.1.4", port=port)

        replay(tmp_path / "walk.pcap", progress=Silent(), repetitions=2)

        sent = [listener.recv(2000) for _ in range(20)]
    packets = np.stack([np.frombuffer(one, np.uint8) for one in sent if len(one) == layout.size])
    sample_ns = np.array([json.loads(one)["t_ns"] for one in sent if one.startswith(b"{")])
    stamp_ns = stamps_ns(packets, 2)
    assert has_crc(packets).all()
    assert (np.diff(stamp_ns) > 0).all() and (np.diff(sample_ns) > 0).all()
    moved_ns = sample_ns - np.tile(arrived_ns, 2)
    assert np.array_equal(stamp_ns - np.tile(stamps_ns(payloads, 2), 2), moved_ns)
    assert len(np.unique(moved_ns)) == 2, "as a whole, round by round"
