"""Converts tables of cloud fields to shots: aliases of fields, units, missing fields.

What a cloud lacks is derived and reported: ring from elevation, time from azimuth.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, UnknownFormat
from recon4.geometry.distinct import distinct
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import CLOUDS_UNTIMED
from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.recording.assembly.shots import Shots
from recon4.recording.bags.tuning import CLOUDS
from recon4.recording.clocks.tuning import POINT_CLOCK
from recon4.recording.clouds.exact_times import ExactClock
from recon4.recording.clouds.point_fields import (
    EXACT_TIME,
    INTENSITY_FIELDS,
    RING_FIELDS,
    TIME_FIELDS,
    find_field,
)
from recon4.recording.clouds.point_times import PointClock
from recon4.recording.formats.cloud_files import Table
from recon4.recording.packets.livox.recognition import livox_of_points
from recon4.recording.packets.velodyne.models import MODELS
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings

_DEFAULTS = IngestSettings()


class CloudDecoder:
    """Converts the clouds of one sensor to shots; detected units apply to all clouds."""

    def __init__(
        self,
        sensor_row: int,
        sensor: Sensor,
        *,
        report: ImportReport,
        points_lead: bool = False,
        settings: IngestSettings = _DEFAULTS,
    ) -> None:
        """Prepare.

        Args:
            sensor_row: Row in ``Rig.sensors``.
            sensor: Its name in the report; its model, for rings that are not given.
            report: Receives what was detected.
            points_lead: Absolute times of points count, however far they are from the stamps
                (file names in local time); otherwise the stamps do (one clock for a whole bag).
            settings: Unit of the points, and whether the motion of the sensor is inside.

        Raises:
            ConfigError: If the unit is said twice.
        """
        fields = sensor.fields
        if fields is not None and fields.has_lengths and settings.points_unit_m != 1.0:
            raise ConfigError(
                CodedText(
                    "points-unit-known",
                    sensor=sensor.name,
                    fields=fields.text()[:200],
                    points_unit_m=settings.points_unit_m,
                )
            )
        self._row, self._report = sensor_row, report
        self._name, self._model = sensor.name, sensor.model
        self._clock = PointClock(sensor.name, report, points_lead=points_lead)
        self._exact = ExactClock(sensor.name, report)
        self._deskewed, self._unit_m = settings.deskewed, settings.points_unit_m
        self._ring_of: NDArray[np.uint8] | None = None
        self.absolute = False
        """Whether the points of the last cloud had absolute times."""

    @property
    def stamps_set_ns(self) -> int:
        """By how much the clock of the stamps was set that are given without it [ns]."""
        return self._exact.stamps_set_ns

    @stamps_set_ns.setter
    def stamps_set_ns(self, set_ns: int) -> None:
        for clock in (self._exact, self._clock.dates):
            clock.stamps_set_ns = set_ns

    def decode(self, table: Table, *, t_ns: int, period_ns: int) -> Shots:
        """Points of one cloud in order of time.

        Args:
            table: Its fields by lower-case name.
            t_ns: The cloud's stamp [ns]: the start, when the points only have azimuths.
            period_ns: Length of a revolution, used when times are worked out [ns].

        Raises:
            UnknownFormat: If there is no x, y or z.
            CorruptFile: If a field is not numeric.
        """
        xyz = _xyz(table, self._name) * np.float32(self._unit_m)
        valid = np.flatnonzero(np.all(np.isfinite(xyz), axis=1) & np.any(xyz != 0.0, axis=1))
        self._report.count("points_invalid", len(xyz) - len(valid))
        valid = self._without_noise(table, valid)
        table = {key: column[valid] for key, column in table.items()}
        xyz = xyz[valid]
        self._report.count("clouds")
        times, sound = self._times(table, xyz, t_ns, period_ns=period_ns)
        if not sound.all():
            table = {key: column[sound] for key, column in table.items()}
            xyz, times = xyz[sound], times[sound]
        order = np.argsort(times, kind="stable")
        self._report.count("points", len(xyz))
        return Shots(
            self._row,
            times[order],
            xyz[order],
            self._intensity(table, len(xyz))[order],
            self._rings(table, xyz)[order],
            table.get("echo", np.zeros(len(xyz), np.uint8))[order],
        )

    def _without_noise(self, table: Table, rows: NDArray[np.intp]) -> NDArray[np.intp]:
        """The rows of points that the sensor itself does not call noise."""
        if "noise" not in table:
            return rows
        kept = rows[~table["noise"][rows].astype(np.bool_)]
        self._report.count("points_noise", len(rows) - len(kept))
        return kept

    def nothing(self) -> Shots:
        """No shots of this sensor."""
        none = np.zeros(0, np.uint8)
        xyz = np.zeros((0, 3), np.float32)
        return Shots(self._row, none.astype(np.int64), xyz, none.astype(np.uint16), none, none)

    # -- intensity

    def _intensity(self, table: Table, count: int) -> NDArray[np.uint16]:
        key = find_field(table, INTENSITY_FIELDS)
        if not key:
            self._report.derive(DerivedKind.INTENSITY_MISSING, where=self._name)
            return np.zeros(count, np.uint16)
        values = table[key]
        if count >= POINT_CLOCK.many_points and _is_constant(values):
            self._say_constant(key, float(values[0]))
        elif values.dtype.kind == "f":
            self._report.count("intensity_wrong", int(np.count_nonzero(~np.isfinite(values))))
        if values.dtype.kind == "f":
            finite = np.nan_to_num(values, nan=0.0, posinf=0.0, neginf=0.0)
            # Not the largest: single damaged values do not change the scale of the others.
            if len(finite) and np.percentile(finite, 99) <= 1.0 and np.any(finite % 1.0):
                self._report.derive(DerivedKind.INTENSITY_SCALED, where=self._name)
                finite = finite * 255.0
            values = np.rint(finite)
        outside = int(np.count_nonzero((values < 0) | (values > 65535)))
        if outside:
            self._report.count("intensity_clipped", outside)
            self._report.warn(FindingKind.INTENSITY_CLIPPED, where=self._name)
        return np.clip(values, 0, 65535).astype(np.uint16)

    def _say_constant(self, key: str, value: float) -> None:
        known: dict[str, Value] = {"no_number": True} if np.isnan(value) else {"value": value}
        self._report.derive(DerivedKind.INTENSITY_CONSTANT, where=self._name, field=key, **known)

    # -- ring

    def _rings(self, table: Table, xyz: NDArray[np.float32]) -> NDArray[np.uint8]:
        key = find_field(table, RING_FIELDS)
        elevation = np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1]))
        if not key:
            return self._rings_from_elevation(elevation, fieldless=True)
        if _is_flat(table[key], elevation):
            value = float(table[key][0])
            why = {"outside": True} if np.isnan(value) else {"everywhere": value}
            return self._rings_from_elevation(elevation, field=key, **why)
        rings = self._sound_rings(table[key], elevation)
        if rings is None:
            return self._rings_from_elevation(elevation, field=key, outside=True)
        if self._ring_of is None and len(rings):
            self._ring_of = _upwards(rings, elevation)
            if np.any(self._ring_of[: int(rings.max()) + 1] != np.arange(int(rings.max()) + 1)):
                self._report.derive(DerivedKind.RINGS_RENUMBERED, where=self._name, field=key)
        return rings if self._ring_of is None else self._ring_of[rings]

    def _sound_rings(
        self, values: NDArray[Any], elevation: NDArray[np.floating]
    ) -> NDArray[np.uint8] | None:
        """Rings, single damaged ones from the elevation of the others; None if most are damaged."""
        with np.errstate(invalid="ignore"):
            sound = (values >= 0) & (values <= 255)
        damaged = len(values) - int(np.count_nonzero(sound))
        if damaged > len(values) // 2:
            return None
        self._report.count("rings_wrong", damaged)
        rings = np.where(sound, values, 0).astype(np.uint8)
        if damaged:
            order = np.flatnonzero(sound)[np.argsort(elevation[sound])]
            place = np.searchsorted(elevation[order], elevation[~sound])
            rings[~sound] = rings[order[np.minimum(place, len(order) - 1)]]
        return rings

    def _rings_from_elevation(
        self, elevation: NDArray[np.floating], **why: Value
    ) -> NDArray[np.uint8]:
        rings, bands = rings_by_elevation(self._model, elevation)
        say_rings(self._report, self._name, bands, **why)
        return rings

    # -- time

    def _times(
        self, table: Table, xyz: NDArray[np.float32], t_ns: int, *, period_ns: int
    ) -> tuple[Times, NDArray[np.bool_]]:
        """Times of the points [ns], and which of them are sound, (N,) each."""
        azimuth = np.arctan2(xyz[:, 1], xyz[:, 0])
        key, full_turn = find_field(table, TIME_FIELDS), _covers_turn(azimuth)
        self.absolute, everyone = False, np.ones(len(xyz), np.bool_)
        at_stamp = np.full(len(xyz), t_ns, np.int64), everyone
        if not len(xyz):
            return at_stamp
        if self._deskewed:
            self._report.count(CLOUDS_UNTIMED)
            return at_stamp
        if EXACT_TIME in table:
            self.absolute = True
            return self._exact.times(table[EXACT_TIME], t_ns=t_ns, period_ns=period_ns)
        if key:
            found = self._clock.times(
                key,
                table[key],
                t_ns=t_ns,
                period_ns=period_ns,
                full_turn=full_turn,
            )
            if found is not None:
                self.absolute = found.absolute
                return found.t_ns, found.kept
        self._report.count(CLOUDS_UNTIMED)
        if not key and not full_turn:
            self._report.warn(FindingKind.POINTS_UNTIMED, where=self._name)
        if not full_turn:
            return at_stamp
        turn, order = _turn_from_order(azimuth)
        if key:
            self._report.derive(DerivedKind.TIMES_BY_AZIMUTH, where=self._name, order=order)
        else:
            self._report.warn(FindingKind.POINTS_TIMED_BY_AZIMUTH, where=self._name, order=order)
        since_ns = np.rint(np.clip(turn, 0.0, 1.0) * (period_ns - 1)).astype(np.int64)
        return t_ns + since_ns, everyone


def rings_by_elevation(
    model: str, elevation: NDArray[np.floating]
) -> tuple[NDArray[np.uint8], int]:
    """Rings of points without, (N,), and the number of bands in place of beams, 0 = none.

    Args:
        model: Of the sensor; ``generic`` = the beams that the points fit, else bands.
        elevation: Of each point [rad], (N,).
    """
    beams, bands = _beams(model, elevation), 0
    if beams is None:
        bands = CLOUDS.bands
        beams = np.deg2rad(np.linspace(-25.0, 15.0, bands))
    middles = (beams[1:] + beams[:-1]) / 2.0
    return np.searchsorted(middles, elevation).astype(np.uint8), bands


def say_rings(report: ImportReport, where: str, bands: int, **why: Value) -> None:
    """State that rings are by elevation.

    Args:
        report: Receives it.
        where: Name of the sensor or topic.
        bands: Number of bands in place of beams; 0 = the beams are known.
        why: Values that say why, of `DerivedKind.RINGS_BY_ELEVATION`.
    """
    how: dict[str, Value] = {"bands": bands} if bands else {"beams": True}
    report.derive(DerivedKind.RINGS_BY_ELEVATION, where=where, **why, **how)


def model_of_points(table: Table) -> str:
    """Detect a Livox by its lines and view, a Velodyne by its elevations; else ``generic``."""
    xyz = _xyz(table, "cloud")
    valid = np.all(np.isfinite(xyz), axis=1) & np.any(xyz != 0.0, axis=1)
    if {"tag", "line"} <= set(table) and valid.any():
        return livox_of_points(xyz[valid], int(table["line"][valid].max()) + 1)
    x, y, z = xyz[valid].T
    return _fitting_model(np.arctan2(z, np.hypot(x, y))) or "generic"


def _xyz(table: Table, name: str) -> NDArray[np.float32]:
    missing = [key for key in ("x", "y", "z") if key not in table]
    if missing:
        raise UnknownFormat(CodedText("cloud-axes-missing", name=name, table=str(sorted(table))))
    with np.errstate(over="ignore", invalid="ignore"):
        return np.column_stack([table[k] for k in ("x", "y", "z")]).astype(np.float32)


def _is_constant(values: NDArray[Any]) -> bool:
    return bool(np.all((values == values[0]) | (values != values)))


def _is_flat(rings: NDArray[Any], elevation: NDArray[np.floating]) -> bool:
    """Whether all points have one ring, but not the elevation of one beam."""
    if len(rings) < POINT_CLOCK.many_points or not _is_constant(rings):
        return False
    return bool(np.ptp(np.percentile(elevation, [5, 95])) > CLOUDS.one_beam_rad)


def _upwards(rings: NDArray[np.uint8], elevation: NDArray[np.floating]) -> NDArray[np.uint8]:
    """Table from the given ring to the ring counted from the lowest elevation.

    Rings that are no cones (a cloud already turned into another frame) are left as they are.
    """
    same = np.arange(256, dtype=np.uint8)
    known = distinct(rings)
    parts = [elevation[rings == ring] for ring in known]
    middle = np.array([np.median(part) for part in parts])
    spread = np.array([np.median(np.abs(part - m)) for part, m in zip(parts, middle, strict=True)])
    if np.median(spread) > np.deg2rad(0.3):
        return same
    if np.all(np.diff(middle) > -np.deg2rad(0.1)):
        return same
    if np.all(np.diff(middle) < np.deg2rad(0.1)):
        highest = int(known.max())
        same[: highest + 1] = same[: highest + 1][::-1]
        return same
    same[known[np.argsort(middle, kind="stable")]] = np.arange(len(known), dtype=np.uint8)
    return same


def _beams(model: str, elevation: NDArray[np.floating]) -> NDArray[np.float64] | None:
    """Elevations of the beams [rad], ascending: the model's, or of one that the points fit."""
    name = model if model in MODELS else _fitting_model(elevation)
    return np.sort(MODELS[name].elevation_rad) if name else None


