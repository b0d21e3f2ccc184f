"""Small worlds and motions whose answers are known on paper."""

from dataclasses import replace

import numpy as np

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.raycast import Scene
from recon4.model.rig import load_rig
from recon4.simulation.families.families import pattern_of
from recon4.simulation.lidar import Lidar, LidarModel, Surroundings
from recon4.simulation.walk import Walk

SENSOR = load_rig("single-vlp16").sensors[0]


def still(seconds=2.0, height_m=1.5):
    """A body that does not move at (0, 0, height)."""
    samples = np.zeros((round(seconds / Walk.KNOT_S) + 1, 6))
    samples[:, 2] = height_m
    return Walk.through(samples)


def straight(speed_m_s, seconds=2.0):
    """A body that moves along x at constant speed."""
    t_s = np.arange(round(seconds / Walk.KNOT_S) + 1) * Walk.KNOT_S
    samples = np.zeros((len(t_s), 6))
    samples[:, 0] = speed_m_s * t_s
    return Walk.through(samples)


def walls(*distances_m, reflectivity=0.5, half_width_m=50.0):
    """Walls across x at these distances, facing the origin."""
    builder = MeshBuilder()
    for x in distances_m:
        w = half_width_m
        builder.quad([x, -w, -w], [0, 2 * w, 0], [0, 0, 2 * w], reflectivity=reflectivity)
    return around(builder)


def around(builder):
    mesh = builder.mesh()
    return Surroundings(mesh, Scene(mesh))


def sensor_at_rest(model, sensor=SENSOR, azimuth_rad=0.0):
    """A sensor that turns exactly ten times a second from the first moment on."""
    drawn = Lidar.drawn(sensor, pattern_of(sensor.model), model=model, rng=np.random.default_rng(3))
    return replace(drawn, first_packet_ns=0, azimuth_rad=azimuth_rad, turn_rate_hz=10.0)


def fire(model, surroundings, walk, packets=76, azimuth_rad=0.0, sensor=SENSOR):
    lidar = sensor_at_rest(model, sensor, azimuth_rad)
    return lidar.fire(range(packets), walk, surroundings, rng=np.random.default_rng(7))


PERFECT = LidarModel.perfect()
