"""Folders of clouds, as converters write them."""

from __future__ import annotations

from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from tests.builders import write_bin, write_pcd, write_ply
from tests.variants.tables import write_tables
from tests.variants.variant import Draw, Variant
from tests.variants.walk import Cloud, RecordedWalk


def write_folder(draw: Draw, walk: RecordedWalk, folder: Path) -> Variant:
    """Draw and write a folder of clouds."""
    kind = draw.one("pcd", "pcd", "ply", "bin")
    variant = Variant(f"folder of {kind}", folder / "scans")
    variant.path.mkdir()
    times = draw.one("names", "times.txt", "timestamps.txt", "dates", "none")
    variant.say(f"times: {times}")
    base_ns = walk.clouds[0].t_ns
    missing = set(draw.rows(len(walk.clouds), 3)) if draw.chance(0.2) else set()
    clouds = [cloud for k, cloud in enumerate(walk.clouds) if k not in missing]
    if missing:
        variant.say("clouds missing")
    fields = _fields(draw, kind, variant)
    variant.timed = "time" in fields
    for k, cloud in enumerate(clouds):
        name = f"{cloud.t_ns / 1e9:.6f}" if times == "names" else draw_name(variant, k)
        _write(variant.path / f"{name}.{kind}", kind, _table(cloud, fields), variant)
        variant.points += len(cloud.xyz)
    variant.offset_ns = _write_times(draw, variant, times, [c.t_ns for c in clouds])
    if times == "none":
        variant.offset_ns, variant.exact = -base_ns, False
    _spoil(draw, variant, sorted(variant.path.glob(f"*.{kind}")))
    variant.exact &= kind != "bin" and "time" in fields
    if variant.offset_ns == 0 and draw.chance(0.4):
        write_tables(draw, walk, folder, variant)
    return variant


def draw_name(variant: Variant, k: int) -> str:
    """A number, with or without zeros in front of it."""
    return f"{k:06d}" if len(str(variant.path)) % 2 else f"cloud_{k}"


def _fields(draw, kind, variant):
    fields = ["x", "y", "z", "intensity", "ring", "time"]
    if kind == "bin" or draw.chance(0.3):
        fields = fields[:4]
    if draw.chance(0.1):
        fields = [name for name in fields if name != "intensity"]
    variant.say(" ".join(fields))
    return ["x", "y", "z", "intensity"] if kind == "bin" else fields


def _table(cloud: Cloud, fields):
    columns = {
        "x": cloud.xyz[:, 0],
        "y": cloud.xyz[:, 1],
        "z": cloud.xyz[:, 2],
        "intensity": cloud.intensity.astype(np.float32),
        "ring": cloud.ring.astype(np.uint16),
        "time": (cloud.dt_ns * 1e-9).astype(np.float32),
    }
    return {name: columns[name] for name in fields}


def _write(path, kind, table, variant):
    number = len(variant.traits) + len(path.name)
    if kind == "pcd":
        encoding = ("binary", "binary_compressed")[number % 2]
        write_pcd(path, table, encoding=encoding, padding=4 * (number % 3 == 0))
    elif kind == "ply":
        write_ply(path, table)
    else:
        write_bin(path, table)


def _write_times(draw, variant, times, stamps):
    """The file of times; returns how much its clock is ahead of UTC [ns]."""
    if times in ("names", "none"):
        return 0
    offset_ns = 0
    if times == "dates":
        lines = [
            f"{datetime.fromtimestamp(t // 10**9, UTC):%Y-%m-%d %H:%M:%S}.{t % 10**9:09d}"
            for t in stamps
        ]
    else:
        unit = draw.one("s", "s", "ns", "us", "from 0")
        variant.say(f"in {unit}")
        offset_ns = -stamps[0] if unit == "from 0" else 0
        scale = {"ns": 1, "us": 1000}.get(unit, 10**9)
        lines = [_decimal(t + offset_ns, scale) for t in stamps]
    if draw.chance(0.3):
        variant.say("a damaged time")
        lines[draw.one(*range(1, len(lines) - 1))] = draw.one("nan", "?", "0")
    place = variant.path if draw.chance(0.7) else variant.path.parent
    name = "times.txt" if times == "times.txt" else "timestamps.txt"
    (place / name).write_text("\n".join(lines) + "\n")
    return offset_ns


def _decimal(t_ns, scale):
    whole, part = divmod(t_ns, scale)
    digits = len(str(scale)) - 1
    return f"{whole}.{part:0{digits}d}" if digits else str(whole)


def _spoil(draw, variant, files):
    if draw.chance(0.15):
        variant.say("a cut file")
        file = draw.one(*files)
        file.write_bytes(file.read_bytes()[:-1000])
        variant.points -= variant.points // len(files) + 2000
    if draw.chance(0.2):
        variant.say("other files beside")
        (variant.path / "README.txt").write_text("walk of Monday\n")
        (variant.path / "preview.png").write_bytes(b"\x89PNG\r\n")
        (variant.path / ".DS_Store").write_bytes(b"\0\0\0\1Bud1")
