"""Whether the heights of a georeferenced map are those above the ellipsoid."""

from __future__ import annotations

from collections.abc import Mapping

from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC, HEIGHTS_UNSTATED, import_notes
from recon4.settings import GnssSettings


def height_remarks(imported: Mapping[str, object], settings: GnssSettings) -> tuple[str, str]:
    """What is wrong with the heights of the fixes, and what is assumed of them; empty = nothing.

    Args:
        imported: ``report.json`` of the frames.
        settings: What the user says of the heights.

    Raises:
        StoreError: If the report is not as written.
    """
    if settings.heights != "as_recorded":
        return "", ""
    counts = import_notes(imported).counts
    above_sea, unstated = counts.get(HEIGHTS_ORTHOMETRIC, 0), counts.get(HEIGHTS_UNSTATED, 0)
    wrong = (
        f"The heights of {above_sea} fixes are above sea level (orthometric), and nothing says how "
        "high the geoid is there: heights of the map are wrong by that, tens of meters. Give it "
        "by the settings gnss.heights and gnss.geoid_separation_m, or record it."
    )
    assumed = (
        f"Nothing says whether the heights of {unstated} fixes are above the ellipsoid or above "
        "sea level (orthometric): they are taken as ellipsoidal. If they are above sea level, all "
        "heights of the map are wrong by the geoid separation, tens of meters. Say it by the "
        "setting gnss.heights, or in the recording by the names of the columns."
    )
    return wrong if above_sea else "", assumed if unstated else ""
