"""Limits of what a recording may hold: hostile and damaged input is refused, or read in part."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class InputLimits:
    """More than this is refused, or left out and said. Bags and compressed files:
    `formats/limits.py`.
    """

    latest_ns: int = 1 << 62
    """No clock shows more: the year 2116 [ns]. Twice as much is the largest number of 64 bits."""
    streams: int = 256
    """Senders and ports with the most datagrams at the head of a file; a LiDAR is among them."""
    companion_bytes: int = 1 << 20
    """Of a file beside a capture that may tell what the packets of a sensor do not."""
    metadata_bytes: int = 8 << 20
    """Of the metadata of an Ouster; with zones it has some 50 kB."""
    lvx_frame_bytes: int = 64 << 20
    """A frame of 50 ms of one device has 150 kB."""
    angle_rows: int = 200
    """Of a table of the angles of the beams."""


LIMITS = InputLimits()
