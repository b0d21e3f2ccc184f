"""Times of points from a field of a cloud: its unit, its clock, and single damaged values."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText, text_of
from recon4.model.derived_kinds import DerivedKind
from recon4.model.trajectory import Times
from recon4.recording.clocks.names import offset_values
from recon4.recording.clocks.tuning import POINT_TIMES
from recon4.recording.clouds.exact_times import ExactClock
from recon4.recording.clouds.point_fields import NS_TIME
from recon4.recording.report import ImportReport
from recon4.units import HOUR_NS

Values = NDArray[Any]


@dataclass(frozen=True, slots=True, eq=False)
class PointTimes:
    """Times of the points of one cloud."""

    t_ns: Times
    """Absolute [ns], (N,); of no meaning where not `kept`."""
    kept: NDArray[np.bool_]
    """Points with a sound time, (N,)."""
    absolute: bool
    """Whether they are times of a clock and not relative to the stamp."""


@dataclass(frozen=True, slots=True, eq=False)
class _Numbers:
    """Values of the field around the one in their middle."""

    middle: int | float
    around: NDArray[Any]
    """Values minus the middle one, int64 or float64, (N,)."""
    finite: NDArray[np.bool_]
    low: float
    """Least of the bulk of them."""
    span: float
    """Of the bulk of them."""
    is_fraction: bool
    wide: bool
    """Whether the type holds dates in any unit."""
    resolution: float
    """Step from one number to the next, in units of the field."""
    wraps: bool
    """Whether a counter or an hour begins again within the cloud."""
    cycle: int
    """Values of the type; 0 = as good as infinite."""


Cycles = tuple[int, ...]
"""Lengths of cycles [ns]; 0 = none."""


class _UnusableTimes(Exception):
    """The times of a cloud are unusable; the text says why."""


class PointClock:
    """Reads the time field of the clouds of one sensor."""

    def __init__(self, name: str, report: ImportReport, *, points_lead: bool) -> None:
        """Prepare.

        Args:
            name: Of the sensor.
            report: Receives the counts ``clouds_wrong_times``, ``points_wrong_time``.
            points_lead: Dates of points count, however far they are from the stamps.
        """
        self._name, self._report, self._points_lead = name, report, points_lead
        self._noted = False
        self.dates = ExactClock(name, report)
        """Of points with dates."""
        self._known_unit = 0.0
        """Of the clouds before, for those with few points [ns]; 0 = not known yet."""

    def times(
        self, key: str, values: Values, *, t_ns: int, period_ns: int, full_turn: bool
    ) -> PointTimes | None:
        """Times of the points of a cloud; None (counted, with the reason) if there are none.

        They are relative to the stamp, or in the stamp's own clock, or that within the hour, or in
        a clock of their own: then the first point is of the stamp.

        Args:
            key: Name of the field.
            values: Of all points, (N,), N > 0.
            t_ns: Stamp of the cloud [ns].
            period_ns: Time from cloud to cloud [ns].
            full_turn: Whether the points are spread over more than half of a revolution.

        Raises:
            CorruptFile: If the field is not numeric.
        """
        if values.dtype.kind not in "fiu":
            raise CorruptFile(
                CodedText("time-field-type", name=self._name, dtype=str(values.dtype))
            )
        try:
            numbers = _numbers(values)
            is_known = key == NS_TIME
            unit = self._unit(numbers, t_ns, period_ns, full_turn=full_turn, is_known=is_known)
            revolution_ns = _revolution_ns(numbers, unit, period_ns, full_turn=full_turn)
            return self._placed(numbers, unit, t_ns, revolution_ns=revolution_ns)
        except _UnusableTimes as reason:
            self._report.count("clouds_wrong_times")
            self._report.details.setdefault(
                "clouds_wrong_times",
                CodedText("detail-times", sensor=self._name, field=repr(key), why=text_of(reason)),
            )
            return None

    def _unit(
        self, numbers: _Numbers, t_ns: int, period_ns: int, *, full_turn: bool, is_known: bool
    ) -> float:
        """Nanoseconds of one unit.

        Raises:
            _UnusableTimes: If none is plausible.
        """
        if full_turn and numbers.span == 0.0:
            raise _UnusableTimes(CodedText("times-all-one", time=f"{numbers.middle:g}"))
        unit = 1.0
        if not is_known:
            unit = self._detected_unit(numbers, t_ns, period_ns, full_turn=full_turn)
        # No LiDAR turns in a few milliseconds: nearly equal times are those of deskewed clouds.
        if full_turn and numbers.span * unit < 1e9 * POINT_TIMES.turn_s[0]:
            raise _UnusableTimes(
                CodedText("times-within", span_ms=f"{numbers.span * unit * 1e-6:.3g}")
            )
        return unit

    def _detected_unit(
        self, numbers: _Numbers, t_ns: int, period_ns: int, *, full_turn: bool
    ) -> float:
        by_span = _unit_of_turn(numbers) if full_turn else _unit_of_part(numbers, period_ns)
        if _is_part_of_cloud(numbers, period_ns):
            self._report.derive(DerivedKind.TIMES_AS_PARTS, where=self._name)
            by_span = float(period_ns)
        unit = _unit_of_clock(numbers, t_ns, period_ns) or _unit_of_dates(numbers) or by_span
        self._known_unit = unit or self._known_unit
        if not unit and not full_turn:
            unit = self._known_unit or _unit_of_few(numbers)
        if not unit:
            raise _UnusableTimes(CodedText("times-no-unit", span=f"{numbers.span:g}"))
        return unit

    def _placed(
        self, numbers: _Numbers, unit: float, t_ns: int, *, revolution_ns: float
    ) -> PointTimes:
        near_ns = POINT_TIMES.revolutions * revolution_ns
        near = numbers.finite & (np.abs(numbers.around) * unit <= near_ns)
        damaged = len(near) - int(near.sum())
        if abs(numbers.middle) * unit > POINT_TIMES.largest_ns:
            raise _UnusableTimes(CodedText("times-none", time=f"{numbers.middle:g}"))
        if damaged > POINT_TIMES.most_damaged * len(near):
            raise _UnusableTimes(CodedText("times-far", damaged=damaged, total=len(near)))
        if numbers.resolution * unit > revolution_ns / POINT_TIMES.steps:
            raise _UnusableTimes(
                CodedText("times-coarse", step_ms=f"{numbers.resolution * unit * 1e-6:.3g}")
            )
        self._report.count("points_wrong_time", damaged)
        around_ns = _scaled(np.where(near, numbers.around, 0), unit)
        middle_ns = int(_scaled(np.array([numbers.middle]), unit)[0])
        at_ns = self._middle_ns(
            middle_ns,
            middle_ns + int(around_ns.min()),
            t_ns,
            cycles_ns=_cycles_ns(numbers, unit),
            revolution_ns=revolution_ns,
        )
        # Within one revolution of the stamp both readings are the same.
        absolute = abs(middle_ns) > revolution_ns and at_ns == middle_ns
        return PointTimes(at_ns + around_ns, near, absolute)

    def _middle_ns(
        self, middle_ns: int, first_ns: int, t_ns: int, *, cycles_ns: Cycles, revolution_ns: float
    ) -> int:
        """Absolute time of the value in the middle [ns].

        Args:
            middle_ns: The value.
            first_ns: That of the first point.
            t_ns: Stamp of the cloud.
            cycles_ns: After which the times may begin again; without any 0 they are never relative.
            revolution_ns: Largest offset of a relative time.
        """
        near_ns = POINT_TIMES.revolutions * revolution_ns
        if self._points_lead and _is_date(middle_ns):
            self._report.derive(DerivedKind.TIMES_OF_POINTS, where=self._name)
            return middle_ns
        if _is_date(middle_ns) and _is_date(t_ns) and not _is_hours(t_ns - first_ns, near_ns):
            # Drivers repeat stamps; two dates have one offset for the whole walk.
            return middle_ns + self.dates.offset_ns(first_ns, t_ns, same_ns=near_ns)
        if abs(middle_ns - t_ns) <= near_ns < t_ns:
            return middle_ns
        if abs(middle_ns) <= revolution_ns and 0 in cycles_ns:
            return t_ns + middle_ns
        for cycle_ns in filter(None, cycles_ns):
            at_ns = middle_ns + round((t_ns - middle_ns) / cycle_ns) * cycle_ns
            if abs(at_ns - t_ns) <= near_ns:
                self._report.derive(
                    DerivedKind.TIMES_CONTINUED, where=self._name, cycle_s=cycle_ns * 1e-9
                )
                return at_ns
        self._note_offset((first_ns - t_ns) * 1e-9)
        return t_ns + middle_ns - first_ns

    def _note_offset(self, ahead_s: float) -> None:
        if not self._noted:
            self._noted = True
            self._report.derive(
                DerivedKind.CLOCK_OF_POINTS, where=self._name, each=True, **offset_values(ahead_s)
            )


def _numbers(values: Values) -> _Numbers:
    """The values around their median.

    Raises:
        _UnusableTimes: If too few of them are numbers.
    """
    finite = np.isfinite(values)
    missing = len(values) - int(finite.sum())
    if missing > POINT_TIMES.most_damaged * len(values):
        raise _UnusableTimes(CodedText("times-missing", missing=missing, total=len(values)))
    rows = np.flatnonzero(finite)
    half = len(rows) // 2
    middle = values[rows[np.argpartition(values[rows], half)[half]]]
    around, wraps, is_fraction = *_around(values, middle, finite), values.dtype.kind == "f"
    size = np.abs(around[finite])
    bulk = around[finite][size <= POINT_TIMES.bulk * np.percentile(size, 60.0)]
    is_counter = values.dtype.kind == "u" and values.dtype.itemsize == 4
    middle = float(middle) if is_fraction else int(middle.astype(np.int64))
    counter = POINT_TIMES.counter
    wraps |= is_counter and not 0 <= middle + bulk.min() <= middle + bulk.max() < counter
    return _Numbers(
        middle=middle,
        around=around,
        finite=finite,
        low=middle + float(bulk.min()),
        span=float(np.ptp(bulk)),
        is_fraction=is_fraction,
        wide=values.dtype.itemsize >= 8,
        resolution=float(np.spacing(abs(values.dtype.type(middle)))) if is_fraction else 1.0,
        wraps=bool(wraps),
        cycle=counter if is_counter else 0,
    )


def _around(values: Values, middle: Any, finite: NDArray[np.bool_]) -> tuple[NDArray[Any], bool]:
    """Values minus the middle one, (N,), and whether an hour begins among them.

    Counters of 32 bits that wrap, and hours that begin, are continued.
    """
    if values.dtype.kind == "u" and values.dtype.itemsize == 4:
        return (values - middle).view(np.int32).astype(np.int64), False
    if values.dtype.kind in "iu":
        around: NDArray[Any] = values.astype(np.int64) - middle.astype(np.int64)
    else:
        around = np.where(finite, values, middle).astype(np.float64) - float(middle)
    largest, least = float(values[finite].max()), float(values[finite].min())
    for unit in POINT_TIMES.units_ns:
        hour = HOUR_NS / unit
        if 0.999 * hour < largest < hour and 0.0 <= least < 0.001 * hour:
            turns = np.sign(around) * (np.abs(around) > hour / 2)
            return np.asarray(around - (turns * hour).astype(around.dtype)), True
    return around, False


def _cycles_ns(numbers: _Numbers, unit: float) -> Cycles:
    """After which the times may begin again; 0 = they may be relative to the stamp."""
    counter_ns = int(numbers.cycle * unit)
    # A cycle of a few seconds would fit any stamp.
    longer = (counter_ns,) if counter_ns > POINT_TIMES.shortest_cycle_ns else ()
    return (*(() if numbers.wraps else (0,)), *longer, HOUR_NS)


def _unit_of_clock(numbers: _Numbers, t_ns: int, period_ns: int) -> float:
    """The unit in which the values are times of the stamp's own clock; 0 = none."""
    near_ns = POINT_TIMES.revolutions * max(period_ns, POINT_TIMES.part_ns)
    for unit in POINT_TIMES.units_ns:
        fits = abs(numbers.middle * unit - t_ns) <= near_ns < t_ns
        if fits and numbers.span * unit <= near_ns:
            return unit
    return 0.0


