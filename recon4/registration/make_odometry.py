"""Create the odometry that the settings select."""

from __future__ import annotations

from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.registration.aiding import GnssAiding
from recon4.registration.line_odometry import LineOdometry
from recon4.registration.odometry import Odometry
from recon4.settings.reads import OdometryReads


def make_odometry(
    rig: Rig, settings: OdometryReads, imu: ImuSamples | None, *, aiding: GnssAiding | None = None
) -> Odometry | LineOdometry:
    """Odometry by planes (this project's method) or by lines (the documents' method)."""
    if settings.registration.solver == "planes":
        return Odometry(rig, settings, imu, aiding=aiding)
    return LineOdometry(rig, settings, imu)
