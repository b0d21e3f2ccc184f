"""Capture files with datagrams of scans, for tests."""

import threading
from contextlib import contextmanager
from pathlib import Path

from recon4.live.recorder.capture_file import _FILE_HEADER, Datagram, pcap_record
from recon4.live.replay import replay
from recon4.model.ports import PORTS
from recon4.model.rig import format_rig, parse_rig
from recon4.progress import Silent
from recon4.recording.lasers.scan_datagrams import encode_scans_row
from recon4.recording.lasers.scan_replay import datagrams_of_scans
from tests.loopback import an_address
from tests.service.running import server_thread

LASER = parse_rig('name = "robot"\n[[sensor]]\nname = "laser2d"\nkind = "laser2d"', where="test")

DELAY_NS = 3_000_000
"""Time from the stamp of a scan to its arrival."""


def write_capture(path, datagrams):
    """Write datagrams: (arrival [ns], port, payload) of each."""
    with Path(path).open("wb") as file:
        file.write(_FILE_HEADER)
        for t_ns, port, payload in datagrams:
            file.write(pcap_record(Datagram(t_ns, ("10.0.0.9", 5000), port, payload)))


def scan_datagrams(scans, port=PORTS.laser2d):
    """Scans as they arrive."""
    return [
        (int(t_ns) + DELAY_NS, port, encode_scans_row(scans, k))
        for k, t_ns in enumerate(scans.t_ns)
    ]


def captured(recording, path, rig=None):
    """Write a recording of scans as the capture that its replay gives."""
    sent = datagrams_of_scans(recording, rig)
    write_capture(path, ((one.t_ns + DELAY_NS, one.port, one.payload) for one in sent))
    return path


@contextmanager
def capture_server(root, **rigs):
    """A server that receives captures, with rigs by their names."""
    (root / "rigs").mkdir()
    for name, rig in rigs.items():
        (root / "rigs" / f"{name}.toml").write_text(format_rig(rig))
    with server_thread(root, sensor_bind_address=an_address()) as running:
        yield running


@contextmanager
def sending(server, recording, **how):
    """A recording is replayed to a server; at the end all of it was sent."""
    target = server.app.state.parts.settings.sensor_bind_address
    how = {"progress": Silent(), "target": target, **how}
    thread = threading.Thread(target=replay, args=(recording,), kwargs=how)
    thread.start()
    yield
    thread.join()
