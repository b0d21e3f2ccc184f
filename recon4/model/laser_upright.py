"""2-D lasers that hang upside down, as lasers whose z axis points up."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import Sensor


def is_upside_down(T_body_laser: SE3) -> bool:
    """Whether the angles of its beams grow clockwise, seen from above."""
    return bool(T_body_laser.R[2, 2] < 0.0)


def turned_round(scans: LaserScans) -> LaserScans:
    """The scans with the angles of their beams in the other direction."""
    return replace(scans, angle_min_rad=-scans.angle_min_rad, angle_step_rad=-scans.angle_step_rad)


def seen_from_above(laser: Sensor) -> Sensor:
    """The laser as the scans of one that is upside down are turned round: its z axis points up."""
    if not is_upside_down(laser.T_body_sensor):
        return laser
    turn = SE3.from_rpy(np.pi, 0.0, 0.0, t=np.zeros(3))
    return replace(laser, T_body_sensor=laser.T_body_sensor @ turn)
