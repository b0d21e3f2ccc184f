"""Velodyne packets and pcap files written: the inverse of `velodyne`, `positions` and `pcap`."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import IO

import numpy as np
from numpy.typing import NDArray

from recon4.model.trajectory import Times
from recon4.recording.packets.velodyne.models import (
    BLOCK_FLAG,
    BLOCKS,
    CHANNELS,
    DATA_PACKET,
    DATA_SIZE,
    POSITION_SIZE,
    STRONGEST,
    VelodyneModel,
)
from recon4.units import HOUR_US

_HEADER = np.dtype(
    [
        ("ethernet", "u1", 12),
        ("ethertype", ">u2"),
        ("version", "u1"),
        ("service", "u1"),
        ("ip_length", ">u2"),
        ("identification", ">u2"),
        ("fragment", ">u2"),
        ("lifetime", "u1"),
        ("protocol", "u1"),
        ("checksum", ">u2"),
        ("source", "u1", 4),
        ("destination", "u1", 4),
        ("source_port", ">u2"),
        ("port", ">u2"),
        ("udp_length", ">u2"),
        ("udp_checksum", ">u2"),
    ]
)
"""Ethernet, IPv4 and UDP headers in front of a payload."""


@dataclass(frozen=True, slots=True, eq=False)
class PacketBlocks:
    """The blocks of P data packets."""

    azimuth_cdeg: NDArray[np.integer]
    """Azimuth at the first shot of each block [0.01°], taken modulo 360°, (P, 12)."""
    distance: NDArray[np.integer]
    """Distance in units of the model (2 mm for a VLP-16), 0 = no return, (P, 12, 32)."""
    intensity: NDArray[np.integer]
    """0..255, (P, 12, 32)."""


def encode_packets(
    t_us: NDArray[np.integer],
    blocks: PacketBlocks,
    *,
    model: VelodyneModel,
    return_mode: int = STRONGEST,
) -> NDArray[np.uint8]:
    """Data packets.

    Args:
        t_us: Time of the first shot of each packet [µs]; only the part past the hour is kept, (P,).
        blocks: Their azimuths and returns.
        model: The sensor.
        return_mode: In dual mode blocks 2k (last) and 2k + 1 (strongest) belong together.

    Returns:
        UDP payloads, (P, 1206).
    """
    packets = np.zeros(len(t_us), dtype=DATA_PACKET)
    written = packets["blocks"]
    written["flag"] = BLOCK_FLAG
    written["azimuth_cdeg"] = np.asarray(blocks.azimuth_cdeg) % 36000
    written["returns"]["distance"] = blocks.distance
    written["returns"]["intensity"] = blocks.intensity
    packets["time_us"] = np.asarray(t_us) % HOUR_US
    packets["return_mode"] = return_mode
    packets["product"] = model.product
    assert written["returns"].shape == (len(t_us), BLOCKS, CHANNELS)
    return packets.view(np.uint8).reshape(-1, DATA_SIZE)


def encode_position(t_us: int, nmea: str, *, pps: int = 2) -> NDArray[np.uint8]:
    """A position packet.

    Args:
        t_us: Time stamp [µs]; only the part past the hour is kept.
        nmea: Sentence without ``$`` and checksum, for example of `rmc_sentence`; empty = none.
        pps: 0 no pulse, 1 synchronizing, 2 locked, 3 error.

    Returns:
        UDP payload, (512,).
    """
    payload = np.zeros(POSITION_SIZE, dtype=np.uint8)
    payload[198:202] = np.frombuffer(struct.pack("<I", t_us % HOUR_US), dtype=np.uint8)
    payload[202] = pps
    if nmea:
        checksum = np.bitwise_xor.reduce(np.frombuffer(nmea.encode("ascii"), dtype=np.uint8))
        text = f"${nmea}*{checksum:02X}\r\n".encode("ascii")
        assert len(text) <= 128
        payload[206 : 206 + len(text)] = np.frombuffer(text, dtype=np.uint8)
    return payload


def rmc_sentence(t_ns: int, *, lat_deg: float, lon_deg: float, valid: bool = True) -> str:
    """The body of a ``GPRMC`` sentence: position at a whole second of UTC (t_ns is rounded)."""
    moment = np.datetime64(round(t_ns / 1e9), "s").item()
    return (
        f"GPRMC,{moment:%H%M%S},{'A' if valid else 'V'},{_angle(lat_deg, 2, 'NS')},"
        f"{_angle(lon_deg, 3, 'EW')},000.0,000.0,{moment:%d%m%y},000.0,W"
    )


def _angle(degrees: float, digits: int, signs: str) -> str:
    minutes_1e5 = round(abs(degrees) * 60e5)
    whole, rest = divmod(minutes_1e5, 60 * 100_000)
    return f"{whole:0{digits}d}{rest / 1e5:08.5f},{signs[degrees < 0]}"


class PcapWriter:
    """Writes UDP datagrams to a classic pcap file with nanosecond stamps.

    Use as a context manager; `write` streams, nothing is kept.
    """

    def __init__(self, path: Path) -> None:
        self._file: IO[bytes] = path.open("wb")
        self._file.write(struct.pack("<IHHiIII", 0xA1B23C4D, 2, 4, 0, 0, 65535, 1))

    def __enter__(self) -> PcapWriter:
        return self

    def __exit__(self, *_: object) -> None:
        self._file.close()

    def write(
        self, t_ns: Times, payloads: NDArray[np.uint8], *, source: str, port: int = 2368
    ) -> None:
        """Append datagrams.

        Args:
            t_ns: Times of arrival [ns], (N,).
            payloads: UDP payloads of one length, (N, B).
            source: IPv4 address of the sensor.
            port: Destination port; the source port is the same.
        """
        size = payloads.shape[1]
        records = np.zeros(
            len(payloads),
            dtype=[("stamp", "<u4", 4), ("header", _HEADER), ("payload", "u1", size)],
        )
        length = _HEADER.itemsize + size
        seconds, nanoseconds = np.divmod(np.asarray(t_ns, dtype=np.int64), 1_000_000_000)
        records["stamp"] = length
        records["stamp"][:, 0], records["stamp"][:, 1] = seconds, nanoseconds
        records["header"] = _header(size, source, port)
        records["payload"] = payloads
        self._file.write(records.tobytes())


@cache
def _header(size: int, source: str, port: int) -> NDArray[np.void]:
    header = np.zeros(1, dtype=_HEADER)
    header["ethernet"] = [255] * 6 + [0x60, 0x76, 0x88, 0, 0, 1]
    header["ethertype"], header["version"] = 0x0800, 0x45
    header["ip_length"], header["udp_length"] = 28 + size, 8 + size
    header["lifetime"], header["protocol"] = 255, 17
    header["source"] = [int(part) for part in source.split(".")]
    header["destination"] = 255
    header["source_port"] = header["port"] = port
    words = np.frombuffer(header.tobytes()[14:34], dtype=">u2").sum(dtype=np.uint32)
    header["checksum"] = 0xFFFF - (words % 0xFFFF)
    return header
