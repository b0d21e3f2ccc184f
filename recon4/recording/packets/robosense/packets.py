"""Data packets of RoboSense LiDARs that spin: sound or not, times, points."""

from __future__ import annotations

from dataclasses import replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from recon4.kernels.spinning import BlockRoles
from recon4.model.trajectory import Times
from recon4.recording.packets.dates import dates_of
from recon4.recording.packets.family import Payloads
from recon4.recording.packets.robosense.angles import LaserAngles
from recon4.recording.packets.robosense.models import LATEST_S, RoboSenseModel
from recon4.recording.packets.robosense.tuning import ROBOSENSE_ANGLES
from recon4.recording.packets.spinning import SpinningTables, beams, distances, variants
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from recon4.units import SECOND_NS, SECOND_US

STAMP = np.dtype([("high", ">u2"), ("seconds", ">u4"), ("rest", ">u4")])
"""Seconds, and µs or ns of the second."""
DATE = np.dtype(
    [
        *[(name, "u1") for name in ("year", "month", "day", "hour", "minute", "second")],
        *[("ms", ">u2"), ("us", ">u2")],
    ]
)
"""A time as a date; years after 2000."""


class PacketReturns(IntEnum):
    """Variants of packets."""

    SINGLE = 0
    DUAL = 1
    DUAL_AHEAD = 2
    """Of the blocks A B B of a Ruby Plus, the second return of A was in the packet before."""


def block_bytes(payloads: Payloads, model: RoboSenseModel) -> NDArray[np.uint8]:
    """The blocks of packets, (N, B, bytes)."""
    layout = model.layout
    end = layout.first + layout.blocks * layout.block
    return payloads[:, layout.first : end].reshape(len(payloads), layout.blocks, layout.block)


def azimuths_cdeg(payloads: Payloads, model: RoboSenseModel) -> NDArray[np.int64]:
    """The azimuth of each block [0.01°], (N, B)."""
    blocks = block_bytes(payloads, model)
    return (blocks[:, :, 2].astype(np.int64) << 8) | blocks[:, :, 3]


def has_id(payloads: Payloads, model: RoboSenseModel) -> NDArray[np.bool_]:
    """Which payloads begin as data packets of a model, (N,)."""
    wanted = np.frombuffer(model.data_id, np.uint8)
    begins = (payloads[:, : len(wanted)] == wanted).all(axis=1)
    if model.kind_at >= 0:
        begins &= payloads[:, model.kind_at] == 0
    return np.asarray(begins)


def has_flags(payloads: Payloads, model: RoboSenseModel) -> NDArray[np.bool_]:
    """Which payloads have the flag of each of the model's blocks, (N,)."""
    wanted = np.frombuffer(model.flag, np.uint8)
    return np.asarray((block_bytes(payloads, model)[:, :, : len(wanted)] == wanted).all((1, 2)))


def sound_packets(
    payloads: Payloads, model: RoboSenseModel, report: ImportReport
) -> NDArray[np.bool_]:
    """Which payloads are data packets of a model, (N,).

    Counts ``packets`` and what is dropped: ``packets_wrong_header`` (the first bytes),
    ``packets_wrong_flag`` (any block without its flag), ``packets_wrong_azimuth`` (360° or more)
    and ``packets_wrong_stamp``.

    Args:
        payloads: Packets, (N, 1248).
        model: The sensor.
        report: Takes the counts.
    """
    report.count("packets", len(payloads))
    sound = np.ones(len(payloads), np.bool_)
    for reason, right in (
        ("packets_wrong_header", has_id(payloads, model)),
        ("packets_wrong_flag", has_flags(payloads, model)),
        ("packets_wrong_azimuth", (azimuths_cdeg(payloads, model) < 36000).all(axis=1)),
        ("packets_wrong_stamp", stamps(payloads, model)[1]),
    ):
        report.count(reason, int((sound & ~right).sum()))
        sound &= right
    return sound


