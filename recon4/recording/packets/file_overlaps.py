"""Which captures of one sender are of one sensor: they follow each other, or share packets.

Two captures of the same time may be of two sensors that kept the address of the factory, each
recorded by a computer of its own. Captures that overlap, as those of a ring of files that were
merged by hand, hold the same packets there.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from recon4.errors import RecordingError
from recon4.recording.formats.datagrams import Datagrams, address_number
from recon4.recording.formats.pcap import OpenFile
from recon4.recording.packets.datagram_files import read_datagrams
from recon4.recording.packets.streams import PacketStream
from recon4.recording.report import ImportReport
from recon4.units import SECOND_NS

_AROUND_NS = SECOND_NS
"""Clocks of two recorders that listen to one sensor differ by less."""


def goes_on_in(earlier: PacketStream, later: PacketStream, open_file: OpenFile) -> bool:
    """Whether two streams of one sender to one port, in two files, are of one sensor.

    Args:
        earlier: It begins first; its end may be estimated.
        later: It begins before that end.
        open_file: Opens the files.

    Returns:
        Whether the earlier file ends before the later one begins, or has some of its packets.
    """
    wanted = {later.head.payload(row) for row in range(len(later.head))}
    first_ns = later.t_first_ns
    last_ns = int(later.head.t_ns[-1]) if len(later.head) else first_ns
    goes_beyond = False
    try:
        for mine in _of_sender(earlier, open_file):
            near = np.flatnonzero(np.abs(mine.t_ns - first_ns) <= last_ns - first_ns + _AROUND_NS)
            goes_beyond |= bool(np.any(mine.t_ns >= first_ns))
            if any(mine.payload(row) in wanted for row in near.tolist()):
                return True
            if mine.t_ns[0] > last_ns + _AROUND_NS:
                break
    except RecordingError:  # said when it is read
        return not goes_beyond
    return not goes_beyond


def _of_sender(stream: PacketStream, open_file: OpenFile) -> Iterator[Datagrams]:
    """What the sender of a stream sends to its port in its file."""
    source = address_number(stream.source)
    for batch in read_datagrams(stream.file, ImportReport(), open_file):
        mine = batch.take((batch.source == source) & (batch.port == stream.port))
        if len(mine):
            yield mine
