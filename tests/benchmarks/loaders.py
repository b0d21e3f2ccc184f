"""Load real sequences as multiframes, for benchmarks (the data page describes them)."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path

import numpy as np
from matplotlib.image import imread

from recon4.geometry.se3 import SE3, Array
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig, Sensor
from recon4.model.trajectory import Trajectory
from recon4.store.frames import FrameStore, FrameWriter

FRAME_NS = 100_000_000
_RANGE_PER_PIXEL_M = 1.0 / 500.0


def one_sensor(model: str) -> Rig:
    """A rig with one LiDAR in the middle of the body."""
    sensor = Sensor(name="lidar", model=model, T_body_sensor=SE3.identity())
    return Rig(
        name=f"single {model}",
        sensors=(sensor,),
        T_body_imu=SE3.identity(),
        imu_time_offset_s=0.0,
        p_body_antenna=np.zeros(3),
        gnss_time_offset_s=0.0,
    )


def nclt(folder: Path) -> Iterator[Multiframe]:
    """Key scans of ``nclt-hdl32``: rigid (no time inside a scan), an artificial clock of 10 Hz."""
    k = 0
    for path in sorted(folder.glob("scans_*.npz")):
        with np.load(path) as file:
            dxyz, offsets = file["dxyz_2mm"], file["offsets"]
        for a, b in pairwise(offsets.tolist()):
            xyz = np.cumsum(dxyz[a:b], axis=0, dtype=np.int16) * 0.002
            elevation_deg = np.rad2deg(np.arctan2(xyz[:, 2], np.hypot(xyz[:, 0], xyz[:, 1])))
            ring = np.clip(np.round((elevation_deg + 30.67) / (41.34 / 31)), 0, 31)
            yield _frame(k, k * FRAME_NS, FRAME_NS, xyz, ring, np.full(len(xyz), FRAME_NS // 2))
            k += 1


def nclt_truth(folder: Path) -> Trajectory:
    """True poses ``T_world_lidar`` on the clock of `nclt`."""
    poses = []
    for path in sorted(folder.glob("scans_*.npz")):
        with np.load(path) as file:
            poses.append(file["T_world_lidar"])
    matrices = np.concatenate(poses)
    t_ns = np.arange(len(matrices), dtype=np.int64) * FRAME_NS + FRAME_NS // 2
    return Trajectory(t_ns, SE3.from_matrix(matrices))


def muehlburg(folder: Path, rows: slice = slice(None)) -> Iterator[Multiframe]:
    """``hdl64-muehlburg``: not deskewed; a point's time follows from its column."""
    numbers = _numbers((folder / "velodyne_config.txt").read_text("ascii"))
    down_deg = np.array(numbers[5:])
    starts = _times(folder / "timestamps_start.txt")
    ends = _times(folder / "timestamps_end.txt")
    for k, path in list(enumerate(sorted(folder.glob("*.png"))))[rows]:
        yield _range_image(k, path, down_deg, start_ns=int(starts[k]), end_ns=int(ends[k]))


def durlacher(folder: Path) -> Iterator[Multiframe]:
    """``hdl64-durlacher``: the same sensor; scans are taken to end half-way to the next one."""
    down_deg = np.array(_numbers((folder / "img.cfg").read_text("ascii"))[4:])
    t_ns = durlacher_ins(folder)[0]
    half_ns = int(np.median(np.diff(t_ns))) // 2
    for k, path in enumerate(sorted(folder.glob("scan*.png"))):
        mid_ns = int(t_ns[k])
        yield _range_image(k, path, down_deg, start_ns=mid_ns - half_ns, end_ns=mid_ns + half_ns)


def durlacher_ins(folder: Path) -> tuple[Array, Array]:
    """Times [ns] (N,) and rows (N, 15) of ``imu.cfg``; rates hold overflow garbage."""
    rows = []
    for line in (folder / "imu.cfg").read_text("ascii").splitlines():
        cells = line.strip().rstrip(";").split(";")
        if len(cells) >= 17 and cells[0][:2] == "20":
            rows.append(
                (int(np.datetime64(cells[0].replace(" ", "T"), "ns").astype(np.int64)), cells)
            )
    t_ns = np.array([t for t, _ in rows], dtype=np.int64)
    return t_ns, np.array([[float(c) for c in cells[2:17]] for _, cells in rows])


def store(frames: Iterable[Multiframe], rig: Rig, folder: Path) -> FrameStore:
    """Write multiframes into a frame store and open it."""
    with FrameWriter(folder, rig) as writer:
        for frame in frames:
            writer.append(frame)
    return FrameStore.open(folder)


def _range_image(k: int, path: Path, down_deg: Array, *, start_ns: int, end_ns: int) -> Multiframe:
    pixels = np.round(imread(path) * 65535.0).astype(np.uint16)
    assert pixels.shape == (len(down_deg), 870), f"{path.name}: {pixels.shape}"
    column, row = np.nonzero(pixels.T)  # column by column, as it was measured
    range_m = pixels[row, column] * _RANGE_PER_PIXEL_M
    azimuth = np.deg2rad(180.0 - 360.0 * (column + 0.5) / 870.0)
    elevation = -np.deg2rad(down_deg[row])
    flat = range_m * np.cos(elevation)
    xyz = np.stack([flat * np.cos(azimuth), flat * np.sin(azimuth), range_m * np.sin(elevation)], 1)
    dt_ns = (column + 0.5) / 870.0 * (end_ns - start_ns)
    ring = len(down_deg) - 1 - row
    return _frame(k, start_ns, end_ns - start_ns, xyz, ring, dt_ns)


def _frame(
    k: int, t_ns: int, duration_ns: int, xyz: Array, ring: Array, dt_ns: Array
) -> Multiframe:
    n = len(xyz)
    return Multiframe(
        frame_id=k,
        t_ns=t_ns,
        duration_ns=duration_ns,
        xyz=np.ascontiguousarray(xyz, dtype=np.float32),
        intensity=np.zeros(n, dtype=np.uint16),
        ring=np.asarray(ring, dtype=np.uint8),
        sensor=np.zeros(n, dtype=np.uint8),
        echo=np.zeros(n, dtype=np.uint8),
        dt_ns=np.asarray(dt_ns, dtype=np.int32),
    )


def _numbers(text: str) -> list[float]:
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return [float(word) for word in " ".join(lines).replace(";", " ").split()]


def _times(path: Path) -> Array:
    lines = path.read_text("ascii").split("\n")
    stamps = [line.strip().replace(" ", "T") for line in lines if line.strip()]
    return np.array(stamps, dtype="datetime64[ns]").astype(np.int64)
