"""Real packets of a RoboSense Helios against the clouds of the Nebula driver.

The recording's sensor is a Helios 5515 of 32 lasers (its device packet has 32 measured angles, a
packet comes every 0.667 ms), but the reference was decoded as if it were a Helios 16P: channels 16
to 31 of a block as a second firing of the lasers 0 to 15. So it is compared with a Helios 16P here.
The reference cuts angles off to 0.01°, puts the turn of the last block at 0.20°, and its times are
whole seconds.
"""

import sqlite3
from types import SimpleNamespace

import numpy as np
import pytest

from recon4.recording.formats.datagrams import datagrams_of
from recon4.recording.packets.family import Companion, PacketSensor
from recon4.recording.packets.robosense.angles import device_data
from recon4.recording.packets.robosense.family import FAMILY as ROBOSENSE
from recon4.recording.packets.robosense.models import MODELS
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.unit.recording.packet_builders import sensor

FOLDER = "packets/nebula/robosense"
ENTRY = np.dtype(
    [
        *[("stamp", "<i4"), ("ns", "<u4"), ("flag", "u1"), ("data", "u1", 1500)],
        *[("pad", "u1", 3), ("size", "<u4")],
    ]
)
"""A packet in the messages of the bag."""
LIMITS = IngestSettings(min_range_m=0.2025, max_range_m=180.0)
"""Those of the reference: it wants more than 0.2 m."""


@pytest.fixture(scope="module")
def datagrams(data):
    """All packets of the bag, by the bytes of its messages: 32 before the first one."""
    (file,) = (data(FOLDER) / "helios16P").glob("*/*.db3")
    with sqlite3.connect(f"file:{file}?immutable=1", uri=True) as bag:
        rows = [row for (row,) in bag.execute("SELECT data FROM messages ORDER BY id")]
    packets = np.concatenate([np.frombuffer(row[32:], ENTRY) for row in rows])
    assert (packets["size"] == 1248).all()
    t_ns = packets["stamp"].astype(np.int64) * 10**9 + packets["ns"]
    return datagrams_of(t_ns.tolist(), [entry[:1248].tobytes() for entry in packets["data"]])


def decoded(datagrams, model, *, companions=(), **fields):
    report = ImportReport()
    of = PacketSensor(
        row=0,
        sensor=sensor(model=model),
        companions=companions,
        settings=LIMITS,
        report=report,
        **fields,
    )
    layout = ROBOSENSE.open(of)
    payloads = datagrams.payloads(np.arange(len(datagrams)), 1248)
    payloads = payloads[layout.sound(payloads)]
    t_ns = layout.stamps_ns(payloads)
    return SimpleNamespace(
        shots=layout.decode(t_ns, payloads), report=report, layout=layout, t_ns=t_ns
    )


def csv_of(data, name):
    path = data(FOLDER) / "calibration" / name
    return Companion(path.name, path.read_bytes())


def start_of(part, whole):
    """Where a sequence of numbers begins in another one; all of it is there."""
    (starts,) = np.nonzero(whole[: len(whole) - len(part) + 1] == part[0])
    (found,) = [at for at in starts if (whole[at : at + len(part)] == part).all()]
    return found


@pytest.mark.parametrize("scan", range(4))
def test_every_point_of_the_helios_reference_is_found_in_its_place(data, datagrams, scan):
    path = sorted((data(FOLDER) / "helios16P").glob("*.pcd"))[scan]
    cloud = np.loadtxt(path, skiprows=11)
    table = csv_of(data, "RobosenseHelios16P.csv")

    shots = decoded(datagrams, "Helios 16P", companions=[table]).shots

    # Same returns in the same order: none is missing, none invented.
    key = 256 * shots.ring.astype(np.int64) + shots.intensity
    ref_key = 256 * cloud[:, 5].astype(np.int64) + cloud[:, 3].astype(np.int64)
    first = start_of(ref_key, key)
    mine = slice(first, first + len(cloud))
    # Its angles are whole 0.01°, cut off: 5 mm at 29 m.
    off_m = np.linalg.norm(shots.xyz[mine] - cloud[:, :3], axis=1)
    assert np.all(off_m <= 0.0005 + np.deg2rad(0.025) * cloud[:, 8])
    assert np.mean(off_m <= 0.005) > 0.997


def test_the_device_packet_tells_that_it_is_a_helios_5515_on_a_level_floor(data, datagrams):
    device = device_data(datagrams.payloads(np.arange(len(datagrams)), 1248), MODELS["Helios 32"])
    found = ROBOSENSE.recognize(datagrams, ())
    result = decoded(datagrams, found.model, head=datagrams)
    shots = result.shots

    assert len(device.angles_cdeg) == 32
    assert not device.dual
    assert (found.model, found.kind) == ("Helios 5515", "data")
    assert found.packet_s == pytest.approx(0.000667, rel=0.01)
    assert not result.report.findings
    # It stands on a roof 0.68 m below: each of the rings from -55° to -22° sees it there.
    on_roof = np.abs(shots.xyz[:, 2] + 0.675) < 0.025
    assert np.bincount(shots.ring[on_roof], minlength=32)[:12].min() > 300
