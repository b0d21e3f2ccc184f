"""Packets, or points of them, in a simulated bag are those that the reader of bags gets."""

import numpy as np
import pytest

from recon4.recording.assembly.shots import Shots
from recon4.recording.formats.bags import Bag
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.packets.livox.encode import ShotReturns, encode_points
from recon4.recording.packets.livox.models import LAYOUTS, MODELS
from recon4.recording.packets.livox.points import LivoxSource, decode_points
from recon4.recording.packets.messages import PACKET_MESSAGES as READ
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.simulation.bag import open_bag
from recon4.simulation.bag_packets import PACKET_MESSAGES
from recon4.simulation.setup import EPOCH_NS, prepare, rig_of_lidars

OF_MAKERS = {"Velodyne": ("VLP-16", 1206), "Hesai": ("XT32", 1080)}
OF_MAKERS |= {"RoboSense": ("Helios 32", 1248), "Ouster": ("OS0-32", 8448)}


@pytest.mark.parametrize("maker", PACKET_MESSAGES)
def test_packets_come_back_with_their_times(maker, tmp_path):
    model, size = OF_MAKERS[maker]
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


@pytest.mark.parametrize(("model", "driver"), [("Mid-360", "driver2"), ("Avia", "driver")])
def test_points_of_a_livox_come_back_with_their_times(model, driver, tmp_path):
    rig = prepare("office", seconds=5.0, seed=1, rig=rig_of_lidars([model])).rig
    kind = (1, 2) if model == "Avia" else (2, 1)
    layout = next(one for one in LAYOUTS if (one.sdk, one.data_type) == kind)
    packet_ns = round(1e9 * layout.shots * MODELS[model].shot_s)
    t_ns = EPOCH_NS + packet_ns * np.arange(4)
    shape = (len(t_ns), layout.shots, 1)
    rng = np.random.default_rng(1)
    xyz_m = rng.integers(1500, 9000, (*shape, 3)) * 1e-3
    returns = ShotReturns(xyz_m, rng.integers(0, 256, shape))
    payloads = encode_points(t_ns, returns, layout=layout, model=MODELS[model])
    report = ImportReport()
    source = LivoxSource(0, MODELS[model], layout, IngestSettings())
    expected = decode_points(t_ns, payloads, source, report=report)
    with open_bag(tmp_path / "bag", rig) as bag:
        bag.packets(0, t_ns + packet_ns, payloads)

    with Bag([tmp_path / "bag"], report) as bag:
        kinds = [topic.type for topic in bag.topics]
    recording = open_recording(OpenRequest((tmp_path / "bag",), rig, IngestSettings(), report))
    parts = [item for item in recording.read() if isinstance(item, Shots)]

    assert kinds == [f"livox_ros_{driver}/msg/CustomMsg"]
    for name in ("t_ns", "xyz", "intensity", "ring", "echo"):
        found = np.concatenate([getattr(part, name) for part in parts])
        np.testing.assert_allclose(found, getattr(expected, name), rtol=0, atol=1e-6, err_msg=name)
