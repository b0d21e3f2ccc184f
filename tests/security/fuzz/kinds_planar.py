"""Recordings of a profiler and a 2-D laser, and the tables that go with them."""

from __future__ import annotations

import bz2
import contextlib
import gzip
import tempfile
from collections.abc import Iterator
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from recon4.calibration.pose_pairs import average_pairs, hand_eye, read_pose_pairs
from recon4.errors import Recon4Error
from recon4.evaluation.relations import read_relations
from recon4.model.laser_scans import LaserScans
from recon4.model.rig import load_rig
from recon4.recording.formats.three_dtk import read_pose, read_scan
from recon4.recording.formats.urdf import urdf_joints
from recon4.recording.info.describe import describe
from recon4.recording.lasers.laser2d import is_laser2d, read_laser2d
from recon4.recording.lasers.line_recording import LineRecording
from recon4.recording.lasers.line_tables import LineTableRecording, LineTables
from recon4.recording.lasers.tables import read_laser_table
from recon4.recording.mounts.driven_joints import driven_joint
from recon4.recording.report import ImportReport
from recon4.simulation.line_bag import open_line_bag
from recon4.untrusted.bounded import read_text_limited
from tests.builders import storage_file
from tests.line_tables import laser_columns, line_columns, write_csv, write_npz
from tests.planar_walks import carmen_lines
from tests.security.fuzz.kind import Kind, Reading
from tests.unit.recording.test_transform_messages import URDF

_T0_NS = 1_700_000_000_000_000_000
_LINE_NS = 10_000_000


def _scans(count: int, beams: int) -> LaserScans:
    t_ns = _T0_NS + _LINE_NS * np.arange(count, dtype=np.int64)
    ranges = np.linspace(1.0, 8.0, count * beams, dtype=np.float32).reshape(count, beams)
    return LaserScans.of_rows(
        t_ns,
        ranges,
        angles=(-0.5, 0.05),
        range_max_m=30.0,
        time_step_s=4e-4,
    )


@cache
def _carmen() -> tuple[bytes, ...]:
    walked = np.linspace(0.0, 1.0, 30)[:, None] * np.ones(3)
    scans = replace(_scans(30, 21), odometry=walked)
    text = "".join(f"{line}\n" for line in carmen_lines(scans)).encode()
    return text, bz2.compress(text), gzip.compress(text, mtime=0)


def _read_carmen(path: Path) -> Reading:
    assert is_laser2d(path)
    report = ImportReport()
    return Reading(len(read_laser2d([path], report)), salvaged=report.outcome != "complete")


@cache
def _bag(*, profiler: bool) -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as folder:
        with open_line_bag(Path(folder) / "bag") as bag:
            if profiler:
                t_ns = _T0_NS + _LINE_NS * np.arange(22, dtype=np.int64)
                bag.head("/profiler/head", t_ns, 1e-9 * (t_ns - _T0_NS))
                bag.scans("/profiler/line", _scans(20, 21))
            bag.scans("/laser2d/scan", _scans(20, 21))
        return (storage_file(Path(folder) / "bag").read_bytes(),)


def _read_laser_bag(path: Path) -> Reading:
    report = ImportReport()
    found = len(read_laser2d([path], report)) if is_laser2d(path) else 0
    return Reading(found, salvaged=report.outcome != "complete" or not found)


def _read_line_bag(path: Path) -> Reading:
    report = ImportReport()
    recording = LineRecording([path], load_rig("wuerzburg"), report=report)
    found = sum(len(item) for item in recording.read())
    return Reading(found, salvaged=report.outcome != "complete")


@cache
def _relations() -> tuple[bytes, ...]:
    rows = (f"{k}.25 {k + 3}.5 0.{k} 0.1 0 0 0 0.0{k}\n" for k in range(12))
    return ("".join(rows).encode(),)


@cache
def _pose_pairs() -> tuple[bytes, ...]:
    yaw = np.linspace(0.0, 2.0, 12)
    quats = np.stack([0.0 * yaw, np.sin(0.1 * yaw), np.sin(yaw), np.cos(yaw)], axis=1)
    quats /= np.linalg.norm(quats, axis=1)[:, None]
    rows = (
        f"{k},0.5,1,{','.join(map(str, q))},{k},0.7,1.1,{','.join(map(str, q))}\n"
        for k, q in enumerate(quats.tolist())
    )
    return ("".join(rows).encode(),)


def _read_pose_pairs(path: Path) -> Reading:
    pairs = read_pose_pairs(path)
    average_pairs(pairs)
    hand_eye(pairs, before_m=np.zeros(3))
    return Reading(len(pairs.T_world_marker))


