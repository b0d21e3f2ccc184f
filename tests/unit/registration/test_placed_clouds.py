"""Clouds in the frame of a map differ from those of a sensor, also of one that stands."""

from dataclasses import replace

import numpy as np
import pytest
from msgspec import structs

from recon4.errors import UnknownFormat
from recon4.progress import Silent
from recon4.registration import placed_clouds
from recon4.registration.placed_clouds import view_moves_on
from recon4.registration.tuning_motion import PLACED
from recon4.settings import IngestSettings
from recon4.settings.reads import ImportReads
from recon4.store.stage import StageContext
from recon4.workflows.stages import FRAMES
from tests.room_walks import T0_NS
from tests.scanned_room import ScannedWalk, standing, strolling, walk
from tests.unit.recording.ingested import frame_folder


def placed(made, pose):
    """The walk with every point where it is in the map."""
    for k, frame in enumerate(made.frames):
        T = pose((frame.t_ns - T0_NS) * 1e-9 + frame.dt_ns * 1e-9)
        xyz = np.empty_like(frame.xyz)
        for row, sensor in enumerate(made.rig.sensors):
            mine = frame.sensor == row
            p = sensor.T_body_sensor @ frame.xyz[mine].astype(np.float64)
            in_map = np.einsum("nij,nj->ni", T.R[mine], p) + T.t[mine]
            xyz[mine] = sensor.T_body_sensor.inverse() @ in_map
        made.frames[k] = replace(frame, xyz=xyz)
    return made


@pytest.fixture(scope="module", params=[strolling, standing])
def carried(request):
    return request.param, walk(request.param, 26, with_imu=False, columns=200)


def test_clouds_of_a_sensor_are_as_measured(carried):
    _, made = carried

    assert view_moves_on(made) == 0.0


def test_the_view_moves_on_in_clouds_that_were_placed():
    made = placed(walk(strolling, 120, with_imu=False, columns=100), strolling)

    assert view_moves_on(made) > 0.15


class Wavering(ScannedWalk):
    """A LiDAR that stands and sees another side of the room in each second, as a Livox may."""

    def __getitem__(self, k):
        frame = self.frames[k]
        left = frame.xyz[:, 1] > 0.0
        thin = np.arange(len(frame)) % 4 == 0
        return frame.take(np.flatnonzero(thin | (left == (k // 10 % 2 == 0))))


def test_a_lidar_that_stands_and_never_scans_twice_alike_is_no_placed_cloud(monkeypatch):
    made = walk(standing, 120, with_imu=False, columns=100)
    wavering = Wavering(made.frames, made.rig, made.truth, made.imu)

    assert view_moves_on(wavering) == 0.0

    monkeypatch.setattr(placed_clouds, "PLACED", structs.replace(PLACED, least_change=0.0))
    assert view_moves_on(wavering) > 0.15  # what the view alone would say


def test_a_short_walk_shows_nothing():
    assert view_moves_on(placed(walk(strolling, 8, with_imu=False, columns=60), strolling)) == 0.0


def test_who_knows_that_clouds_are_as_measured_says_so_in_a_setting(tmp_path, monkeypatch):
    monkeypatch.setattr(placed_clouds, "view_moves_on", lambda frames: 0.5)
    folder = frame_folder(tmp_path / "f", ["0.pcd", "1.pcd"])

    def read(name, **options):
        settings = ImportReads(ingest=IngestSettings(**options))
        (tmp_path / name).mkdir()
        context = StageContext(tmp_path / name, settings, Silent())
        return FRAMES.function(context, recordings=(folder,), rig=None, imu=None, gnss=None)

    with pytest.raises(UnknownFormat, match=r"--set ingest\.as_measured=true"):
        read("refused")
    assert read("read", as_measured=True).multiframes == 2
