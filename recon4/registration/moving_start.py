"""Velocity of a body that moves when the recording begins.

An IMU does not know it, and the first frame is undistorted with it: with a velocity of 0 in place
of a person's 1.2 m/s its points are smeared over 12 cm, and all others are registered to them.
Two scans in a row are smeared alike, so their relative pose is right before either is undistorted.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from recon4.geometry.se3 import Array
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.registration.motion import MotionState
from recon4.registration.scan_chain import ScanChain, body_points
from recon4.registration.state import STATE, VECTOR
from recon4.registration.tuning import SCANS, ScanTuning
from recon4.registration.tuning_motion import MOVING_START


def starting_velocity(
    first: Multiframe, second: Multiframe, *, rig: Rig, settings: ScanTuning = SCANS
) -> Array | None:
    """Velocity between two frames in axes of the body [m/s], (3,).

    None if the body stands, or if the scans do not surely fit each other.
    """
    span_ns = second.t_mid_ns - first.t_mid_ns
    if not 0 < span_ns <= MOVING_START.longest_ns:
        return None
    chain = ScanChain(settings)
    chain.locate(body_points(first, rig), first.t_mid_ns)
    chain.keep(chain.located, first.t_mid_ns)
    found = chain.locate(body_points(second, rig), second.t_mid_ns)
    if found is None or not chain.is_sure:
        return None
    velocity = found.t / (1e-9 * span_ns)
    return velocity if float(np.linalg.norm(velocity)) > MOVING_START.moving_m_s else None


def set_moving(state: MotionState, velocity_body: Array, *, duration_ns: int) -> MotionState:
    """A state at the start of a frame with a velocity; the middle of the frame stays at its pose.

    Args:
        state: At the start of the frame.
        velocity_body: In axes of the body [m/s], (3,).
        duration_ns: Of the frame.
    """
    velocity = state.R @ velocity_body
    vector, P = state.vector.copy(), state.P.copy()
    vector[VECTOR.position] -= 0.5e-9 * duration_ns * velocity
    vector[VECTOR.velocity] = velocity
    P[STATE.velocity, :] = P[:, STATE.velocity] = 0.0
    P[STATE.velocity, STATE.velocity] = MOVING_START.sd_m_s**2 * np.eye(3)
    return replace(state, vector=vector, P=P)
