"""Leveling, and the place of the map on earth."""

from __future__ import annotations

from collections.abc import Iterator

from msgspec.structs import replace

from recon4.findings.placement import GnssFacts
from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import PLACING_WITNESS
from recon4.georeference.antenna_audit import antenna_doubts
from recon4.model.figures import AntennaFigures
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.gps_time import GPS_MINUS_UTC_S
from recon4.model.import_notes import HEIGHTS_ORTHOMETRIC, HEIGHTS_UNSTATED, import_notes


class Leveled(Witness):
    """Whether up is known."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """A map that is not leveled: what a missing IMU costs, or a fault if there is one."""
        if walk.placement.is_leveled:
            return
        missing = walk.frames is not None and not walk.frames.imu
        yield finding(FindingKind.NOT_LEVELED, Level.NOTE if missing else Level.CHECK)


class Gnss(Witness):
    """Fixes against the trajectory and the loop closures."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Fixes and loop closures that were rejected, or no place on earth at all."""
        gnss = walk.placement.gnss
        if gnss.edges_rejected:
            count = len(gnss.edges_rejected)
            yield finding(FindingKind.LOOPS_AGAINST_GNSS, Level.NOTE, {"count": count})
        for run in gnss.rejected_runs:
            yield finding(
                FindingKind.GNSS_REJECTED,
                Level.CHECK,
                {
                    "fixes": run.fixes,
                    "horizontal_m": run.horizontal_m,
                    "height_m": run.height_m,
                },
                span_s=(run.start_s, run.end_s),
            )
        has_gnss = walk.frames is not None and walk.frames.gnss
        if has_gnss and walk.level is not None and not walk.level.crs:
            yield finding(FindingKind.GNSS_NOT_USED, Level.CHECK, _why_not(gnss))


def _why_not(gnss: GnssFacts) -> dict[str, Value]:
    """Why fixes were not used, as far as it is known."""
    values: dict[str, Value] = {"reason": gnss.reason, "fixes": gnss.fixes}
    known = {
        "fixes_usable": gnss.fixes_usable,
        "fixes_agreeing": gnss.fixes_agreeing,
        "extent_m": gnss.extent_m,
        "beside_m": gnss.beside_m,
    }
    return values | {name: value for name, value in known.items() if value is not None}


class Heights(Witness):
    """Whether the heights of a georeferenced map are those above the ellipsoid."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Heights of another kind than the map states, or of a kind that nothing states."""
        if not walk.placement.gnss.georeferenced or walk.settings.gnss.heights != "as_recorded":
            return
        counts = import_notes(walk.imported).counts
        if above_sea := counts.get(HEIGHTS_ORTHOMETRIC, 0):
            yield finding(FindingKind.HEIGHTS_ORTHOMETRIC, Level.DO_NOT_USE, {"fixes": above_sea})
        if unstated := counts.get(HEIGHTS_UNSTATED, 0):
            yield finding(FindingKind.HEIGHTS_UNSTATED, Level.CHECK, {"fixes": unstated})


class Antenna(Witness):
    """Lever arm and clock of the GNSS receiver against the fixes."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """What the fixes contradict, or cannot check."""
        found = walk.level.antenna if walk.level is not None else None
        if found is None:
            return
        for doubt in antenna_doubts(found):
            if doubt == "offset":
                yield finding(FindingKind.ANTENNA_OFFSET, Level.CHECK, _offset(found))
            elif doubt == "unchecked":
                sd_cm = 100.0 * max(found.arm_sd_m[:2])
                yield finding(FindingKind.ANTENNA_UNCHECKED, Level.CHECK, {"sd_cm": sd_cm})
            else:
                yield _clock(found)


class Mirrors(Witness):
    """Walls that show the room before them."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Each mirror, with its place."""
        for mirror in walk.level.mirrors if walk.level is not None else ():
            x, y = mirror.middle_m
            found = finding(
                FindingKind.MIRROR,
                Level.NOTE,
                {"area_m2": mirror.area_m2, "x_m": x, "y_m": y, "behind": mirror.behind},
            )
            yield replace(found, place_m=((x, y, 0.0), (x, y, 0.0)))


def _offset(found: AntennaFigures) -> dict[str, Value]:
    values: dict[str, Value] = {}
    for axis, value, sd in zip("xyz", found.arm_m, found.arm_sd_m, strict=True):
        values |= {f"{axis}_cm": 100.0 * value, f"{axis}_sd_cm": 100.0 * sd}
    return values


def _clock(found: AntennaFigures) -> Finding:
    """An error of the clock in milliseconds, or in seconds with a usual cause."""
    large = abs(found.clock_s) >= PLACING_WITNESS.large_s
    leap = large and abs(abs(found.clock_s) - GPS_MINUS_UTC_S) < PLACING_WITNESS.same_s
    return finding(
        FindingKind.GNSS_CLOCK,
        Level.CHECK,
        {
            "clock_s": found.clock_s,
            "clock_sd_s": found.clock_sd_s,
            "clock_ms": 1e3 * found.clock_s,
            "clock_sd_ms": 1e3 * found.clock_sd_s,
            "large": large,
            "small": not large,
        }
        | ({"leap_s": GPS_MINUS_UTC_S} if leap else {}),
    )