def _unit_of_dates(numbers: _Numbers) -> float:
    unit = next((unit for least, unit in POINT_TIMES.dates if numbers.middle >= least), 0.0)
    return unit if numbers.wide or unit == 1.0 else 0.0


def _unit_of_turn(numbers: _Numbers) -> float:
    """The unit in which the times of a whole revolution take as long as one; 0 = none."""
    if numbers.is_fraction:
        return _unit_of_few(numbers)
    seconds = ((unit, numbers.span * unit * 1e-9) for unit in POINT_TIMES.units_ns[:3])
    shortest_s, longest_s = POINT_TIMES.turn_s
    return next((unit for unit, s in seconds if shortest_s <= s <= longest_s), 0.0)


def _unit_of_part(numbers: _Numbers, period_ns: int) -> float:
    """The unit in which the times fit the time from cloud to cloud; 0 = none, as of few points.

    They may be relative to the stamp or to the start of the revolution.
    """
    least_ns = POINT_TIMES.part_ratio[0] * period_ns
    most_ns = POINT_TIMES.part_ratio[1] * max(period_ns, POINT_TIMES.part_ns)
    units = POINT_TIMES.units_ns if numbers.is_fraction else POINT_TIMES.units_ns[:3]
    for extent in (abs(numbers.middle) + numbers.span / 2.0, numbers.span):
        for unit in units:
            if least_ns <= extent * unit <= most_ns:
                return unit
    return 0.0


