"""What the heights of a map are above: nothing may take ellipsoidal ones for those of a survey."""

from __future__ import annotations

from enum import StrEnum

from recon4.model.site_control import SITE_GRID


class HeightSystem(StrEnum):
    """What heights refer to."""

    LOCAL = "local"
    """The origin of the map."""
    SITE = "site"
    """The grid of a site: the heights of its control points."""
    SURVEY = "survey"
    """The heights of the control points; the CRS of the map is horizontal only and says nothing."""
    ELLIPSOID = "ellipsoid"
    """The ellipsoid: the CRS is horizontal only, and GNSS alone gave the height."""
    CRS = "crs"
    """What the vertical part of the CRS says."""


def height_system(crs: str, *, controlled: bool) -> HeightSystem:
    """What the heights of a map refer to.

    Args:
        crs: Its CRS: codes, `SITE_GRID`, or empty if it is local.
        controlled: Whether control points placed it.
    """
    if not crs:
        return HeightSystem.LOCAL
    if crs == SITE_GRID:
        return HeightSystem.SITE
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        has_heights = len(CRS.from_user_input(crs).axis_info) == 3
    except CRSError:  # of another version of PROJ: its codes say it
        has_heights = "+" in crs
    if has_heights:
        return HeightSystem.CRS
    return HeightSystem.SURVEY if controlled else HeightSystem.ELLIPSOID
