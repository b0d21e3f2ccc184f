"""Clouds in the frame of a map differ from those of a sensor, also of one that stands."""

from dataclasses import replace

import numpy as np
import pytest

from recon4.registration.placed_clouds import view_moves_on
from tests.room_walks import T0_NS
from tests.scanned_room import standing, strolling, walk


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
    made = placed(walk(strolling, 26, with_imu=False, columns=200), strolling)

    assert view_moves_on(made) > 0.15


def test_a_short_walk_shows_nothing():
    assert view_moves_on(placed(walk(strolling, 8, with_imu=False, columns=60), strolling)) == 0.0