def _is_part_of_cloud(numbers: _Numbers, period_ns: int) -> bool:
    """Whether the times of each cloud go from 0 to 1, whatever time it takes.

    Seconds would have clouds far longer than the time from one to the next. A cloud without the
    sector of the carrier has half of them and more.
    """
    least, most = numbers.low, numbers.low + numbers.span
    within = -POINT_TIMES.part_ends <= least and most <= 1.0 and numbers.span >= POINT_TIMES.part
    longest_ns = POINT_TIMES.part_ratio[1] * max(period_ns, POINT_TIMES.part_ns)
    return numbers.is_fraction and within and longest_ns < 1e9 * numbers.span


def _unit_of_few(numbers: _Numbers) -> float:
    """The usual unit of times of which nothing else is known; 0 = none."""
    if not numbers.is_fraction:
        return 1.0
    return next((unit for most, unit in POINT_TIMES.float_units if numbers.span <= most), 0.0)


def _revolution_ns(numbers: _Numbers, unit: float, period_ns: int, *, full_turn: bool) -> float:
    least_ns = 0.0 if full_turn else POINT_TIMES.part_ns
    return max(float(period_ns), numbers.span * unit, least_ns)


def _is_date(t_ns: int) -> bool:
    return t_ns >= POINT_TIMES.dates[0][0]


def _is_hours(ahead_ns: int, near_ns: float) -> bool:
    """Whether an offset is whole hours, as between time zones; none is not."""
    hours = round(ahead_ns / HOUR_NS)
    return hours != 0 and abs(ahead_ns - hours * HOUR_NS) <= near_ns


def _scaled(numbers: NDArray[Any], unit: float) -> Times:
    """Numbers in nanoseconds; integers exactly."""
    if numbers.dtype.kind in "iu":
        return numbers.astype(np.int64) * int(unit)
    whole = np.floor(numbers)
    part: Array = np.rint((numbers - whole) * unit)
    return whole.astype(np.int64) * int(unit) + part.astype(np.int64)
