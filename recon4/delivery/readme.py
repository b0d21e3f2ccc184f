"""Lines of the README of a delivery that say what a file is, and how to read it."""

from __future__ import annotations

from collections.abc import Mapping

from pyproj import CRS
from pyproj.exceptions import CRSError

from recon4.delivery.kinds import KINDS
from recon4.model.classes import CLASSES
from recon4.model.site_control import SITE_GRID
from recon4.report.client_words import Words
from recon4.untrusted.names import visible


def crs_line(crs: str, texts: Words) -> str:
    """The coordinates of the map, with the name of their system."""
    if not crs:
        return texts("readme.crs", crs=texts("front.crs_local"))
    try:
        name = "" if crs == SITE_GRID else f" ({visible(CRS.from_user_input(crs).name)})"
    except CRSError:  # of another version of PROJ
        name = ""
    return texts("readme.crs", crs=f"{texts.term(visible(crs))}{name}")


def file_line(name: str, kind: str, *, points: int, texts: Words) -> str:
    """What a file is.

    Args:
        name: Of the file.
        kind: Of `KINDS`, or the name of another file.
        points: In it, if it is a point cloud.
        texts: Of the language of the README.
    """
    stem, _, ending = kind.partition(".")
    if kind in KINDS and KINDS[kind].point_bytes:
        form = texts(f"readme.form_{ending.replace('.', '_')}")
        what = texts("readme.cloud", points=spaced(points), form=form)
    else:
        what = texts(f"readme.{kind.lower().replace('.', '_') if kind not in KINDS else stem}")
    return f"  {name:<16} {what}"


def classes_line(counts: Mapping[int, int], texts: Words) -> str:
    """The codes of the classes that delivered points have; empty = they have none."""
    shown = [
        f"{int(code)} {texts.term(facts.title)}"
        for code, facts in CLASSES.items()
        if counts.get(code) and facts.delivered and code
    ]
    return texts("readme.classes", classes=", ".join(shown)) if shown else ""


def spaced(count: int) -> str:
    """A number with spaces between its thousands."""
    return f"{count:,}".replace(",", " ")
