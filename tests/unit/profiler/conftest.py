"""A short walk of the Wuerzburg backpack with few shots, read into a frame store."""

from dataclasses import replace

import pytest

from recon4.profiler.tuning import LineTuning
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.ingest import ingest
from recon4.recording.sources import Sources
from recon4.settings import IngestSettings, Settings
from recon4.simulation.backpack import BackpackModels, prepare_backpack, simulate_backpack
from recon4.simulation.profiler import Laser2dModel, ProfilerModel
from recon4.store.frames import FrameStore

SECONDS = 24.0


@pytest.fixture(scope="session")
def settings():
    """Every point counts in a small recording."""
    lines = LineTuning(knot_s=0.1, map_every=1, match_every=1, turn_every=1, link_pairs=50)
    return replace(Settings(), lines=lines)


@pytest.fixture(scope="session")
def small_setup():
    models = BackpackModels(
        profiler=ProfilerModel(lines_hz=60.0, shots=120),
        laser2d=Laser2dModel(scans_hz=10.0, beams=271, angle_step_rad=0.0174533),
    )
    return prepare_backpack("hall", seed=5, figure="circle", seconds=SECONDS, models=models)


@pytest.fixture(scope="session")
def walk_folder(small_setup, tmp_path_factory):
    folder = tmp_path_factory.mktemp("backpack") / "walk"
    simulate_backpack(small_setup, folder, progress=Silent())
    return folder


@pytest.fixture(scope="session")
def truth(walk_folder):
    return read_tum(walk_folder / "truth.tum")


@pytest.fixture(scope="session")
def frames(walk_folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("frames")
    sources = Sources((walk_folder / "rosbag2",), None)
    ingest(sources, out, settings=IngestSettings(), progress=Silent())
    return FrameStore.open(out)