def stamps(payloads: Payloads, model: RoboSenseModel) -> tuple[Times, NDArray[np.bool_]]:
    """Times of the first shots on the clock of the sensor [ns], (N,), and whether they can be."""
    raw = np.ascontiguousarray(payloads[:, model.stamp_at : model.stamp_at + 10])
    if model.stamp == "date":
        return _dates_ns(raw.view(DATE)[:, 0])
    return stamps_of(raw, ns=model.stamp == "ns")


def with_stamp_unit(model: RoboSenseModel, payloads: Payloads) -> RoboSenseModel:
    """A model whose stamps are in ns, or the same with µs if its packets say so.

    The maker's driver reads µs where the manual of the Ruby Plus has ns: parts of a second that all
    are below a million are µs.

    Args:
        model: The sensor.
        payloads: Its data packets, (N, 1248).
    """
    if model.stamp != "ns" or len(payloads) < ROBOSENSE_ANGLES.stamps:
        return model
    raw = np.ascontiguousarray(payloads[:, model.stamp_at : model.stamp_at + 10])
    is_us = int(raw.view(STAMP)["rest"].max()) < SECOND_US
    return replace(model, stamp="us") if is_us else model


def stamps_of(raw: NDArray[np.uint8], *, ns: bool) -> tuple[Times, NDArray[np.bool_]]:
    """Seconds of 6 bytes and µs or ns of 4 bytes as times [ns], and whether they can be."""
    stamp = raw.view(STAMP)[:, 0]
    unit_ns = 1 if ns else 1000
    rest_ns = stamp["rest"].astype(np.int64) * unit_ns
    right = (stamp["high"] == 0) & (stamp["seconds"] <= LATEST_S) & (rest_ns < SECOND_NS)
    t_ns = stamp["seconds"].astype(np.int64) * SECOND_NS + rest_ns
    return np.where(right, t_ns, 0), right


def _dates_ns(date: NDArray[np.void]) -> tuple[Times, NDArray[np.bool_]]:
    right = np.ones(len(date), np.bool_)
    for name, low, high in (
        *[("month", 1, 12), ("day", 1, 31), ("hour", 0, 23), ("minute", 0, 59)],
        *[("second", 0, 59), ("ms", 0, 999), ("us", 0, 999), ("year", 0, 99)],
    ):
        right &= (date[name] >= low) & (date[name] <= high)
    month = (date["year"].astype(np.int64) + 30) * 12 + date["month"] - 1
    days = month.astype("datetime64[M]").astype("datetime64[D]").astype(np.int64) + date["day"] - 1
    minutes = (days * 24 + date["hour"]) * 60 + date["minute"]
    us = ((minutes * 60 + date["second"]) * 1000 + date["ms"]) * 1000 + date["us"]
    return np.where(right, us * 1000, 0), right