@cache
def _scan_3d() -> tuple[bytes, ...]:
    rows = "".join(f"{k}.25 {2 * k} 300.5 {k}\n" for k in range(20))
    return rows.encode(), b"4 x 5\n1 2 3\n4 5 6\n"


@cache
def _pose_3d() -> tuple[bytes, ...]:
    return (b"100.5 -20 300\n0.5 -90 12.25\n",)


def _read_pose_3d(path: Path) -> Reading:
    read_pose(path)
    return Reading(1)


@cache
def _tables(name: str, *, archive: bool) -> tuple[bytes, ...]:
    """A table of a profiler or of a 2-D laser; an archive also without compression."""
    scans = replace(_scans(12, 21), odometry=np.linspace(0.0, 1.0, 12)[:, None] * np.ones(3))
    columns = laser_columns(scans) if name == "laser2d" else line_columns(scans, _turning)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "table"
        if not archive:
            write_csv(path, columns)
            plain = path.read_bytes()
            return plain, plain.replace(b",", b";").replace(b".", b",")
        write_npz(path.with_suffix(".npz"), columns)
        np.savez(path.with_suffix(".plain.npz"), **columns)
        return tuple(found.read_bytes() for found in sorted(Path(folder).iterdir()))


def _turning(t_ns: NDArray[np.int64]) -> NDArray[np.float64]:
    return 1e-9 * (t_ns - _T0_NS)


def _read_line_table(path: Path) -> Reading:
    with contextlib.suppress(Recon4Error):
        describe(path).lines()
    report = ImportReport()
    recording = LineTableRecording(LineTables.of([path]), load_rig("wuerzburg"), report=report)
    found = sum(len(item) for item in recording.read())
    return Reading(found, salvaged=bool(report.counts["lines_out_of_order"]))


def _read_laser_table(path: Path) -> Reading:
    with contextlib.suppress(Recon4Error):
        describe(path).lines()
    return Reading(len(read_laser_table(path, ImportReport())))


def _table_kinds() -> Iterator[Kind]:
    for name, read in (("lines", _read_line_table), ("laser2d", _read_laser_table)):
        for suffix in ("csv", "npz"):
            yield Kind(
                name=f"{suffix}-{name}",
                file_name=f"{name}.{suffix}",
                seeds=partial(_tables, name, archive=suffix == "npz"),
                read=read,
                knows_end=suffix == "npz",
            )


def _urdf() -> tuple[bytes, ...]:
    driven = '<joint name="{}" type="prismatic"><parent link="imu"/><child link="{}"/>{}</joint>'
    more = driven.format("d", "e", '<axis xyz="0 0.6 0.8"/>')
    more += driven.format("f", "g", '<mimic joint="b" multiplier="-2" offset="0.1"/>')
    return (URDF.encode(), URDF.replace("</robot>", more + "</robot>").encode())


def _read_urdf(path: Path) -> Reading:
    joints = urdf_joints(read_text_limited(path, 1 << 20))
    moved = [driven_joint(joint, "/robot_description") for joint in joints]
    for joint in filter(None, moved):
        assert np.isfinite(joint.at(np.array([-1e3, 0.0, 1.0])).matrix()).all()
    return Reading(len(joints))


KINDS = (
    Kind(name="urdf", file_name="robot.urdf", seeds=_urdf, read=_read_urdf),
    *_table_kinds(),
    Kind(
        name="scan-3d",
        file_name="scan000.3d",
        seeds=_scan_3d,
        read=lambda path: Reading(len(read_scan(path)["x"])),
        knows_end=False,
    ),
    Kind(name="pose-3d", file_name="a.pose", seeds=_pose_3d, read=_read_pose_3d, knows_end=False),
    Kind(name="carmen", file_name="a.log", seeds=_carmen, read=_read_carmen, knows_end=False),
    Kind(
        name="db3-laser",
        file_name="a.db3",
        seeds=partial(_bag, profiler=False),
        read=_read_laser_bag,
        header_bytes=4096,
    ),
    Kind(
        name="db3-lines",
        file_name="a.db3",
        seeds=partial(_bag, profiler=True),
        read=_read_line_bag,
        header_bytes=4096,
    ),
    Kind(
        name="relations",
        file_name="a.relations",
        seeds=_relations,
        read=lambda path: Reading(len(read_relations(path).t_i_ns)),
        knows_end=False,
    ),
    Kind(
        name="pose-pairs",
        file_name="pairs.csv",
        seeds=_pose_pairs,
        read=_read_pose_pairs,
        knows_end=False,
    ),
)
