"""Recordings that several folders of tests share, made once."""

import pytest

from recon4.simulation.frames import simulate_frames
from recon4.simulation.setup import prepare
from recon4.store.frames import FrameStore
from tests.made_once import made_once


@pytest.fixture(scope="session")
def office_walk(tmp_path_factory):
    """Folder of six seconds of a person's walk through the simulated office, with an IMU."""

    def make(folder):
        folder.mkdir()
        simulate_frames(prepare("office", seconds=6.0, seed=3), folder)

    return made_once(tmp_path_factory, "office-frames", make)


@pytest.fixture
def office_frames(office_walk):
    """The multiframes of that walk."""
    return FrameStore.open(office_walk)
