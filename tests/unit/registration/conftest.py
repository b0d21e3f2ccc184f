"""Multiframes of the simulated office, for tests of the odometry."""

import pytest

from recon4.progress import Silent
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import preset
from recon4.store.frames import FrameStore


@pytest.fixture(scope="package")
def frames(office_recording, tmp_path_factory):
    folder = tmp_path_factory.mktemp("frames")
    sources = Sources((office_recording / "recording.pcap",), imu=office_recording / "imu.csv")
    ingest(sources, folder, settings=preset("indoor").ingest, progress=Silent())
    return FrameStore.open(folder)
