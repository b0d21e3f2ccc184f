"""Hesai LiDARs that fire all lasers in one order, by the tables of their packets."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.se3 import Array
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.hesai import stamps
from recon4.recording.packets.hesai.encode import (
    JT16_UNITS,
    TAIL_UNITS,
    HesaiBlocks,
    HesaiMode,
    InertialUnits,
    encode_jt16_inertial,
    encode_packets,
    write_inertial,
)
from recon4.recording.packets.hesai.fields import Fields
from recon4.recording.packets.hesai.firing import firing_mode, shot_times_us
from recon4.recording.packets.hesai.models import MODELS, HesaiModel
from recon4.simulation.families.family import BuiltInImu, encoder_cdeg
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import FiringPattern, Spin, rings
from recon4.units import STANDARD_GRAVITY_M_S2


def _shot_us(model: HesaiModel) -> Array:
    """When each laser fires after the stamp of its packet [µs], (S, L)."""
    blocks = model.layout.blocks
    return shot_times_us(model, blocks, firing_mode(1, blocks))  # key 1: one return of a shot


@cache
def _pattern(name: str) -> FiringPattern:
    model = MODELS[name]
    angles, shot_us = model.angles, _shot_us(model)
    assert angles is not None
    return FiringPattern(
        model=name,
        packet_ns=round(1e3 * model.step_us * len(shot_us)),
        offset_ns=np.rint(1e3 * (shot_us - shot_us.min())).astype(np.int64),
        ring=rings(angles.elevation_rad),
        motion=Spin(
            elevation_rad=angles.elevation_rad,
            azimuth_rad=angles.azimuth_rad,
            zero_rad=-0.5 * np.pi,  # azimuth 0 is y
        ),
        unit_m=1e-3 * model.layout.unit_mm,
    )


def _jt16_packets(samples: ImuSamples) -> Payloads:
    return encode_jt16_inertial((samples.t_ns + 500) // 1000, _numbers(samples, JT16_UNITS))


def _write(model: HesaiModel, payloads: Payloads, samples: ImuSamples) -> None:
    """Put the newest sample at its stamp into the tail of each packet."""
    fields = Fields(payloads, model.layout)
    stamp_ns = stamps.time_ns(fields.date, fields.micros)
    newest = np.maximum(np.searchsorted(samples.t_ns, stamp_ns, side="right") - 1, 0)
    clock = samples.t_ns[newest] // TAIL_UNITS.clock_ns % 2**32
    values = _numbers(samples, TAIL_UNITS)[newest]
    write_inertial(payloads, model.layout, clock=clock, values=values)


def _numbers(samples: ImuSamples, units: InertialUnits) -> NDArray[np.int64]:
    """Accelerations and angular rates in units of a packet, (N, 6)."""
    accel = samples.accel_m_s2 / (STANDARD_GRAVITY_M_S2 * units.accel_g)
    gyro = np.rad2deg(samples.gyro_rad_s) / units.gyro_deg_s
    return np.clip(np.rint(np.hstack([accel, gyro])), -32768, 32767).astype(np.int64)


class SimulatedHesais:
    """Single return mode, clock by PTP, the typical angles of the manual."""

    name = "Hesai"

    def pattern(self, model: str) -> FiringPattern | None:
        """Of models that spin and have one firing sequence; not QT128, Pandar128, OT128, AT128."""
        made = MODELS.get(model)
        if made is None or made.angles is None or len(made.firing_us) > 1:
            return None
        return _pattern(model)

    def imu(self, model: str) -> BuiltInImu | None:
        """In the tails of data packets (JT128), or in packets of their own (JT16)."""
        made = MODELS[model]
        if model == "JT16":
            return BuiltInImu(packets=_jt16_packets)
        return BuiltInImu(within=partial(_write, made)) if made.layout.imu_at >= 0 else None

    def data_packets(self, lidar: Lidar, firings: Firings, t_ns: Times) -> Payloads:
        """Packets of blocks."""
        model = MODELS[lidar.pattern.model]
        stamp_us = (t_ns - round(1e3 * float(_shot_us(model).min())) + 500) // 1000
        blocks = HesaiBlocks(
            encoder_cdeg(lidar, firings, since_ns=1e3 * float(model.firing_us[0, 0])),
            firings.distance,
            firings.intensity,
        )
        mode = HesaiMode(rpm=60.0 * lidar.turn_rate_hz)
        return encode_packets(stamp_us, blocks, model=model, mode=mode)

    def companions(self, lidar: Lidar) -> Mapping[str, bytes]:
        """The angles of the lasers."""
        angles = MODELS[lidar.pattern.model].angles
        assert angles is not None
        table = np.rad2deg(np.column_stack([angles.elevation_rad, angles.azimuth_rad]))
        rows = [f"{k},{e:.5f},{a:.5f}" for k, (e, a) in enumerate(table.tolist(), start=1)]
        text = "\n".join(["Channel,Elevation,Azimuth", *rows]) + "\n"
        return {f"{lidar.pattern.model.lower()}_angles.csv": text.encode()}


HESAIS = SimulatedHesais()
