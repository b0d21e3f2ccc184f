"""Heads of real streams are taken by the family that made them and by no other."""

import re
import sqlite3
from itertools import islice

import numpy as np
import pytest

from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.families import FAMILIES
from recon4.recording.report import ImportReport


def takers(head):
    """Names of the families that take a head, and what the first one says of it."""
    answers = {family.name: family.recognize(head, ()) for family in FAMILIES}
    return {name: found for name, found in answers.items() if found is not None}


@pytest.mark.parametrize(
    ("folder", "flag", "size", "maker", "model"),
    [
        ("hesai/xt32", b"\xee\xff", 1080, "Hesai", "XT32"),
        ("hesai/xt32m", b"\xee\xff", 820, "Hesai", "XT32M2X"),
        ("hesai/40p", b"\xff\xee", 1262, "Hesai", "Pandar40P"),
        ("hesai/qt64", b"\xee\xff", 1072, "Hesai", "QT64"),
        ("hesai/qt128", b"\xee\xff", 1127, "Hesai", "QT128"),
        ("robosense/helios16P", b"\x55\xaa\x05\x5a", 1248, "RoboSense", "Helios 5515"),
        ("velodyne/vlp16", b"\xff\xee", 1206, "Velodyne", "VLP-16"),
        ("velodyne/vlp32", b"\xff\xee", 1206, "Velodyne", "VLP-32C"),
        ("velodyne/vls128", b"\xff\xee", 1206, "Velodyne", "VLS-128"),
    ],
)
def test_packets_in_bags_are_taken_by_their_maker_alone(data, folder, flag, size, maker, model):
    file = next(data(f"packets/nebula/{folder}").rglob("*.db3"))
    with sqlite3.connect(f"file:{file}?immutable=1", uri=True) as base:
        blob = base.execute("SELECT data FROM messages ORDER BY id").fetchone()[0]
    packets = [blob[at : at + size] for at in spaced(blob, flag, size)]
    head = datagrams_of([10**18] * len(packets), packets)

    found = takers(head)

    assert len(packets) > 50
    assert {name: (one.kind, one.model) for name, one in found.items()} == {maker: ("data", model)}


def spaced(blob, flag, size):
    """Where packets begin: the first place of the flag, and every next one beyond the packet."""
    at = [found.start() for found in re.finditer(re.escape(flag), blob)]
    starts = []
    for place in at:
        if (not starts or place >= starts[-1] + size) and place + size <= len(blob):
            starts.append(place)
    return starts[:150]


@pytest.mark.parametrize(
    ("folder", "maker"), [("mrpt", "Velodyne"), ("veloview", "Velodyne"), ("ouster", "Ouster")]
)
def test_streams_of_captures_are_taken_by_no_other_maker(data, folder, maker):
    seen = set()
    for file in sorted(data(f"packets/{folder}").glob("*.pcap")):
        for batch in islice(read_pcap(file, ImportReport()), 2):
            for port in set(batch.port.tolist()):
                seen |= set(takers(batch.take(np.flatnonzero(batch.port == port))))
    assert seen <= {maker}
    assert seen or maker == "Ouster"  # which wants its metadata
