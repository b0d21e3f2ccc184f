"""Where the rig file has the IMU, against its forces."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from msgspec.structs import replace

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.registration.imu_lever_arm import wrong_lever_arm


class LeverArm(Witness):
    """The lever arm of the IMU over the walk."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """A note: what a wrong one costs, the findings of the forces that it spoils say."""
        figures = walk.odometry_figures
        if figures is None or figures.lines is not None or figures.lost:
            return
        if walk.imu is None or walk.rig is None or walk.odometry is None or not walk.steps:
            return
        off = wrong_lever_arm(walk.steps["t_mid_ns"], walk.odometry, walk.imu, rig=walk.rig)
        if off is None:
            return
        main = int(np.argmax(np.abs(off.p_body)))
        axis = f"{'−' if off.p_body[main] < 0.0 else '+'}{'xyz'[main]}"
        choice = figures.imu_choice.outcome if figures.imu_choice else "as recorded"
        values: dict[str, Value] = {"length_m": off.length_m, "sd_m": off.sd_m, "axis": axis}
        # A trajectory that follows these forces shows a part of their error only.
        values |= {"least": choice != "accelerometer not used"}
        found = finding(FindingKind.IMU_LEVER_ARM, Level.NOTE, values)
        yield replace(found, direction=axis, sensor="IMU")
