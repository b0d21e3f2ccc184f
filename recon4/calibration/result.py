"""What the stage ``calibration`` found, and its files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from recon4.calibration.held_out import Agreement
from recon4.calibration.slices import LidarSlices
from recon4.calibration.tuning_methods import SLICES
from recon4.model.calibration_figures import CalibrationFigures
from recon4.model.plain import to_plain
from recon4.model.rig import Rig, format_rig
from recon4.store.atomic import write_json
from recon4.store.frames import CALIBRATED_RIG, CALIBRATION_SLICES


@dataclass(frozen=True, slots=True, eq=False, kw_only=True)
class CalibrationResult:
    """What the stage found."""

    figures: CalibrationFigures
    rig: Rig | None = None
    """The calibrated rig, if it is used."""
    begin: Rig | None = None
    """Where a calibration begins."""
    before: Agreement | None = None
    after: Agreement | None = None
    slices: tuple[LidarSlices, ...] = ()
    """What each LiDAR sees with the rig file and with the calibrated rig."""

    def save(self, out: Path) -> CalibrationFigures:
        """Write ``calibration.json`` and, if the calibrated rig is used, ``rig.toml`` and
        ``slices.json``.
        """
        record = {"figures": self.figures, "before": self.before, "after": self.after}
        write_json(out / "calibration.json", to_plain(record))
        if self.rig is not None:
            (out / CALIBRATED_RIG).write_text(format_rig(self.rig), "utf-8")
            write_json(
                out / CALIBRATION_SLICES,
                {"thickness_m": SLICES.thickness_m, "lidars": to_plain(self.slices)},
            )
        return self.figures
