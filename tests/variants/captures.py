"""Captures of a VLP-16, with what recorders and networks do to them."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np

from recon4.recording.velodyne.encode import PcapWriter
from tests.line_tables import write_csv
from tests.variants.variant import Draw, Variant
from tests.variants.walk import RecordedWalk

_SECOND_NS = 1_000_000_000
_STAMP = slice(1200, 1204)
"""Where a data packet has its time since the hour [µs]."""
_RECORD = 16


def write_capture(draw: Draw, walk: RecordedWalk, folder: Path) -> Variant:
    """Draw and write a capture, with an IMU file beside it."""
    variant = Variant("pcap", folder / "walk.pcap")
    t_ns, packets = walk.packet_ns.copy(), walk.packets.copy()
    total = sum(len(cloud.xyz) for cloud in walk.clouds)
    t_ns, packets = _clock(draw, variant, t_ns, packets)
    t_ns, packets = _network(draw, variant, t_ns, packets)
    variant.points = total * len(np.unique(packets, axis=0)) // len(walk.packets)
    with PcapWriter(variant.path) as file:
        noise = draw.chance(0.3)
        if noise:
            variant.say("packets of another device")
        for first in range(0, len(t_ns), 20):
            rows = slice(first, first + 20)
            file.write(t_ns[rows], packets[rows], source="192.168.1.201")
            if noise:
                other = np.zeros((1, 60), np.uint8)
                file.write(t_ns[rows][:1], other, source="192.168.1.7", port=5353)
    _file(draw, variant)
    if draw.chance(0.7):
        _imu_file(draw, walk, folder, variant)
    return variant


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


def _file(draw, variant):
    data = variant.path.read_bytes()
    how = draw.one("", "", "", "", "cut", "snap length", "microseconds", "cooked")
    if how:
        variant.say(f"file {how}")
    if how == "cut":
        ratio = draw.one(0.5, 0.95)
        variant.path.write_bytes(data[: int(len(data) * ratio)])
        variant.points = int(variant.points * ratio * 0.97)
    elif how == "snap length":
        ratio = draw.one(1.0, 0.1)
        snapped = _snapped(draw, data, ratio)
        whole = sum(len(packet) > 1206 for _, packet in _records(snapped))
        variant.path.write_bytes(snapped)
        variant.refusal = "all packets are cut" if ratio == 1.0 else ""
        variant.points = variant.points * whole // sum(1 for _ in _records(data))
    elif how == "microseconds":
        variant.path.write_bytes(struct.pack("<I", 0xA1B2C3D4) + _in_microseconds(data[4:]))
    elif how == "cooked":
        variant.path.write_bytes(_cooked(data))


def _records(data):
    at = 24
    while at + _RECORD <= len(data):
        stamp = data[at : at + 8]
        length = struct.unpack_from("<I", data, at + 8)[0]
        yield stamp, data[at + _RECORD : at + _RECORD + length]
        at += _RECORD + length


def _snapped(draw, data, ratio):
    parts = [data[:24]]
    for stamp, packet in _records(data):
        kept = packet[:1000] if draw.chance(ratio) else packet
        parts += [stamp, struct.pack("<II", len(kept), len(packet)), kept]
    return b"".join(parts)


def _in_microseconds(data):
    parts = [data[:20]]
    for stamp, packet in _records(b"\0\0\0\0" + data):
        seconds, nanoseconds = struct.unpack("<II", stamp)
        parts.append(struct.pack("<IIII", seconds, nanoseconds // 1000, *[len(packet)] * 2))
        parts.append(packet)
    return b"".join(parts)


def _cooked(data):
    parts = [data[:20] + struct.pack("<I", 113)]
    for stamp, packet in _records(data):
        cooked = struct.pack(">HHH", 0, 1, 6) + packet[6:12] + b"\0\0" + packet[12:]
        parts += [stamp, struct.pack("<II", *[len(cooked)] * 2), cooked]
    return b"".join(parts)


def _imu_file(draw, walk, folder, variant):
    """Samples as a table, with what programs make of it."""
    imu = walk.imu
    names = ("t_ns", "gx_rad_s", "gy_rad_s", "gz_rad_s", "ax_m_s2", "ay_m_s2", "az_m_s2")
    columns = [imu.t_ns, *imu.gyro_rad_s.T, *imu.accel_m_s2.T]
    order = list(range(7))
    if draw.chance(0.3):
        variant.say("IMU columns in another order")
        draw.rng.shuffle(order)
    variant.imu = folder / "imu.csv"
    write_csv(variant.imu, {names[k]: columns[k] for k in order})
    lines = variant.imu.read_text().splitlines()
    how = draw.one("", "", "damaged lines", "decimal commas", "cut line", "no accelerations")
    if how:
        variant.say(f"IMU file with {how}")
    if how == "damaged lines":
        for k in draw.rows(len(lines) - 1, 5):
            lines[k + 1] = draw.one("x", "1,2", "\0\0\0", lines[k + 1].replace(".", "_"))
    elif how == "decimal commas":
        lines = [line.replace(",", ";").replace(".", ",") for line in lines]
    elif how == "cut line":
        lines[-1] = lines[-1][:9]
    elif how == "no accelerations":
        kept = [k for k in order if k < 4]
        write_csv(variant.imu, {names[k]: columns[k] for k in kept})
        lines = variant.imu.read_text().splitlines()
    variant.imu.write_text("\n".join(lines) + "\n")
    variant.samples = len(imu) - 6
