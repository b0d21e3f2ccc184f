"""Whether the heights of a georeferenced map are those above the ellipsoid."""

from __future__ import annotations

from collections.abc import Mapping

from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC, HEIGHTS_UNSTATED, import_notes
from recon4.settings import GnssSettings

_REMEDY = "by the setting gnss.heights, or in the recording by the names of the columns"


def wrong_heights(imported: Mapping[str, object], settings: GnssSettings) -> str:
    """Why all heights of a georeferenced map are off by the geoid separation; empty = they are not.

    Args:
        imported: ``report.json`` of the frames.
        settings: What the user says of the heights.

    Raises:
        StoreError: If the report is not as written.
    """
    fixes = import_notes(imported).counts.get(HEIGHTS_ORTHOMETRIC, 0)
    if not fixes or settings.heights != "as_recorded":
        return ""
    return (
        f"The heights of {fixes} fixes are above sea level (orthometric), and nothing says how "
        "high the geoid is there: heights of the map are wrong by that, tens of meters. Give it "
        "by the settings gnss.heights and gnss.geoid_separation_m, or record it."
    )


def unstated_heights(imported: Mapping[str, object], settings: GnssSettings) -> str:
    """What is assumed of the heights of a georeferenced map; empty = nothing.

    Args:
        imported: ``report.json`` of the frames.
        settings: What the user says of the heights.

    Raises:
        StoreError: If the report is not as written.
    """
    fixes = import_notes(imported).counts.get(HEIGHTS_UNSTATED, 0)
    if not fixes or settings.heights != "as_recorded":
        return ""
    return (
        f"Nothing says whether the heights of {fixes} fixes are above the ellipsoid or above sea "
        "level (orthometric): they are taken as ellipsoidal. If they are above sea level, all "
        f"heights of the map are wrong by the geoid separation, tens of meters. Say it {_REMEDY}."
    )
