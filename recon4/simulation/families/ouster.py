"""Ouster sensors: columns at fixed angles of the encoder, all beams of a column at one time.

Beams are spread evenly over the field of view, and over four azimuths as those of an OS0 or OS1;
real sensors differ from that by some tenths of a degree, which their metadata tells. So does the
metadata file here.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from recon4.model.lidars import LIDARS, lidar_model
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.ouster.encode import (
    ColumnReturns,
    encode_imu,
    encode_packets,
    metadata_json,
)
from recon4.recording.packets.ouster.layouts import PROFILES, USUAL_COLUMNS, PacketLayout
from recon4.recording.packets.ouster.metadata import OusterMetadata
from recon4.simulation.families.family import BuiltInImu
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import FiringPattern, Spin, even_shots, rings

_PROFILE = PROFILES["RNG19_RFL8_SIG16_NIR16"]
_BEAM_ORIGIN_M = {"OS0": 0.02767, "OS1": 0.015806, "OS2": 0.013762, "OSDome": 0.02767}
"""How far from the axis the beams leave, by the start of the name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sensor:
    """What all Ousters have in common (hardware user manuals of OS0 and OS1)."""

    columns: int = 1024
    turn_hz: float = 10.0
    """Mode 1024x10, that of delivery."""
    stagger_deg: tuple[float, ...] = (4.2, 1.4, -1.4, -4.2)
    """Azimuths of beams that follow each other."""
    height_m: float = 0.03618
    """Of the optical center above the base."""
    imu_hz: int = 100


_SENSOR = _Sensor()


@cache
def _metadata(model: str) -> OusterMetadata:
    """What the file of a sensor would say, but for its serial number and ports."""
    facts = lidar_model(model)
    kind, beams = model.split("-")
    lowest, highest = facts.elevation_deg
    T_sensor_lidar = np.diag([-1.0, -1.0, 1.0, 1.0])
    T_sensor_lidar[2, 3] = _SENSOR.height_m
    return OusterMetadata(
        name=model,
        likeness=0,
        product=f"{kind[:2]}-{kind[2:].upper()}-{beams}",
        serial="",
        init_id=1,
        layout=PacketLayout(_PROFILE, facts.beams, USUAL_COLUMNS),
        columns_per_turn=_SENSOR.columns,
        rotation_hz=_SENSOR.turn_hz,
        elevation_rad=np.deg2rad(np.linspace(highest, lowest, facts.beams)),
        azimuth_rad=np.deg2rad(np.resize(_SENSOR.stagger_deg, facts.beams)),
        p_lidar_beam_m=np.array([_BEAM_ORIGIN_M[kind], 0.0]),
        T_sensor_lidar=T_sensor_lidar,
        R_sensor_imu=np.eye(3),
        port=0,
        imu_port=0,
        assumed=(),
    )


def _of_sensor(lidar: Lidar) -> OusterMetadata:
    """The metadata of one sensor: its serial number tells it from others of its model."""
    model, sensor = lidar.pattern.model, lidar.sensor
    serial = "".join(part.zfill(3) for part in sensor.address.split("."))
    known = _metadata(model)
    imu_port = lidar_model(model).sample_ports[0]
    return replace(known, port=sensor.port, imu_port=imu_port, serial=serial.lstrip("0"))


@cache
def _pattern(model: str) -> FiringPattern:
    metadata = _metadata(model)
    column_ns = 1e9 / (_SENSOR.columns * _SENSOR.turn_hz)
    origin_m = float(metadata.p_lidar_beam_m[0])
    beams = metadata.layout.beams
    return FiringPattern(
        model=model,
        packet_ns=round(USUAL_COLUMNS * column_ns),
        offset_ns=even_shots(
            sequences=USUAL_COLUMNS, sequence_ns=column_ns, laser_ns=0.0, lasers=beams
        ),
        ring=rings(metadata.elevation_rad),
        motion=Spin(
            elevation_rad=metadata.elevation_rad,
            azimuth_rad=metadata.azimuth_rad,
            zero_rad=np.pi,  # from the axes of the rotor to those of the base
            origin_m=np.array([[origin_m], [0.0], [_SENSOR.height_m]]),
        ),
        unit_m=1e-3 * _PROFILE.unit_mm,
        most_units=(1 << _PROFILE.echoes[0].range_bits) - 1,
        added_m=origin_m,
        turn_hz=_SENSOR.turn_hz,
        steps=_SENSOR.columns // USUAL_COLUMNS,
    )


def _imu_packets(samples: ImuSamples) -> Payloads:
    return encode_imu(samples.t_ns, samples.accel_m_s2, samples.gyro_rad_s)


class SimulatedOusters:
    """Single return mode, clock by PTP."""

    name = "Ouster"

    def pattern(self, model: str) -> FiringPattern | None:
        """Of models whose number of beams is known and sent without silent ones."""
        kind, _, beams = model.partition("-")
        usable = model in LIDARS and kind in _BEAM_ORIGIN_M and beams in ("32", "64", "128")
        return _pattern(model) if usable else None

    def imu(self, model: str) -> BuiltInImu | None:
        """All have one."""
        return BuiltInImu(packets=_imu_packets, rate_hz=_SENSOR.imu_hz)

    def data_packets(self, lidar: Lidar, firings: Firings, t_ns: Times) -> Payloads:
        """Packets of 16 columns, in one datagram whatever their size."""
        column = firings.turn_rad[:, :, 0] * (_SENSOR.columns / (2.0 * np.pi))
        since_ns = firings.t_ns[:, :, 0] - firings.t_ns[:, :1, 0]
        returns = ColumnReturns(
            t_ns=t_ns[:, None] + since_ns,
            number=np.rint(column).astype(np.int64) % _SENSOR.columns,
            range_mm=firings.distance[None],
            intensity=firings.intensity[None],
        )
        return encode_packets(_of_sensor(lidar), returns)

    def companions(self, lidar: Lidar) -> Mapping[str, bytes]:
        """The metadata."""
        return {"metadata.json": metadata_json(_of_sensor(lidar))}


OUSTERS = SimulatedOusters()
