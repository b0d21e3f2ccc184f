"""Opener of folders of MANDEYE devices."""

from __future__ import annotations

import numpy as np

from recon4.errors import UnknownFormat
from recon4.locales.coded import CodedText
from recon4.recording.mandeye.folder import MandeyeWalk, list_walk
from recon4.recording.mandeye.read import MandeyeRecording, walk_streams
from recon4.recording.openers.request import OpenRequest, Recording
from recon4.recording.rigs.choice import choose_rig


def open_mandeye(request: OpenRequest) -> Recording:
    """The parts of one walk; several LiDARs have numbers."""
    if len(request.paths) > 1:
        raise UnknownFormat(CodedText("mandeye-one-folder"))
    walk = list_walk(request.paths[0], request.report)
    rig = request.rig or choose_rig(walk_streams(walk), request.report)
    recording = MandeyeRecording(walk, rig, request.report)
    return Recording(rig, recording.read, walk_seconds(walk))


def walk_seconds(walk: MandeyeWalk) -> float:
    """Duration of a walk [s]: its last part is taken to be as long as the others."""
    starts = np.array([part.t_first_ns for part in walk.parts], np.int64)
    steps = np.diff(starts)
    usual = float(np.median(steps)) if len(steps) else 0.0
    return (float(starts[-1] - starts[0]) + usual) / 1e9
