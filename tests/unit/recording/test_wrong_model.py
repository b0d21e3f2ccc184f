"""Rigs that name another model than the one that sends: what the packets look like is said."""

import numpy as np
import pytest

from recon4.errors import EmptyRecording
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.capture import PacketCapture
from recon4.recording.packets.hesai.models import MODELS as HESAI
from recon4.recording.packets.robosense.models import MODELS as ROBOSENSE
from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.packets.velodyne.models import MODELS as VELODYNE
from recon4.recording.packets.velodyne.wide_encode import encode_wide
from recon4.recording.packets.velodyne.wide_models import VLS128
from recon4.recording.report import ImportReport
from tests.unit.recording.ingested import run
from tests.unit.recording.packet_builders import T0_NS, WIDE, rig, sensor, spin
from tests.unit.recording.test_hesai_packets import spin as hesai_spin
from tests.unit.recording.test_robosense_packets import device_of
from tests.unit.recording.test_robosense_packets import spin as robosense_spin
from tests.unit.recording.test_velodyne_wide import wall
from tests.warned import K, warned

PACKETS = 200


def packets_of(model):
    """Times of arrival, packets, and device packets if there are some."""
    if model in VELODYNE:
        return *spin(PACKETS, model=model), None
    if model == VLS128.name:
        step_ns = round(1e9 * VLS128.packet_s(dual=False))
        packets = encode_wide(*wall(PACKETS, VLS128), model=VLS128)
        return T0_NS + step_ns * np.arange(PACKETS), packets, None
    if model in HESAI:
        stamp_us, _, packets = hesai_spin(HESAI[model], packets=PACKETS)
        return 1000 * stamp_us, packets, None
    t_ns, packets = robosense_spin(ROBOSENSE[model], PACKETS)
    return t_ns, packets, device_of(ROBOSENSE[model])


def captured(model, folder):
    path = folder / "walk.pcap"
    t_ns, packets, device = packets_of(model)
    with PcapWriter(path) as file:
        if device is not None:
            file.write(t_ns[:1], device, source="192.168.1.201")
        file.write(t_ns, packets, source="192.168.1.201")
    return path


def read_as(model, path):
    report = ImportReport()
    capture = PacketCapture([path], rig(sensor(model=model)), settings=WIDE, report=report)
    return sum(len(part) for part in capture.read() if isinstance(part, Shots)), report


@pytest.mark.parametrize(
    ("sent", "named"),
    [
        ("VLS-128", "VLP-16"),
        ("VLS-128", "HDL-64E"),
        ("HDL-32E", "VLS-128"),
        ("Ruby Plus", "Airy"),
        ("Helios 5515", "M1"),
        ("Helios 16P", "RS-32"),
    ],
)
def test_packets_that_the_model_of_the_rig_cannot_read_are_named(tmp_path, sent, named):
    path = captured(sent, tmp_path)

    with pytest.raises(
        EmptyRecording, match=rf"expects lidar: {named} .* \(data packets of a {sent}\)"
    ):
        run(path, out=tmp_path / "frames", rig=rig(sensor(model=named)))


@pytest.mark.parametrize(
    ("sent", "named"),
    [("VLP-32C", "VLP-16"), ("XT16", "JT16"), ("Bpearl", "RS-32"), ("RS-16", "Bpearl")],
)
def test_packets_that_can_be_read_as_another_model_are_read_with_a_warning(tmp_path, sent, named):
    points, report = read_as(named, captured(sent, tmp_path))

    assert points
    assert warned(report, K.MODEL_CONTRADICTED, sensor="lidar", model=named)


@pytest.mark.parametrize(
    ("sent", "named"),
    [("VLP-16", "Puck LITE"), ("Helios 5515", "Helios 32"), ("RS-32", "RS-32"), ("XT32", "XT32")],
)
def test_models_with_the_same_packets_are_not_accused(tmp_path, sent, named):
    points, report = read_as(named, captured(sent, tmp_path))

    assert points
    assert not warned(report, K.MODEL_CONTRADICTED) and not warned(report, K.PACKETS_MISSING)


def test_two_sensors_on_one_port_are_told_apart_by_their_models(tmp_path):
    path = tmp_path / "walk.pcap"
    with PcapWriter(path) as file:
        for last, model in enumerate(("VLS-128", "VLP-16")):
            t_ns, packets, _ = packets_of(model)
            file.write(t_ns, packets, source=f"192.168.1.20{last}")
    report = ImportReport()
    both = rig(sensor("low", "VLP-16"), sensor("high", "VLS-128"))

    capture = PacketCapture([path], both, settings=WIDE, report=report)
    points = [part for part in capture.read() if isinstance(part, Shots)]

    assert {part.sensor for part in points if len(part)} == {0, 1}
    assert not report.counts["packets_wrong_flag"]
