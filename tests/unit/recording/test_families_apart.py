"""Real packets of one maker are not taken for those of another."""

from itertools import islice

import numpy as np
import pytest

from recon4.recording.formats.bags import Bag
from recon4.recording.formats.datagrams import Datagrams, datagrams_of
from recon4.recording.formats.pcap import read_pcap
from recon4.recording.packets.families import FAMILIES
from recon4.recording.packets.messages import PACKET_MESSAGES
from recon4.recording.packets.streams import recognized
from recon4.recording.report import ImportReport
from tools.structure import ROOT

PACKETS = ROOT / "recon4/recording/packets"
MAKERS = {
    "packets/mrpt": "Velodyne",
    "packets/veloview": "Velodyne",
    "packets/ouster": "Ouster",
    "packets/nebula/velodyne": "Velodyne",
    "packets/nebula/robosense": "RoboSense",
    "packets/nebula/hesai": "Hesai",
}
"""Folder of the samples -> maker of the sensors in it."""


def families_of(head):
    """Names of the families that take datagrams of one port."""
    answers = (family.recognize(head, ()) for family in FAMILIES)
    return [answer.family for answer in answers if answer is not None]


def port_by_port(batch):
    for port in np.unique(batch.port):
        yield batch.take(np.flatnonzero(batch.port == port))


def bag_packets(path):
    """The packets of each topic of a bag, as datagrams."""
    with Bag([path], ImportReport()) as bag:
        for topic in bag.topics:
            kind = PACKET_MESSAGES.get(topic.type)
            if kind is None:
                continue
            messages = islice(bag.messages([topic.name]), 40)
            packets = [one for message in messages for one in kind.packets(bag.decode(message))]
            yield datagrams_of([t for t, _ in packets], [bytes(data) for _, data in packets])


def heads(folder) -> list[Datagrams]:
    found = []
    for file in sorted(folder.rglob("*.pcap")):
        for batch in islice(read_pcap(file, ImportReport()), 2):
            found += port_by_port(batch)
    bags = [*folder.rglob("*.bag"), *(file.parent for file in folder.rglob("metadata.yaml"))]
    for bag in bags:
        found += bag_packets(bag)
    return found


def test_each_family_is_found_by_its_maker_and_has_its_row_in_the_documentation():
    modules = [
        file
        for file in PACKETS.rglob("*.py")
        if "\nFAMILY: PacketFamily" in file.read_text("utf-8")
    ]
    page = (ROOT / "docs/reference/packets.md").read_text("utf-8")

    named = {(file.parent if file.name == "family.py" else file).stem for file in modules}
    assert named == {family.name.lower() for family in FAMILIES}
    missing = [f"| [{f.name}](" for f in FAMILIES if f"\n| [{f.name}](" not in page]
    assert not missing, f"docs/reference/packets.md has no row that begins with {missing}"


@pytest.mark.parametrize(("folder", "maker"), MAKERS.items())
def test_packets_are_taken_by_their_own_family_alone(folder, maker, data):
    found = [families_of(head) for head in heads(data(folder))]

    assert found and found == [[maker]] * len(found)


@pytest.mark.parametrize(
    ("folder", "model"),
    [
        ("hesai/xt32", "XT32"),
        ("hesai/xt32m", "XT32M2X"),
        ("hesai/40p", "Pandar40P"),
        ("hesai/qt64", "QT64"),
        ("hesai/qt128", "QT128"),
        ("robosense/helios16P", "Helios 5515"),  # by its device packets, whatever its folder says
        ("velodyne/vlp16", "VLP-16"),
        ("velodyne/vlp32", "VLP-32C"),
        ("velodyne/vls128", "VLS-128"),
    ],
)
def test_the_model_of_a_bag_is_known_from_its_packets(folder, model, data):
    (head,) = heads(data(f"packets/nebula/{folder}"))

    found = recognized(head)

    assert (found.kind, found.model) == ("data", model)
