"""Files of datagrams of any kind: captures of the network, files of Livox Viewer."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from recon4.recording.formats.datagrams import Datagrams
from recon4.recording.formats.pcap import OpenFile, is_pcap, open_plain, read_pcap
from recon4.recording.packets.livox.lvx import is_lvx, read_lvx
from recon4.recording.report import ImportReport


def is_datagram_file(path: Path) -> bool:
    """Whether a file begins as one of datagrams."""
    return is_pcap(path) or is_lvx(path)


def read_datagrams(
    path: Path, report: ImportReport, open_file: OpenFile = open_plain
) -> Iterator[Datagrams]:
    """Stream the datagrams of a file, see `read_pcap` and `read_lvx`.

    Raises:
        UnknownFormat: If it is none.
        CorruptFile: If an LVX file ends inside its list of devices.
        EmptyRecording: If it holds no packet.
    """
    return (read_lvx if is_lvx(path) else read_pcap)(path, report, open_file)
