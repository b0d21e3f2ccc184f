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

    folder_depth: int = 3
    """Levels of subfolders in which recordings are searched."""
    folders: int = 50
    """Subfolders that are looked at in a folder, and candidates that are named."""
    sample_files: int = 50
    """CSV files that are looked at; a folder with more is no folder of a recording."""
    sample_file_bytes: int = 1 << 30
    """About ten million samples: an IMU of 400 Hz for seven hours."""
    line_bytes: int = 16 * 1024
    """Of a line of a table of samples."""
    time_file_bytes: int = 64 << 20
    """Of the file with the times of frames."""
    ptx_skew: float = 0.01
    """Largest error of the rotation of a PTX scan: some makers write three digits."""
    cloud_file_bytes: int = 20 << 30
    """Of a cloud of points that is compared with a map."""
    coordinate_m: float = 1e8
    """Of a point in a table; no place on Earth has larger ones in any system."""
    id_characters: int = 64
    """Of the name of a point in a table."""

    text_message_bytes: int = 1 << 20
    """Of a message that may describe a sensor."""
    frame_pairs: int = 10_000
    """Pairs of frames; the largest robots have some hundred."""
    transform_messages: int = 20_000
    """Messages of one kind that are read: some minutes of the transforms of a robot that moves."""
    transforms: int = 100_000
    """Of one topic that are read, however they are spread over messages."""
    descriptions: int = 20
    """Descriptions of a robot that are read."""
    joint_poses: int = 2_000_000
    """Of one joint: five hours at 100 a second."""
    beams: int = 100_000
    """Of a scan, a line or a sweep: no sensor has more."""
    line_rows: int = 2_000_000
    """Of a longer table of lines only the head is read for `info`."""

    texts: int = 200
    """Different remarks that are kept; further ones are counted."""
    text_characters: int = 1000
    """Of a remark."""
    gaps: int = 1000
    """Gaps that are listed."""
    lags: int = 4000
    """Messages of a sensor from which its clock is compared."""


LIMITS = InputLimits()
