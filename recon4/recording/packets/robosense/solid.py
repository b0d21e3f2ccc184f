"""RoboSense LiDARs without rotation: M1, M2 and E1, packets to points.

Sources: user manuals RS-LiDAR-M1 (2.0) and E1 (1.0), and the maker's driver rs_driver. Every point
has its direction in the packet: two angles (M1) or a vector (M2, E1). x is forward, y left, z up.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.packets.family import PacketSensor, Payloads
from recon4.recording.packets.robosense.packets import stamps_of
from recon4.recording.packets.spinning import distances
from recon4.recording.report import ImportReport

SOLID_ID = bytes.fromhex("55aa5aa5")
"""First bytes of a data packet."""
SOLID_STAMP_AT = 10
SOLID_HEADER = 32
"""Bytes before the first block."""
MIDDLE = 32768
"""Zero of the angles of an M1, one of the vectors of an M2 or E1."""
SOLID_UNIT_M = 0.005
"""Meters per unit of distance."""
SECOND_RETURN = 2
"""Of ``returned`` in blocks of an M1 or M2: a further return of shots of the packet before."""

_ANGLES = np.deg2rad(0.01 * (np.arange(65536) - MIDDLE))
_COS, _SIN = np.cos(_ANGLES).astype(np.float32), np.sin(_ANGLES).astype(np.float32)

_M1_POINT = np.dtype(
    [
        *[("distance", ">u2"), ("pitch", ">u2"), ("yaw", ">u2"), ("intensity", "u1")],
        *[("attribute", "u1"), ("elongation", "u1")],
    ]
)
_VECTOR_POINT = np.dtype(
    [("distance", ">u2"), ("vector", ">i2", 3), ("intensity", "u1"), ("attribute", "u1")]
)


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class SolidModel:
    """One model that does not spin."""

    name: str
    """As in `recon4.model.lidars.LIDARS`."""
    size: int
    """Bytes of a data packet."""
    block: np.dtype[np.void]
    """A block: time after the packet's stamp [µs] and points of one firing."""
    blocks: int
    """Blocks of a packet."""
    packet_s: float
    """Usual time from one packet to the next [s]."""
    directions: Literal["angles", "vectors"]
    """How points tell where they are."""


SOLID_MODELS = {
    model.name: model
    for model in (
        SolidModel(
            name="M1",
            size=1210,
            block=np.dtype([("us", "u1"), ("returned", "u1"), ("points", _M1_POINT, 5)]),
            blocks=25,
            packet_s=0.1 / 630,
            directions="angles",
        ),
        SolidModel(
            name="M2",
            size=1342,
            block=np.dtype([("us", "u1"), ("returned", "u1"), ("points", _VECTOR_POINT, 5)]),
            blocks=25,
            packet_s=0.1 / 1260,
            directions="vectors",
        ),
        SolidModel(
            name="E1",
            size=1200,
            block=np.dtype([("us", ">u2"), ("points", _VECTOR_POINT, 1)]),
            blocks=96,
            packet_s=0.1 / 288,
            directions="vectors",
        ),
    )
}
"""By name."""


def blocks_of(payloads: Payloads, model: SolidModel) -> NDArray[np.void]:
    """The blocks of packets as records, (N, B)."""
    end = SOLID_HEADER + model.blocks * model.block.itemsize
    return np.ascontiguousarray(payloads[:, SOLID_HEADER:end]).view(model.block)


def solid_stamps(payloads: Payloads) -> tuple[Times, NDArray[np.bool_]]:
    """Times of packets on the clock of the sensor [ns], (N,), and whether they can be."""
    stamp = np.ascontiguousarray(payloads[:, SOLID_STAMP_AT : SOLID_STAMP_AT + 10])
    return stamps_of(stamp, ns=False)


def sound_solid(payloads: Payloads, report: ImportReport) -> NDArray[np.bool_]:
    """Which payloads are data packets, (N,); counts as `packets.sound_packets`."""
    report.count("packets", len(payloads))
    begins = (payloads[:, :4] == np.frombuffer(SOLID_ID, np.uint8)).all(axis=1)
    right = solid_stamps(payloads)[1]
    report.count("packets_wrong_header", int((~begins).sum()))
    report.count("packets_wrong_stamp", int((begins & ~right).sum()))
    return np.asarray(begins & right)


def decode_solid(t_ns: Times, payloads: Payloads, model: SolidModel, *, of: PacketSensor) -> Shots:
    """Points of sound packets in order of time.

    Counts ``points``, ``points_no_return``, ``points_near`` and ``points_far``. A second return is
    echo 1, also where it repeats the first: the two are in different packets.

    Args:
        t_ns: Time of the first shot of each packet [ns], (P,).
        payloads: The packets, (P, size).
        model: The sensor.
        of: Its row, limits of the range and report.
    """
    blocks = blocks_of(payloads, model)
    points = blocks["points"]
    shape = points.shape
    limits = distances(SOLID_UNIT_M, of.settings)
    distance = points["distance"].astype(np.int64)
    near = (distance > 0) & (distance < limits.least)
    far = distance > limits.most
    kept = (distance > 0) & ~near & ~far
    for name, which in (
        ("points_no_return", distance == 0),
        ("points_near", near),
        ("points_far", far),
        ("points", kept),
    ):
        of.report.count(name, int(which.sum()))
    time = t_ns[:, None] + _offset_unit_ns(blocks, model) * blocks["us"].astype(np.int64)
    echo = np.zeros(shape[:2], np.uint8)
    if "returned" in (model.block.names or ()):
        echo = (blocks["returned"] == SECOND_RETURN).astype(np.uint8)
    chosen = points[kept]
    range_m = np.float32(SOLID_UNIT_M) * chosen["distance"].astype(np.float32)
    rays = _vectors(chosen) if model.directions == "vectors" else _rays(chosen)
    return Shots(
        of.row,
        np.broadcast_to(time[:, :, None], shape)[kept],
        range_m[:, None] * rays,
        chosen["intensity"].astype(np.uint16),
        np.broadcast_to(np.arange(shape[2], dtype=np.uint8), shape)[kept],
        np.broadcast_to(echo[:, :, None], shape)[kept],
    )


def _offset_unit_ns(blocks: NDArray[np.void], model: SolidModel) -> int:
    """Unit of the times in blocks [ns]: µs, or ns where µs would reach beyond the next packets.

    The newer versions of the maker's driver read those of an E1 as ns.
    """
    last_us = np.median(blocks["us"].max(axis=1)) if len(blocks) else 0.0
    return 1 if last_us > 2e6 * model.packet_s else 1000


def _rays(points: NDArray[np.void]) -> NDArray[np.float32]:
    """Unit vectors from angles of 0.01°."""
    pitch, yaw = points["pitch"], points["yaw"]
    flat = _COS[pitch]
    return np.column_stack([flat * _COS[yaw], flat * _SIN[yaw], _SIN[pitch]])


def _vectors(points: NDArray[np.void]) -> NDArray[np.float32]:
    return points["vector"].astype(np.float32) / np.float32(MIDDLE)
