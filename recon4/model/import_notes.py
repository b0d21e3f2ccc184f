"""What later stages read of the import report, ``report.json`` of the stage ``frames``."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from recon4.errors import StoreError

HEIGHTS_UNSTATED, HEIGHTS_ORTHOMETRIC = "gnss_heights_unstated", "gnss_heights_orthometric"
"""Counts of fixes whose height is taken as ellipsoidal because nothing says what it is above, and
of those above sea level without a geoid separation."""

CLOUDS_UNTIMED = "clouds_untimed"
"""Count of clouds whose points have no times: these follow from the stamp, which may be that of the
start, the middle or the end of a cloud, so nothing says how a clock lies to that of the points."""

GYRO_UNIT_ASSUMED = "imu_gyro_assumed"
"""Count of angular rates that are taken as rad/s although they are large, and the accelerations do
not say whether they are in deg/s."""


class ImportNotes(msgspec.Struct, frozen=True):
    """Outcome, warnings and counts of reading a recording."""

    outcome: str = "complete"
    """``complete``, ``lossy`` (salvaged) or ``nothing``."""
    warnings: tuple[str, ...] = ()
    counts: dict[str, int] = {}


def import_notes(report: Mapping[str, object]) -> ImportNotes:
    """Read a parsed import report; missing parts are as by default.

    Raises:
        StoreError: If a value has another type.
    """
    try:
        return msgspec.convert(report, ImportNotes)
    except msgspec.ValidationError as error:
        raise StoreError(f"report.json of the frames cannot be read: {error}") from error
