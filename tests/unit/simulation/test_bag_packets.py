"""Packets of every maker in a simulated bag are those that the reader of bags gets."""

import numpy as np
import pytest

from recon4.recording.formats.bags import Bag
from recon4.recording.packets.messages import PACKET_MESSAGES as READ
from recon4.recording.report import ImportReport
from recon4.simulation.bag import open_bag
from recon4.simulation.bag_packets import PACKET_MESSAGES
from recon4.simulation.setup import EPOCH_NS, prepare, rig_of_lidars

MODELS = {"Velodyne": ("VLP-16", 1206), "Hesai": ("XT32", 1080)}
MODELS |= {"RoboSense": ("Helios 32", 1248), "Ouster": ("OS0-32", 8448)}


@pytest.mark.parametrize("maker", PACKET_MESSAGES)
def test_packets_come_back_with_their_times(maker, tmp_path):
    model, size = MODELS[maker]
    rig = prepare("office", seconds=5.0, seed=1, rig=rig_of_lidars([model])).rig
    written = np.random.default_rng(1).integers(0, 256, (200, size), np.uint8)
    t_ns = EPOCH_NS + 1_000_000 * np.arange(200)
    with open_bag(tmp_path / "bag", rig) as bag:
        bag.packets(0, t_ns, written)
    found, message = [], PACKET_MESSAGES[maker]
    with Bag([tmp_path / "bag"], ImportReport()) as bag:
        assert [(t.name, t.type) for t in bag.topics] == [(rig.sensors[0].topic, message.kind)]
        for one in bag.messages([rig.sensors[0].topic]):
            packets = READ[message.kind].packets(bag.decode(one))
            found += [(stamp or one.t_ns, data) for stamp, data in packets]

    assert [stamp for stamp, _ in found] == t_ns.tolist()
    assert [data for _, data in found] == [row.tobytes() for row in written]
