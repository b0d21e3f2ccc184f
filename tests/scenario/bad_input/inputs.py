"""Files of bad input, and what is said of them."""

import json

from recon4.recording.packets.velodyne.encode import PcapWriter
from recon4.recording.samples.csv_files import GNSS_HEADER, IMU_HEADER
from tests.builders import (
    T0_NS,
    room_cloud,
)

FEW = [
    *("--set", "map.voxel_m=0.1", "--set", "graph.node_stride=10"),
]
SOURCE = "192.168.1.201"
HOUR_NS = 3_600_000_000_000


def counts(tmp_path, out="project"):
    (report,) = (tmp_path / out / "artifacts").glob("*/report.json")
    return json.loads(report.read_text())["counts"]


def assert_warned(summary, *words):
    """One warning contains all words, in the summary and in the report."""
    said = [one["text"] for one in summary["findings"]]
    found = [text for text in said if all(word in text for word in words)]
    assert found, said
    assert found[0] in summary["report"]


def write_pcap(path, t_ns, payloads):
    with PcapWriter(path) as file:
        file.write(t_ns, payloads, source=SOURCE)
    return path


def write_imu(path, *, count=100, gyro=(0.0, 0.0, 0.0), accel=(0.0, 0.0, 9.80665), noise=1e-4):
    """Samples of an IMU; ``noise`` makes each differ from the one before it."""
    rows = []
    for k in range(count):
        values = (value + noise * (k % 7) for value in (*gyro, *accel))
        rows.append(",".join(map(str, (T0_NS + k * 10_000_000, *values))))
    path.write_text("\n".join([",".join(IMU_HEADER), *rows]) + "\n")
    return path


def write_gnss(path, degrees, *, every_ns=100_000_000):
    rows = [
        f"{T0_NS + k * every_ns},{lat},{lon},300,0.01,0.01,0.02,4,,,"
        for k, (lat, lon) in enumerate(degrees)
    ]
    path.write_text("\n".join([",".join(GNSS_HEADER), *rows]) + "\n")
    return path


def altered_cloud(**changes):
    table = room_cloud()
    for name, change in changes.items():
        table[name] = change(table[name])
    return table