def _fitting_model(elevation: NDArray[np.floating]) -> str:
    if not len(elevation):
        return ""
    for name in ("VLP-16", "HDL-32E"):
        beams = np.sort(MODELS[name].elevation_rad)
        step = float(np.median(np.diff(beams)))
        off = np.abs(elevation[:, None] - beams[None, :]).min(axis=1)
        if np.percentile(off, 80) < 0.12 * step:
            return name
    return ""


def _covers_turn(azimuth: NDArray[np.floating]) -> bool:
    """Whether the points are spread over more than half of a revolution."""
    cells = distinct(((azimuth + np.pi) * (36 / (2 * np.pi))).astype(np.int64))
    return len(cells) > 18


def _turn_from_order(azimuth: NDArray[np.floating]) -> tuple[NDArray[np.float64], str]:
    """Part of the revolution at which each point was measured, 0..1, and how it was detected.

    In the order of firing the azimuth goes on all the time. The sector of the carrier may lack.
    """
    swept = np.unwrap(azimuth.astype(np.float64))
    total = float(swept[-1] - swept[0])
    steps = np.diff([part.mean() for part in np.array_split(swept, min(36, len(swept)))])
    if np.deg2rad(180.0) < abs(total) < np.deg2rad(450.0) and np.all(steps * total > 0.0):
        turn = (swept - swept[0]) * np.sign(total) / max(2.0 * np.pi, abs(total))
        return turn, "firing"
    return (np.pi - azimuth.astype(np.float64)) / (2.0 * np.pi), "from-rear"
