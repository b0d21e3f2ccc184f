"""Bags with points of an unknown maker: the proposed recipe, and reading by a declared one."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import Any

from recon4.model.rig import parse_rig
from recon4.recording.assembly.shots import Shots
from recon4.recording.info.describe import describe
from recon4.recording.open import open_recording
from recon4.recording.openers.request import OpenRequest
from recon4.recording.report import ImportReport
from recon4.settings import IngestSettings
from tests.security.fuzz.kind import Kind, Reading
from tests.unit.recording.point_bags import write_points
from tests.unit.recording.test_recipes import MADE


@cache
def _seeds() -> tuple[bytes, ...]:
    return tuple(_bag(definition, fill) for definition, fill, _ in MADE.values())


def _bag(definition: str, fill: Any) -> bytes:
    with tempfile.TemporaryDirectory() as place:
        return write_points(Path(place), "bag1", definition, fill, frames=2).read_bytes()


def _read(path: Path) -> Reading:
    """What `info` proposes is a rig file, by which the points are read."""
    report = ImportReport()
    rig = parse_rig(describe(path).first_rig, where="first rig")
    recording = open_recording(OpenRequest((path,), rig, IngestSettings(), report))
    items = sum(len(item) for item in recording.read() if isinstance(item, Shots))
    return Reading(items, salvaged=report.outcome != "complete" or bool(report.findings))


KINDS = (Kind(name="bag1-recipe", file_name="a.bag", seeds=_seeds, read=_read, header_bytes=4096),)
"""Structures, arrays, angles."""
