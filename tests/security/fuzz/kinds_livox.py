"""Packets of Livox LiDARs, of every way to write points, and files of their viewer."""

from __future__ import annotations

import tempfile
from functools import cache, partial
from pathlib import Path

import numpy as np

from recon4.recording.packets.family import Payloads
from recon4.recording.packets.livox.encode import ShotReturns, encode_points
from recon4.recording.packets.livox.models import LAYOUTS, MODELS, LivoxModel, PointLayout
from recon4.recording.packets.livox.points import LivoxSource, decode_points
from recon4.recording.packets.livox.sound import sound_points, stamps_ns
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.builders import T0_NS
from tests.security.fuzz.kind import Kind, Reading
from tests.security.fuzz.seeds_recordings import read_recording
from tests.unit.recording.lvx_files import lvx
from tests.unit.recording.test_point_messages import livox_bag

_PACKETS = 12
_TYPES = tuple(LAYOUTS[row] for row in (1, 4, 7, 8, 9))
"""One of each way to write numbers, and of each number of returns."""


def model_of(layout: PointLayout) -> LivoxModel:
    """A model that sends packets of a layout."""
    return MODELS["Mid-360" if layout.sdk == 2 else "Avia"]


def packets_of(layout: PointLayout, count: int = _PACKETS) -> Payloads:
    """Data packets of a wall."""
    model = model_of(layout)
    y, z = np.random.default_rng(2).uniform(-4.0, 4.0, (2, count, layout.shots, 1))
    xyz = np.stack([np.full_like(y, 6.0), y, z], axis=-1) + np.zeros((layout.returns, 3))
    xyz[:, :, 1:, 0] += 1.0
    t_ns = T0_NS + np.arange(count) * round(layout.shots * model.shot_s * 1e9)
    shots = ShotReturns(xyz, np.full(xyz.shape[:3], 90))
    return encode_points(t_ns, shots, layout=layout, model=model)


@cache
def _seeds(layout: PointLayout) -> tuple[bytes, ...]:
    return (packets_of(layout).tobytes(),)


def _read(layout: PointLayout, path: Path) -> Reading:
    """Data packets of one sensor, one behind the other."""
    data = np.frombuffer(path.read_bytes(), dtype=np.uint8)
    payloads = data[: len(data) // layout.size * layout.size].reshape(-1, layout.size)
    report = ImportReport()
    sound = payloads[sound_points(payloads, layout, report, by_crc=layout.sdk == 2)]
    source = LivoxSource(0, model_of(layout), layout, IngestSettings())
    shots = decode_points(stamps_ns(sound, layout.sdk), sound, source, report=report)
    assert np.isfinite(shots.xyz).all()
    assert (
        len(shots)
        + sum(report.counts[name] for name in ("points_near", "points_far", "points_noise"))
        <= len(sound) * layout.shots * layout.returns
    )
    damaged = len(sound) < len(payloads) or len(data) % layout.size > 0
    return Reading(len(shots), salvaged=damaged)


@cache
def _file_seeds(version: tuple[int, int]) -> tuple[bytes, ...]:
    layout = next(
        one
        for one in LAYOUTS
        if (one.sdk, one.data_type) == ((2, 1) if version[0] == 2 else (1, 2))
    )
    packets = packets_of(layout)
    frames = [[(0, packet) for packet in packets[k : k + 4]] for k in range(0, _PACKETS, 4)]
    return (lvx(frames, version=version),)


def _read_file(path: Path) -> Reading:
    found = read_recording(path)
    return Reading(found.items, salvaged=found.outcome != "complete" or bool(found.findings))


@cache
def _bag_seeds() -> tuple[bytes, ...]:
    with tempfile.TemporaryDirectory() as place:
        return (livox_bag(Path(place), "bag1").read_bytes(),)


_FILES = {"lvx1.0": (1, 0), "lvx1.1": (1, 1), "lvx2": (2, 0)}
KINDS = tuple(
    Kind(
        name=f"livox-sdk{layout.sdk}-{layout.data_type}",
        file_name="packets.bin",
        seeds=partial(_seeds, layout),
        read=partial(_read, layout),
        # A run of packets has no end mark.
        knows_end=False,
    )
    for layout in _TYPES
) + tuple(
    Kind(
        name=name,
        file_name=f"a.{name[:3]}",
        seeds=partial(_file_seeds, version),
        read=_read_file,
        # A file of whole frames is a whole file.
        knows_end=False,
    )
    for name, version in _FILES.items()
)
KINDS += (
    Kind(
        name="bag1-livox",
        file_name="a.bag",
        seeds=_bag_seeds,
        read=_read_file,
        header_bytes=4096,
    ),
)
"""Data packets, and the files of the maker's viewer."""
