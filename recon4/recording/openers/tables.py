"""Opener of line scans in tables."""

from __future__ import annotations

from recon4.recording.line_tables import LineTableRecording, LineTables
from recon4.recording.openers.request import OpenRequest, Recording


def open_line_tables(request: OpenRequest) -> Recording:
    """Tables of line scans, with those of the 2-D laser and the IMU beside them."""
    tables = LineTableRecording(LineTables.of(request.paths), request.rig, report=request.report)
    return Recording(tables.rig, tables.read)
