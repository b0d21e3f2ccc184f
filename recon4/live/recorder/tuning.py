"""Times and limits of the recorder."""

from __future__ import annotations

from msgspec import Struct


class CaptureFileTuning(Struct, frozen=True, kw_only=True):
    """The capture file."""

    write_every_s: float = 0.05
    """Datagrams are written this often [s] …"""
    sync_every_s: float = 1.0
    """… and synced this often [s]."""
    max_waiting_bytes: int = 64 << 20
    """Half a minute of two VLP-16; datagrams beyond it are dropped and counted."""


CAPTURE_FILE = CaptureFileTuning()


class DeviceOpenerLimits(Struct, frozen=True, kw_only=True):
    """The process that opens a device."""

    max_words: int = 1000
    """Longest message of an error."""


DEVICE_OPENER = DeviceOpenerLimits()


class DiskTuning(Struct, frozen=True, kw_only=True):
    """When the disk is full."""

    trend_s: float = 60.0
    """The fill rate is measured over this period."""
    sure_after_s: float = 5.0
    """No prediction before this time [s]."""
    min_per_s: float = 1000.0
    """Fill rate below which no time left is predicted [bytes/s]."""


DISK = DiskTuning()


class PortTuning(Struct, frozen=True, kw_only=True):
    """UDP ports."""

    buffer_bytes: int = 16 << 20
    """Requested receive buffer; six seconds of two VLP-16."""
    longest: int = 65_535
    """Bytes of a datagram: a scan as JSON has some ten thousand."""


PORTS = PortTuning()


class RecorderTuning(Struct, frozen=True, kw_only=True):
    """The recorder."""

    status_every_s: float = 0.5
    """Time between two messages of its state [s]."""
    max_senders: int = 64
    """Counted one by one; datagrams of further senders are counted together."""
    data_bytes: int = 513
    """Data packets of all LiDARs are larger; position and IMU packets are not."""
    at_once: int = 256
    """Datagrams read from a port before the other ports are read."""


RECORDER = RecorderTuning()


class SerialLineTuning(Struct, frozen=True, kw_only=True):
    """A receiver on a serial line."""

    retry_s: float = 1.0
    """A device that cannot be opened is tried again after this time [s]."""
    poll_s: float = 0.2
    """Longest wait for bytes [s]."""
    at_once: int = 4096
    """Bytes that are read at a time."""
    longest: int = 1024
    """Bytes passed on as one sentence if no line end comes."""


SERIAL_LINE = SerialLineTuning()
