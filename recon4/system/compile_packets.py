"""Compile the decoders of packets: a few packets of one model for each kernel, without returns."""

from __future__ import annotations

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.rig import Sensor
from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.decoder import open_decoder
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.simulation.families.families import family_of, pattern_of
from recon4.simulation.lidar import Firings, Lidar, LidarModel

MODELS = ("VLP-16", "XT32", "OS0-32", "Mid-360")
"""One model for each decoder that people often need; the others compile when they are met."""
_PACKETS = 20
_START_NS = 1_700_000_000_000_000_000


def compile_packets() -> None:
    """Decode a few packets of each of `MODELS`."""
    for model in MODELS:
        _decode(Sensor(name="lidar", model=model, T_body_sensor=SE3.identity()))


def _decode(sensor: Sensor) -> None:
    pattern, family = pattern_of(sensor.model), family_of(sensor.model)
    lidar = Lidar.drawn(sensor, pattern, model=LidarModel.perfect(), rng=np.random.default_rng(1))
    start_ns = pattern.packet_ns * np.arange(_PACKETS, dtype=np.int64)
    t_ns = start_ns[:, None, None] + pattern.offset_ns
    nothing = np.zeros(t_ns.shape, np.uint8)
    turn = np.asarray(2.0 * np.pi * lidar.turn_rate_hz * 1e-9 * t_ns, np.float64)
    firings = Firings(t_ns, turn, nothing.astype(np.uint32), nothing, nothing)
    payloads = family.data_packets(lidar, firings, _START_NS + start_ns)
    of = PacketSensor(
        row=0,
        sensor=sensor,
        head=datagrams_of((_START_NS + start_ns).tolist(), [one.tobytes() for one in payloads]),
        companions=[Companion(*one) for one in family.companions(lidar).items()],
        settings=IngestSettings(),
        report=ImportReport(),
    )
    decoder = open_decoder(of)
    decoder.push(_START_NS + start_ns, payloads)
    decoder.flush()
