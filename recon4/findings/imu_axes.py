"""Axes of an IMU that are not those of its rig, as findings of a map or of a walk that goes on."""

from __future__ import annotations

from collections.abc import Iterator

from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.odometry_figures import ImuAxes, ImuTurn


def axes_findings(turn: ImuTurn | None, axes: ImuAxes | None) -> Iterator[Finding]:
    """What is wrong with the axes of an IMU whose samples are repaired.

    Args:
        turn: Its mount; None = as in the rig.
        axes: What its driver exchanges; None = nothing.
    """
    if turn is not None:
        values: dict[str, Value] = {
            "angle_rad": turn.angle_rad,
            "explained": max(turn.explained, 0.0),
            "explained_turned": turn.explained_turned,
            "rpy_deg": ", ".join(f"{angle:g}" for angle in turn.rpy_deg),
        }
        yield _of_imu(FindingKind.IMU_TURNED, values)
    if axes is not None:
        yield _of_imu(FindingKind.IMU_AXES, {"gyro": axes.gyro, "accel": axes.accel})


def _of_imu(kind: FindingKind, values: dict[str, Value]) -> Finding:
    return Finding(kind=kind, level=Level.CHECK, sensor="IMU", values=values)