def stamp_bytes(t_ns: Times, kind: str) -> NDArray[np.uint8]:
    """Times as a model states them, inverse of `stamps`: ``date``, ``us`` or ``ns``, (N, 10)."""
    seconds, rest_ns = np.divmod(np.asarray(t_ns, np.int64), SECOND_NS)
    if kind != "date":
        stamp = np.zeros(len(seconds), STAMP)
        stamp["seconds"], stamp["rest"] = seconds, rest_ns // (1 if kind == "ns" else 1000)
        return stamp.view(np.uint8).reshape(-1, 10)
    us = rest_ns // 1000
    date = dates_of(seconds) - (2000, 0, 0, 0, 0, 0)
    words = np.stack([us // 1000, us % 1000], axis=1).astype(">u2")
    return np.hstack([date.astype(np.uint8), words.view(np.uint8)])


def variants_of(payloads: Payloads, model: RoboSenseModel) -> NDArray[np.uint8]:
    """How many returns packets have, from blocks of the same azimuth, (N,).

    A block with the second returns has the azimuth of that with the first ones.
    """
    azimuth = azimuths_cdeg(payloads, model)
    if model.layout.blocks == 3:
        ahead = azimuth[:, 1] == azimuth[:, 2]
        dual = azimuth[:, 0] == azimuth[:, 1]
        single = np.where(ahead, PacketReturns.DUAL_AHEAD, PacketReturns.SINGLE)
        return np.where(dual, PacketReturns.DUAL, single).astype(np.uint8)
    rows = model.rows
    pairs = azimuth[:, :: 2 * rows] == azimuth[:, rows :: 2 * rows]
    return np.where(pairs.all(axis=1), PacketReturns.DUAL, PacketReturns.SINGLE).astype(np.uint8)


def packet_s(model: RoboSenseModel, *, dual: bool) -> float:
    """Usual time from one data packet to the next [s]."""
    returns = 2 if dual else 1
    return 1e-6 * model.firing_us * model.layout.blocks / (model.rows * returns)


def spinning_tables(
    model: RoboSenseModel, angles: LaserAngles, settings: IngestSettings
) -> SpinningTables:
    """The tables of a sensor. Beams leave the head at `along_m` towards the azimuth of the block,
    not that of the laser.
    """
    shape = model.time_us.shape
    laser = np.arange(model.time_us.size).reshape(shape) % model.lasers
    azimuth_cdeg = angles.cdeg[laser, 1]
    turned = np.deg2rad(azimuth_cdeg / 100)
    return SpinningTables(
        layout=model.layout,
        roles=_roles(model),
        channels=beams(
            np.deg2rad(angles.cdeg[laser, 0] / 100),
            azimuth_cdeg=azimuth_cdeg,
            origin_m=(model.along_m * np.cos(turned), -model.along_m * np.sin(turned), model.up_m),
            fraction=model.time_us / model.firing_us,
        ),
        distances=distances(model.unit_m, settings),
    )


def _roles(model: RoboSenseModel) -> BlockRoles:
    blocks, rows = model.layout.blocks, model.rows
    block = np.arange(blocks)
    if blocks == 3:  # A, A's second, B; and A, B, B's second
        ahead = (np.array([0, 2]), np.array([1, -1])), (np.array([0, 1]), np.array([-1, 2]))
        dual = [_one_role(model, first, twin, group=2) for first, twin in ahead]
        return variants(_one_role(model, block, np.full(3, -1), group=1), *dual)
    firsts = block[block % (2 * rows) < rows]
    return variants(
        _one_role(model, block, np.full(blocks, -1), group=rows),
        _one_role(model, firsts, firsts + rows, group=2 * rows),
    )


def _one_role(
    model: RoboSenseModel, block: NDArray[np.int64], twin: NDArray[np.int64], *, group: int
) -> BlockRoles:
    """One variant: the blocks that are read, in order, ``group`` blocks to a firing."""
    order = np.arange(len(block))
    row = order % model.rows
    time_us = (order // model.rows)[:, None] * model.firing_us + model.time_us[row]
    return BlockRoles(
        np.array([group], np.int64),
        block.astype(np.int64)[None],
        twin.astype(np.int64)[None],
        row.astype(np.int64)[None],
        np.rint(1000.0 * time_us).astype(np.int64)[None],
    )


def split_blocks(payloads: Payloads, model: RoboSenseModel) -> NDArray[np.uint8]:
    """Blocks of two halves as two blocks of the same azimuth, (N, 2 B (4 + bytes of a half)).

    A Helios 16P of two returns sends the first returns of its 16 lasers, then the second ones.
    """
    blocks = block_bytes(payloads, model)
    half = (model.layout.block - 4) // 2
    head = blocks[:, :, :4]
    halves = (blocks[:, :, 4 : 4 + half], blocks[:, :, 4 + half :])
    parts = [np.concatenate([head, part], axis=2) for part in halves]
    return np.stack(parts, axis=2).reshape(len(payloads), -1)
