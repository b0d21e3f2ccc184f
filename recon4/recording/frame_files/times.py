"""Times of frame files: from their names, or from a text file beside them.

    times.txt         one time a line, in the order of the files, in seconds:
                          0.000000
                          0.103671
    timestamps.txt    the same; KITTI raw data has dates: 2011-09-26 13:02:25.951199337

Both may also have milliseconds, microseconds or nanoseconds since 1970: a number says by its size
which it is. A line that begins with ``#`` is a comment.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.errors import CorruptFile
from recon4.locales.coded import CodedText
from recon4.model.finding import Finding, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times
from recon4.recording.clocks.stamps import filled, strays
from recon4.recording.clocks.tuning import FRAME_TIMES
from recon4.recording.formats.cloud_files import CLOUD_SUFFIXES
from recon4.recording.formats.damaged_lines import MAX_RATIO, DamagedLines
from recon4.recording.frame_files.clock import FrameClock, clock_by_order, clock_by_time
from recon4.recording.frame_files.numbers import numbers_of, places_by_number
from recon4.recording.frame_files.order import moved_back, order_of_times, times_by_text
from recon4.recording.limits import LIMITS
from recon4.recording.report import ImportReport, warning
from recon4.units import SECOND_NS, SECOND_US
from recon4.untrusted.bounded import lines_limited

TIME_FILES = ("times.txt", "timestamps.txt")
_DATE = re.compile(
    r"(\d{4})-(\d\d)-(\d\d)[-_T ](\d\d)[-:](\d\d)[-:](\d\d)(?:[-.](\d{1,9}))?(?:Z|\+00:00)?$"
)
_NAME_NUMBER = re.compile(r"(?:^|.*[^\d.])(\d{19}|\d{16}|\d{13}|\d{9,10}[._]\d{1,9})$")
"""Whatever stands before the number must not end in a digit."""
_LARGEST_S = ((1e11, SECOND_NS), (1e14, SECOND_US), (1e17, 1000))
"""Numbers below the first are in units of the second [ns]; larger ones are nanoseconds."""


@dataclass(frozen=True, slots=True, eq=False)
class FrameTimes:
    """Times of the files of a folder."""

    t_ns: Times
    """Increasing [ns], (N,)."""
    source: str
    """Where they are from; empty = assumed."""
    findings: tuple[Finding, ...] = ()
    """Why times that are there could not be used, or which are damaged."""
    order: NDArray[np.intp] | None = None
    """Rows of the files in the order of these times, (N,); None = their own."""
    out_of_order: int = 0
    """How many files had an earlier time than one before them."""
    absent: int = 0
    """How many numbers of files are missing, where the times are those of the numbers."""
    clock: FrameClock | None = None
    """Where their clock was set back, and by how much the times are later for that."""


def frame_times(folder: Path, files: Sequence[Path]) -> FrameTimes:
    """Times of frame files; without any, 10 Hz from 0 by the numbers in their names.

    Args:
        folder: Where they lie; a text file with times lies in it or beside it.
        files: In the order of their numbers.
    """
    named = [name_time_ns(_stem(file)) for file in files]
    known = np.array([t for t in named if t is not None], np.int64)
    if len(known) == len(files) and (in_names := _in_any_order(known, "the file names", files)):
        return in_names if in_names.clock else _on_one_clock(in_names, files)
    found = list[Finding]()
    for beside in [place / name for place in (folder, folder.parent) for name in TIME_FILES]:
        if folder.is_dir() and beside.is_file():
            listed = _listed_times(beside, files, found)
            if listed is not None:
                return replace(listed, findings=tuple(found))
    places = places_by_number(files)
    places = np.arange(len(files), dtype=np.int64) if places is None else places
    absent = int(places[-1]) + 1 - len(files) if len(files) else 0
    return FrameTimes(places * FRAME_TIMES.assumed_ns, "", tuple(found), absent=absent)


def _listed_times(beside: Path, files: Sequence[Path], found: list[Finding]) -> FrameTimes | None:
    """The times of a text file; ``found`` receives why they are not used, or which are damaged."""
    try:
        times = read_times(beside)
    except CorruptFile as error:
        found.append(warning(FindingKind.TIMES_UNREADABLE, error=error))
        return None
    name = beside.name
    times = _of_numbers(times, files)
    count = len(times)
    if count != len(files):
        found.append(warning(FindingKind.TIMES_NUMBER, name=name, times=count, files=len(files)))
        return None
    clock = clock_by_order(times) if len(first_words(files)) == 1 else None
    if clock is None:
        return _repaired(times, files, name, found=found)
    gone_on = np.where(times < 0, times, times + clock.shift_ns)
    listed = _repaired(gone_on, files, name, found=found)
    return listed and _with_clock(listed, clock)


def _repaired(
    times: Times, files: Sequence[Path], name: str, *, found: list[Finding]
) -> FrameTimes | None:
    """Times of a text file in order, damaged ones from their neighbors; None = cannot be used."""
    count = len(times)
    sound = _in_order(times)
    damaged = np.flatnonzero(~sound)
    if not len(damaged):
        return FrameTimes(times, name)
    values: dict[str, Value] = {"name": name, "first": int(damaged[0]) + 1}
    values |= {"damaged": len(damaged), "times": count}
    if len(damaged) - np.count_nonzero(_repeated(times)) <= MAX_RATIO * count:
        found.append(warning(FindingKind.TIMES_DAMAGED, **values))
        return FrameTimes(filled(times, sound), name)
    by_text = times_by_text(times, files)
    if np.all(np.diff(by_text) > 0):
        return FrameTimes(by_text, name, out_of_order=moved_back(times))
    if (sorted_times := _sorted(times, name)) is None:
        found.append(warning(FindingKind.TIMES_UNSORTED, **values))
    return sorted_times


def _of_numbers(times: Times, files: Sequence[Path]) -> Times:
    """The times of the files that are there, if there are more times: that of number 7 is the
    eighth, or the seventh if as many times are there as the last number says.
    """
    many = len(times) > len(files) >= FRAME_TIMES.fewest_numbers
    numbers = numbers_of(files) if many else None
    if numbers is None or numbers.min() < 0 or numbers.max() > len(times):
        return times
    first = 1 if numbers.max() == len(times) else 0
    return times[numbers - first] if numbers.min() >= first else times


def _in_any_order(t_ns: Times, source: str, files: Sequence[Path]) -> FrameTimes | None:
    """The times in their order, and the files with them; None if they are no times of a walk."""
    clock = clock_by_order(t_ns) if len(first_words(files)) == 1 else None
    if clock is not None:
        listed = _sorted(t_ns + clock.shift_ns, source)
        return listed and _with_clock(listed, clock)
    return _sorted(t_ns, source)


def _sorted(t_ns: Times, source: str) -> FrameTimes | None:
    if np.all(np.diff(t_ns) > 0):
        return FrameTimes(t_ns, source)
    order = order_of_times(t_ns)
    if order is None:
        return None
    return FrameTimes(t_ns[order], source, order=order, out_of_order=moved_back(t_ns))


def _on_one_clock(times: FrameTimes, files: Sequence[Path]) -> FrameTimes:
    """Files that are only in order of the times in their names, whose clock may be set back."""
    if len(first_words(files)) > 1:
        return times
    order = np.arange(len(files)) if times.order is None else times.order
    clock = clock_by_time(times.t_ns, lambda: [files[row].stat().st_size for row in order.tolist()])
    if clock is None:
        return times
    there = replace(clock, order=order[clock.order])
    t_ns = np.empty_like(times.t_ns)
    t_ns[order] = times.t_ns
    return replace(_going_on(t_ns, times.source, there), out_of_order=times.out_of_order)


def _going_on(t_ns: Times, source: str, clock: FrameClock) -> FrameTimes:
    """The times where the clock was set back, in the order of recording."""
    return FrameTimes(t_ns[clock.order] + clock.shift_ns, source, order=clock.order, clock=clock)


def _with_clock(times: FrameTimes, clock: FrameClock) -> FrameTimes:
    """The times with the clock of their files, which may be in another order by now."""
    order = np.arange(len(times.t_ns)) if times.order is None else times.order
    return replace(times, clock=FrameClock(order, clock.shift_ns[order], clock.steps))


def _repeated(t_ns: Times) -> NDArray[np.bool_]:
    """Which times are written twice where the next one would be, (N,): its place is free."""
    again = np.zeros(len(t_ns), np.bool_)
    steps = np.diff(t_ns)
    if len(steps) < 2:
        return again
    usual = np.median(steps)
    free = np.abs(steps[1:] - 2.0 * usual) < FRAME_TIMES.pair_ratio * usual
    again[1:-1] = (steps[:-1] == 0) & free
    return again


def first_words(files: Sequence[Path]) -> list[str]:
    """What the names of files begin with, before any number: those of several sensors differ."""
    return sorted({re.split(r"\d", f.stem, maxsplit=1)[0].strip("-_. ").lower() for f in files})


def _stem(file: Path) -> str:
    """The name without its endings: nuScenes has ``.pcd.bin``."""
    inner = Path(file.stem)
    return inner.stem if inner.suffix.lower() in CLOUD_SUFFIXES else file.stem


def read_times(path: Path) -> Times:
    """Read a text file with one time a line [ns], (N,); -1 where the line is damaged.

    Raises:
        CorruptFile: If too many lines are neither a number nor a date, naming the first.
    """
    damage = DamagedLines(ImportReport(), "")
    found: list[int] = []
    unreadable = 0
    lines = lines_limited(path, max_bytes=LIMITS.time_file_bytes, on_damaged=damage.add)
    for number, line in enumerate(lines, 1):
        text = line.strip()
        if damage.number > unreadable:
            found.append(-1)
        elif text and not text.startswith("#"):
            t_ns = _time_ns(text)
            found.append(-1 if t_ns is None else t_ns)
            if t_ns is None:
                wrong = CodedText("time-line", name=path.name, line=number, text=text[:60])
                damage.add(CorruptFile(wrong))
        unreadable = damage.number
    damage.check(len(found) - damage.number)
    return np.array(found, np.int64)


def _time_ns(text: str) -> int | None:
    t_ns = _number_ns(text)
    return _date_ns(text) if t_ns is None else t_ns


def _in_order(t_ns: Times) -> NDArray[np.bool_]:
    """Which times are there and later than all sound ones before them."""
    there = t_ns >= 0
    there[there] = ~strays(t_ns[there])
    before = np.concatenate([[-1], np.maximum.accumulate(np.where(there, t_ns, -1))[:-1]])
    return np.asarray(there & (t_ns > before))


def name_time_ns(stem: str) -> int | None:
    """Time in a file name [ns]; None = there is none.

    A number of nanoseconds, microseconds or milliseconds, of seconds with a fraction, or a date;
    a prefix may stand before it.
    """
    if found := _NAME_NUMBER.fullmatch(stem):
        return _number_ns(found[1].replace("_", "."))
    date = _DATE.search(stem)
    return _date_ns(date[0]) if date and date[7] else None


def _number_ns(text: str) -> int | None:
    """A number of seconds, or of smaller units since 1970, exact to the nanosecond."""
    found = re.fullmatch(r"(\d{1,19})(?:\.(\d*))?(?:[eE]([+-]?\d{1,2}))?", text)
    if not found:
        return None
    if found[3]:  # as numpy.savetxt writes it
        return _checked(round(float(text) * SECOND_NS))
    whole, fraction = int(found[1]), found[2] or ""
    unit = next((ns for largest, ns in _LARGEST_S if whole < largest), 1)
    part = int(fraction[:18]) * unit // 10 ** min(len(fraction), 18) if fraction else 0
    return _checked(whole * unit + part)


def _checked(t_ns: int) -> int | None:
    return t_ns if 0 <= t_ns < 2**63 else None


def _date_ns(text: str) -> int | None:
    found = _DATE.fullmatch(text)
    if not found:
        return None
    try:
        year, month, day, hour, minute, second = (int(v) for v in found.groups()[:6])
        date = datetime(year, month, day, hour, minute, second, tzinfo=UTC)
    except ValueError:
        return None
    return int(date.timestamp()) * SECOND_NS + int((found[7] or "").ljust(9, "0"))
