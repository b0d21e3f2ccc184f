"""Tuning of georeferencing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from msgspec import Struct

from recon4.settings import GnssSettings


@dataclass(frozen=True, slots=True, kw_only=True)
class GnssTuning(GnssSettings):
    """Georeferencing by GNSS/INS (docs/explanation/georeference.md; requirements A10)."""

    correlation_s: float = 5.0
    """Correlation time of the errors of fixes [s]: fixes within it count as one. A larger value
    gives SLAM more influence on the shape of the map."""
    min_sd_m: float = 0.01
    """Smallest standard deviation of a fix, whatever the receiver reports [m]."""
    gate_m: float = 1.0
    """A fix farther than this plus ``gate_relative`` from the rigidly aligned trajectory is an
    outlier [m]."""
    gate_relative: float = 0.02
    """Allowance for the drift of SLAM in that distance, per meter of path length."""
    tilt_sd_rad: float = 0.005
    """Standard deviation of the tilt of the leveled map [rad]."""
    min_extent_m: float = 3.0
    """Smallest extent of the fixes for which a heading is estimated [m]."""
    seed: int = 4
    """Seed of the random draws of the initial alignment."""


class AlignTuning(Struct, frozen=True, kw_only=True):
    """Initial alignment and outliers of fixes."""

    draws: int = 400
    """Number of random pairs of fixes that are tried."""
    min_priors: int = 5
    """With fewer consistent fixes a map stays local."""
    outlier_sd: float = 5.0
    """Residual from which on a fix is an outlier, in robust standard deviations."""


ALIGN = AlignTuning()


class JumpTuning(Struct, frozen=True, kw_only=True):
    """Fixes that jump."""

    around: int = 11
    """Number of fixes whose median shows that the one in their middle jumps."""
    jump_m: float = 0.2
    turn_s: float = 0.06
    """Distance of such a fix from the median [m], and what turns and starts add at a speed [s]."""


JUMPS = JumpTuning()


class FixTuning(Struct, frozen=True, kw_only=True):
    """Usable fixes."""

    default_sd_m: tuple[tuple[float, float, float], ...] = (
        (np.nan, np.nan, np.nan),
        (3.0, 3.0, 6.0),
        (1.0, 1.0, 2.0),
        (0.3, 0.3, 0.6),
        (0.02, 0.02, 0.03),
    )
    """Standard deviations by rank, if the receiver reports none [m]."""
    frozen_m: float = 0.5
    """A body that moves by more while the position stays has a receiver that is stuck [m]."""


FIXES = FixTuning()


class AttitudeTuning(Struct, frozen=True, kw_only=True):
    """Attitudes of a GNSS/INS."""

    min_samples: int = 50
    """Fewer attitudes are not compared."""
    turned_rad: float = float(np.deg2rad(10.0))
    """Bias and mount of an accelerometer may be wrong by some degrees."""


ATTITUDES = AttitudeTuning()


class LevelStageTuning(Struct, frozen=True, kw_only=True):
    """What the stage samples of a walk."""

    sample_frames: int = 200
    """Number of multiframes that are sampled to find floor and mirrors …"""
    sample_points: int = 2000
    """… and of points of each."""
    walk_m_s: float = 1.3
    """Speed by which an error of the receiver's clock becomes one of the position [m/s]."""


LEVEL_STAGE = LevelStageTuning()


class HoldTuning(Struct, frozen=True, kw_only=True):
    """Below which changes a decided map stays where the undecided one is."""

    moved_m: float = 0.004
    """Of a position [m]: the step at which the refinement stops …"""
    turned_rad: float = 4e-4
    """… and of a direction [rad]: as far at ten meters."""
    sd_ratio: float = 0.05
    """Of a standard deviation, relatively; measured ones differ more from the stated ones …"""
    least_sd_m: float = 1e-4
    """… or by a step of those of points [m] …"""
    least_sd_rad: float = 1e-5
    """… and as far at ten meters [rad]."""
    mirror_m: float = 0.5
    """Of the middle of a mirror, whose rim is found by cells [m]."""
    seen_m: float = 0.05
    """Of a position [m], if what the scans see is to stay: a third of what scans see through …"""
    seen_rad: float = 5e-3
    """… and of a direction [rad]: as far at ten meters."""


HOLD = HoldTuning()
