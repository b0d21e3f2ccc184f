"""Captures of Velodynes, with what their clocks and networks do to them."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from recon4.recording.packets.velodyne.encode import PcapWriter, encode_position, rmc_sentence
from tests.variants.capture_files import spoil_file
from tests.variants.other_lidars import packets_of
from tests.variants.tables import write_tables
from tests.variants.variant import Draw, Variant
from tests.variants.walk import RecordedWalk

_SECOND_NS = 1_000_000_000
_SENSOR = "192.168.1.201"
_STAMP = slice(1200, 1204)
"""Where a data packet has its time since the hour [µs]."""


def write_capture(draw: Draw, walk: RecordedWalk, folder: Path) -> Variant:
    """Draw and write a capture, with an IMU file beside it."""
    sensor = draw.one(*["VLP-16"] * 4, "VLP-16 dual", "VLP-16 dual", "HDL-32E", "VLP-32C")
    variant = Variant(f"pcap, {sensor}", folder / "walk.pcap", timed=True)
    measured = packets_of(walk, sensor)
    t_ns, packets = measured.t_ns.copy(), measured.payloads.copy()
    t_ns, packets = _clock(draw, variant, t_ns, packets)
    t_ns, packets = _network(draw, variant, t_ns, packets)
    beside = _beside(draw, variant)
    with PcapWriter(variant.path) as file:
        for first in range(0, len(t_ns), 20):
            rows = slice(first, first + 20)
            file.write(t_ns[rows], packets[rows], source=_SENSOR)
            beside(file, t_ns[rows][:1], first)
    spoil_file(draw, variant)
    write_tables(draw, walk, folder, variant)
    return variant


def _beside(draw, variant):
    """What is sent beside the data packets: by another device, or with the time of a GPS."""
    noise = draw.chance(0.3)
    if noise:
        variant.say("packets of another device")
    plain_clock = not any("clock" in trait for trait in variant.traits)
    positions = draw.chance(0.4) and plain_clock
    if positions:
        variant.say("position packets without a fix")

    def write(file, t_ns, first):
        if noise:
            file.write(t_ns, np.zeros((1, 60), np.uint8), source="192.168.1.7", port=5353)
        if positions and first % 200 == 0:
            sentence = rmc_sentence(int(t_ns[0]), lat_deg=0.0, lon_deg=0.0, valid=False)
            packet = encode_position(int(t_ns[0]) // 1000, sentence, pps=0)
            file.write(t_ns, packet[None], source=_SENSOR, port=8308)

    return write


def _clock(draw, variant, t_ns, packets):
    """The time of the sensor: UTC, since power-on, or past the hour without GPS."""
    since_us = np.array([struct.unpack("<I", p.tobytes()) for p in packets[:, _STAMP]]).ravel()
    how = draw.one("UTC", "UTC", "since power-on", "past the hour", "over the wrap", "new hour")
    since_us = (since_us - since_us[0]) % 3_600_000_000
    if how != "UTC":
        variant.say(f"sensor's clock {how}")
        start = {
            "since power-on": 77_000_000,
            "past the hour": 3_600_000_000 - 2_000_000,
            "over the wrap": 2**32 - 2_000_000,
            "new hour": 3_600_000_000 - 2_000_000,
        }[how]
        wrap = 3_600_000_000 if how == "new hour" else 2**32
        packets[:, _STAMP] = _bytes((since_us + start) % wrap)
    return t_ns, packets


def _bytes(values):
    return values.astype("<u4").view(np.uint8).reshape(-1, 4)


def _network(draw, variant, t_ns, packets):
    order = np.arange(len(t_ns))
    if draw.chance(0.3):
        kept = draw.rng.random(len(order)) > draw.one(0.005, 0.05)
        variant.say(f"{np.mean(~kept):.1%} lost")
        order = order[kept]
    if draw.chance(0.2):
        variant.say("a gap")
        at = len(order) // 2
        order = np.delete(order, slice(at, at + draw.one(50, 200, 400)))
        variant.exact = False
    if draw.chance(0.2):
        variant.say("twice")
        order = np.sort(np.concatenate([order, order[draw.rows(len(order), 40)]]))
    if draw.chance(0.2):
        variant.say("out of order")
        for k in draw.rows(len(order) - 1, 30):
            order[k], order[k + 1] = order[k + 1], order[k]
    packets = packets[order]
    times = np.sort(t_ns[order])
    if draw.chance(0.1):
        variant.say("another product byte in some")
        packets[draw.rows(len(packets), 5), 1205] = 0x99
    if draw.chance(0.1):
        variant.say("recorder's clock jumps")
        times = times + np.where(np.arange(len(times)) > len(times) // 2, 30 * _SECOND_NS, 0)
    return times, packets
