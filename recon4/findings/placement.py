"""What the report reads of ``georeference.json``; its table prints the rest as it is."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec
import numpy as np

from recon4.errors import StoreError
from recon4.locales.coded import CodedText
from recon4.model.rejected_fixes import RejectedRun, rejected_runs
from recon4.untrusted.typed import as_type


class LevelFacts(msgspec.Struct, frozen=True):
    """How the map was leveled."""

    source: str = ""
    """``imu``, ``ins``, ``floor`` or ``none``; empty = not known."""


class GnssFacts(msgspec.Struct, frozen=True):
    """How the map was georeferenced."""

    georeferenced: bool = False
    reason: str = ""
    """`LocalReason` why not, or a sentence of an earlier version; empty = georeferenced."""
    fixes: int = 0
    fixes_usable: int | None = None
    fixes_agreeing: int | None = None
    extent_m: float | None = None
    beside_m: float | None = None
    edges_rejected: tuple[int, ...] = ()
    """Loop closures that contradict the GNSS priors."""
    t_ns: tuple[int, ...] = ()
    """Times of the usable fixes [ns], (M,)."""
    residual_enu_m: tuple[tuple[float, float, float], ...] = ()
    """Measured minus solved position, east, north, up [m], (M, 3)."""
    used: tuple[bool, ...] = ()
    """Whether a fix is a GNSS prior, (M,)."""

    @property
    def rejected_runs(self) -> list[RejectedRun]:
        """Fixes that were rejected although they agree with each other."""
        residual_m = np.asarray(self.residual_enu_m, np.float64).reshape(-1, 3)
        return rejected_runs(
            np.asarray(self.t_ns, np.int64), np.asarray(self.used, bool), residual_m
        )


class Placement(msgspec.Struct, frozen=True):
    """How the map was leveled and georeferenced."""

    leveling: LevelFacts = msgspec.field(name="levelling", default=LevelFacts())
    gnss: GnssFacts = msgspec.field(name="georeference", default=GnssFacts())

    @property
    def is_leveled(self) -> bool:
        """Whether the z axis is vertical."""
        return self.leveling.source != "none"


def placement_in(record: Mapping[str, object]) -> Placement:
    """Read a parsed ``georeference.json``; missing parts are as by default.

    Raises:
        StoreError: If a value has another type.
    """
    try:
        return as_type(record, Placement)
    except msgspec.ValidationError as error:
        raise StoreError(CodedText("georeference-unreadable", why=str(error))) from error
