"""Tuning of what is looked at before a recording is read."""

from __future__ import annotations

from msgspec import Struct


class ProbeTuning(Struct, frozen=True, kw_only=True):
    """How much of a recording tells what it holds."""

    messages: int = 50
    """Messages of a topic."""
    stamps: int = 9
    """Messages whose stamps and times of recording tell the time from one to the next."""
    packets: int = 4500
    """Packets at the beginning of a topic from which its sensor is known: more than a second, as
    some send their angles once a second."""
    whole_bytes: int = 64 << 20
    """Files up to this size are read completely."""
    whole_packets: int = 100_000
    """Above this number of datagrams the counts of a small capture file are estimates too."""
    head_packets: int = 4000
    """Datagrams of a larger file from which its counts are estimated."""
    head_items: int = 40
    """Batches of points of a recording that `info` decodes."""
    head_ns: int = 1_000_000_000
    scan_datagrams: int = 20_000
    """Datagrams at the head of a file from which its streams of scans are known, …"""
    scan_batches: int = 16
    """… and batches of them."""
    head_step_ns: int = 5_000_000
    """Lines of a table that are looked at are this far apart [ns]."""
    files: int = 3
    """Files of a folder of points."""


PROBE = ProbeTuning()
