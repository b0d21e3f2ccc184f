"""The CRS of a finished map, read from its files; imports little, for those who only read it."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from recon4.errors import GeoreferenceError, StoreError
from recon4.georeference.crs import CrsTransform, GeodeticOrigin, code_of
from recon4.georeference.site_grid import SiteGrid
from recon4.locales.coded import CodedText
from recon4.model.local_frame import LocalReason
from recon4.model.site_control import SITE_GRID
from recon4.store.json_files import read_object
from recon4.untrusted.limits import LIMITS

_WHY = {
    LocalReason.NO_GNSS: "no GNSS in the recording",
    LocalReason.SWITCHED_OFF: "GNSS is switched off (gnss.enabled)",
    LocalReason.FEW_FIXES: "too few GNSS fixes are usable",
    LocalReason.NO_AGREEMENT: "too few GNSS fixes agree with the trajectory",
}
"""An earlier version wrote sentences."""


def read_crs(artifact: Path, crs: str = "") -> CrsTransform | SiteGrid | None:
    """Read the CRS from the artifact of the stage ``level``; None if not georeferenced.

    Args:
        artifact: Folder of the stage.
        crs: Code of another CRS; empty = the one chosen by the settings or the control points.

    Raises:
        GeoreferenceError: If another CRS is requested and the map is not georeferenced, or in the
            grid of a site.
        StoreError: If ``georeference.json`` is missing or damaged.
    """
    path = artifact / "georeference.json"
    try:
        record = read_object(path, max_bytes=LIMITS.findings_bytes)
        if not record["crs"]:
            if crs:
                reason = record["georeference"]["reason"]
                raise GeoreferenceError(
                    CodedText("crs-map", crs=crs, why=str(_WHY.get(reason, reason)))
                )
            return None
        if record["crs"]["name"] == SITE_GRID:
            if crs:
                raise GeoreferenceError(CodedText("crs-site-grid", crs=crs))
            east, north, up = map(float, record["crs"]["origin_m"])
            return SiteGrid((east, north, up))
        origin = record["georeference"]["origin"]
        lat_rad, lon_rad = np.deg2rad([origin["lat_deg"], origin["lon_deg"]]).tolist()
        place = GeodeticOrigin(lat_rad, lon_rad, origin["height_m"])
        return _in_system(place, crs, own=record["crs"])
    except (ValueError, KeyError, TypeError, AttributeError, OverflowError) as error:
        raise StoreError(CodedText("crs-unreadable", file=str(path), why=repr(error))) from error


def _in_system(place: GeodeticOrigin, crs: str, *, own: Mapping[str, object]) -> CrsTransform:
    """The map in its own system as it was put there, or in another one.

    Raises:
        GeoreferenceError: If another one is requested, and control points put the map into its own
            without a grid: its place on earth is known to meters only.
    """
    name = str(own["name"])
    if code_of(crs) in ("", name):
        return CrsTransform(place, name, operation=str(own.get("operation", "")))
    try:
        as_put = CrsTransform(place, name, operation=str(own.get("operation", "")))
    except GeoreferenceError:
        return CrsTransform(place, crs)  # put there on a computer with the grid
    return CrsTransform(place, name if as_put.missing_grids else crs)  # says which grid is missing
