"""Store of multiframes: compressed one by one, streamed out, read on demand.

    points.zst          the points of one multiframe after the other (`recon4.store.packed_points`)
    index.npy           one row per multiframe
    imu.npz gnss.npz    if there are any
    rig.toml report.json

The points of frame ``k`` are the bytes from ``index["end"][k - 1]`` to ``index["end"][k]``.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from types import TracebackType
from typing import Any, BinaryIO, Self

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, NoSpace, StoreError
from recon4.locales.coded import CodedText, unreadable
from recon4.model.beams import beam_change
from recon4.model.hidden_points import MOVING_POINTS, HiddenPoints
from recon4.model.imu_repair import ImuRepair
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, format_rig, load_rig
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.store.arrays import load_array, load_record, save_record
from recon4.store.earlier_frames import EARLIER_INDEX, earlier_columns, is_earlier
from recon4.store.imu_repair import read_imu_repair
from recon4.store.json_files import read_object

INDEX = np.dtype(
    [
        ("frame_id", "<i8"),
        ("t_ns", "<i8"),
        ("duration_ns", "<i8"),
        ("start", "<i8"),
        ("stop", "<i8"),
        ("end", "<i8"),
        ("step", "<i8"),
    ]
)
"""One row of ``index.npy``: ``start`` and ``stop`` count points of all multiframes, ``end`` bytes
of ``points.zst``; ``step`` is the power of two of the step of the coordinates [m]."""
POINTS = "points.zst"

CALIBRATED_RIG = "rig.toml"
"""In the folder of the stage ``calibration``: the calibrated rig, if it is used."""
CALIBRATION_SLICES = "slices.json"
"""There, too: what the LiDARs see with the rig file and with the calibrated rig."""
_NO_SPACE = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)


class FrameWriter:
    """Appends multiframes to a folder, with one multiframe in memory.

    After an error the folder has no ``index.npy`` and `FrameStore` rejects it.
    """

    def __init__(self, folder: Path, rig: Rig) -> None:
        """Create the folder's files.

        Raises:
            StoreError: If the folder cannot be written.
        """
        self._folder = folder
        self._points = 0
        self._bytes = 0
        self._rows: list[tuple[int, int, int, int, int, int, int]] = []
        with storing(folder):
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "rig.toml").write_text(format_rig(rig), "utf-8")
            self._file: BinaryIO = (folder / POINTS).open("wb")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        try:
            if kind is None:
                self._finish()
        finally:
            _close_quietly(self._file)

    def __len__(self) -> int:
        return len(self._rows)

    @property
    def points(self) -> int:
        """Points written so far."""
        return self._points

    def append(self, frame: Multiframe) -> None:
        """Write the next multiframe.

        Raises:
            StoreError: If it cannot be written (`NoSpace` when the disk is full).
        """
        from recon4.store.packed_points import pack

        assert frame.frame_id == len(self._rows), "frame ids count from 0 without holes"
        data, step = pack(frame)
        with storing(self._folder):
            self._file.write(data)
        start, self._points = self._points, self._points + len(frame)
        self._bytes += len(data)
        times = frame.frame_id, frame.t_ns, frame.duration_ns
        self._rows.append((*times, start, self._points, self._bytes, step))

    def add(
        self,
        *,
        imu: ImuSamples | None = None,
        gnss: GnssSamples | None = None,
        report: dict[str, object] | None = None,
    ) -> None:
        """Write IMU samples, GNSS samples and the report of the recording."""
        with storing(self._folder):
            if imu is not None:
                save_record(self._folder / "imu.npz", imu)
            if gnss is not None:
                save_record(self._folder / "gnss.npz", gnss)
            if report is not None:
                text = json.dumps(report, indent=2, ensure_ascii=False)
                (self._folder / "report.json").write_text(text + "\n", "utf-8")

    def _finish(self) -> None:
        with storing(self._folder):
            self._file.flush()
            os.fsync(self._file.fileno())
            with (self._folder / "index.npy").open("wb") as file:
                np.save(file, np.array(self._rows, dtype=INDEX))
                file.flush()
                os.fsync(file.fileno())


@dataclass(frozen=True, slots=True, eq=False)
class FrameStore:
    """The multiframes of a recording, read on demand.

    ``store[k]`` reads frame ``k`` only: memory depends on the frames in use, not on the walk. The
    arrays belong to the frame; the files never change.
    """

    folder: Path
    index: NDArray[np.void]
    """`INDEX` records, (N,); of an earlier version without ``end`` and ``step``."""
    rig: Rig
    """Of the recording, or calibrated."""
    imu: ImuSamples | None
    gnss: GnssSamples | None
    report: dict[str, object]
    recorded: Rig
    """The rig whose clock offsets are in the files."""
    hidden: HiddenPoints | None = None
    """Points that are left out; None = all are there."""
    imu_repair: ImuRepair | None = None
    """What is wrong with the samples in the files: ``imu`` has the right ones."""

    @staticmethod
    def open(
        folder: Path,
        rig: Rig | None = None,
        hidden: HiddenPoints | None = None,
        *,
        imu_repair: ImuRepair | None = None,
    ) -> FrameStore:
        """Open what a `FrameWriter` left.

        Args:
            folder: Where it is.
            rig: The same sensors with calibrated mounts and clocks; None = the rig of the
                recording. All times are given by its clocks.
            hidden: Points that are left out.
            imu_repair: Of the samples of the IMU.

        Raises:
            StoreError: If something is missing or the files do not fit each other.
        """
        earlier = is_earlier(folder)
        try:
            index = load_array(folder / "index.npy", EARLIER_INDEX if earlier else INDEX)
            recorded = load_rig(folder / "rig.toml")
        except (StoreError, ConfigError) as error:
            raise StoreError(f"{folder.name} is not a finished frame store: {error}") from error
        _check_order(folder, index)
        if not earlier:
            _check_points(folder, index)
        rig = rig or recorded
        if [sensor.name for sensor in rig.sensors] != [s.name for s in recorded.sensors]:
            raise StoreError(f"{folder.name}: the calibrated rig has other sensors")
        if [s.clock_rate_ppm for s in rig.sensors] != [s.clock_rate_ppm for s in recorded.sensors]:
            raise StoreError(f"{folder.name}: the rates of clocks are applied when it is read")
        imu, gnss = folder / "imu.npz", folder / "gnss.npz"
        samples = _imu(imu, rig.imu_clock_offset_s - recorded.imu_clock_offset_s)
        return FrameStore(
            folder,
            index,
            rig,
            imu_repair.of(samples) if imu_repair is not None and samples is not None else samples,
            _gnss(gnss, rig.gnss_time_offset_s - recorded.gnss_time_offset_s),
            _read_report(folder / "report.json"),
            recorded,
            hidden,
            imu_repair,
        )

    def __len__(self) -> int:
        return len(self.index)

    def __getitem__(self, k: int) -> Multiframe:
        if not -len(self) <= k < len(self):
            raise IndexError(f"frame {k} of {len(self)}")
        row = self.index[k]
        columns = self._columns(k % len(self))
        if self.rig is not self.recorded:
            columns["dt_ns"] = columns["dt_ns"] + self._clock_change_ns()[columns["sensor"]]
            columns["xyz"] = self._with_beams(columns["xyz"], columns["ring"], columns["sensor"])
        frame = Multiframe(
            int(row["frame_id"]), int(row["t_ns"]), int(row["duration_ns"]), **columns
        )
        return self.hidden.seen(frame) if self.hidden else frame

    def _columns(self, k: int) -> dict[str, NDArray[Any]]:
        from recon4.store.packed_points import unpack

        row = self.index[k]
        start, stop = int(row["start"]), int(row["stop"])
        if self.index.dtype == EARLIER_INDEX:
            return earlier_columns(self.folder, start, stop)
        first, where = int(self.index["end"][k - 1]) if k else 0, f"{self.folder.name}/{POINTS}"
        try:
            with (self.folder / POINTS).open("rb") as file:
                file.seek(first)
                data = file.read(int(row["end"]) - first)
        except OSError as error:
            raise StoreError(f"{where} cannot be read: {error.strerror}") from error
        where = f"{where}: multiframe {k}"
        return unpack(data, stop - start, step=int(row["step"]), where=where)

    def __iter__(self) -> Iterator[Multiframe]:
        return (self[k] for k in range(len(self)))

    def __reduce__(self) -> tuple[Any, ...]:
        rig = None if self.rig is self.recorded else self.rig
        opened = partial(FrameStore.open, imu_repair=self.imu_repair)
        return opened, (self.folder, rig, self.hidden)

    def with_rig(self, rig: Rig) -> FrameStore:
        """The same multiframes with calibrated mounts and clocks."""
        return self.__reduce__()[0](self.folder, rig, self.hidden)

    def with_imu(self, imu: ImuSamples) -> FrameStore:
        """The same multiframes with repaired samples, for this process."""
        return replace(self, imu=imu)

    def _clock_change_ns(self) -> NDArray[np.int32]:
        """How the clock offset of each LiDAR differs from that in the files [ns], (S,)."""
        pairs = zip(self.rig.sensors, self.recorded.sensors, strict=True)
        change_s = [new.time_offset_s - old.time_offset_s for new, old in pairs]
        return np.rint(1e9 * np.array(change_s)).astype(np.int32)

    def _with_beams(
        self,
        xyz: NDArray[np.float32],
        ring: NDArray[np.uint8],
        sensor: NDArray[np.uint8],
    ) -> NDArray[np.float32]:
        """Points with the corrections of beams by which the rig differs from that in the files."""
        for row, (new, old) in enumerate(zip(self.rig.sensors, self.recorded.sensors, strict=True)):
            change = beam_change(old.beams, new.beams)
            if change is not None:
                mine = np.flatnonzero(sensor == row)
                xyz[mine], _ = change.apply(xyz[mine], ring[mine])
        return xyz

    @property
    def t_mid_ns(self) -> Times:
        """Middle of each multiframe [ns], (N,)."""
        return np.asarray(self.index["t_ns"] + self.index["duration_ns"] // 2, dtype=np.int64)

    @property
    def points(self) -> int:
        """Points of all multiframes together."""
        return int(self.index["stop"][-1]) if len(self) else 0


def open_frames(
    frames: Path,
    calibration: Path | None,
    odometry: Path | None = None,
    *,
    with_moving: bool = False,
) -> FrameStore:
    """Open the multiframes of a project with its calibrated rig, if that is used.

    Args:
        frames: Folder of the stage ``frames``.
        calibration: Folder of the stage ``calibration``; None = the rig of the recording.
        odometry: Folder of the stage ``odometry``, which knows the points on moving objects: they
            are left out, and what is wrong with the IMU. None = all is as recorded.
        with_moving: Leave no points out.

    Raises:
        StoreError: If a folder is incomplete or damaged.
        ConfigError: If the rig file is damaged.
    """
    path = calibration / CALIBRATED_RIG if calibration else None
    moving = odometry / MOVING_POINTS if odometry and not with_moving else None
    return FrameStore.open(
        frames,
        load_rig(path) if path and path.is_file() else None,
        load_record(moving, HiddenPoints) if moving and moving.is_file() else None,
        imu_repair=read_imu_repair(odometry) if odometry else None,
    )


def _imu(path: Path, change_s: float) -> ImuSamples | None:
    if not path.exists():
        return None
    samples = load_record(path, ImuSamples)
    return replace(samples, t_ns=samples.t_ns + round(1e9 * change_s)) if change_s else samples


def _gnss(path: Path, change_s: float) -> GnssSamples | None:
    if not path.exists():
        return None
    samples = load_record(path, GnssSamples)
    return replace(samples, t_ns=samples.t_ns + round(1e9 * change_s)) if change_s else samples


def _check_order(folder: Path, index: NDArray[np.void]) -> None:
    """Check that frames count from 0 and their points follow each other."""
    stops = np.concatenate([[0], index["stop"]])
    good = (index["frame_id"] == np.arange(len(index))) & (index["start"] == stops[:-1])
    good &= np.diff(stops) >= 0
    if not good.all():
        row = int(np.argmin(good))
        raise StoreError(
            f"{folder.name}/index.npy: row {row}: expected frame {row} from point {stops[row]} on, "
            f"got {index[row]}"
        )


def _check_points(folder: Path, index: NDArray[np.void]) -> None:
    """Check that the bytes of the frames follow each other and fill their file."""
    ends = np.concatenate([[0], index["end"]])
    good = (np.diff(ends) > 0) & (np.abs(index["step"]) < 128)
    if not good.all():
        row = int(np.argmin(good))
        where = f"{folder.name}/index.npy: row {row}"
        raise StoreError(f"{where}: expected bytes from {ends[row]} on, got {index[row]}")
    path = folder / POINTS
    found = path.stat().st_size if path.is_file() else -1
    if found != ends[-1]:
        raise StoreError(
            f"{folder.name}/{POINTS}: expected {ends[-1]} bytes of {len(index)} multiframes, "
            f"got {found if found >= 0 else 'no file'}"
        )


def _read_report(path: Path) -> dict[str, object]:
    try:
        return read_object(path)
    except StoreError as error:
        if path.exists():
            raise StoreError(unreadable(path.name, error)) from error
        return {}


@contextmanager
def storing(folder: Path) -> Iterator[None]:
    """Errors of writing into a folder as `StoreError`, a full disk as `NoSpace`."""
    try:
        yield
    except OSError as error:
        kind = NoSpace if error.errno in _NO_SPACE else StoreError
        why = error.strerror or str(error)
        raise kind(CodedText("cannot-write", name=str(folder), why=why)) from error


def _close_quietly(file: BinaryIO) -> None:
    """Close a file; a full disk is not reported again, because it has raised an error before."""
    try:
        file.close()
    except OSError as error:
        if error.errno not in _NO_SPACE:
            raise
