"""Draws a variant, reads and maps it, and judges what came of it."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path

import numpy as np

from recon4.errors import Recon4Error
from recon4.findings.witnesses.base import finding
from recon4.findings.wording import whole_text
from recon4.geometry.se2 import from_se3
from recon4.model.finding import Level
from recon4.model.finding_kinds import FindingKind
from recon4.model.import_notes import import_notes
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Trajectory
from recon4.model.unused_data import unused_parts
from recon4.pipeline import calibrate_recording, process, track_lines
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.info.describe import describe
from recon4.recording.sources import Sources
from recon4.settings import Settings, override, preset
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore
from recon4.workflows.planar_results import Summary2d
from tests.planar_walks import PlanarWalk
from tests.variants.bags import write_bag
from tests.variants.captures import write_capture
from tests.variants.folders import write_folder
from tests.variants.lasers import error_m, write_laser
from tests.variants.line_walks import LineWalk, line_walk, write_line_walk
from tests.variants.line_walks import error_m as line_error_m
from tests.variants.variant import Draw, Variant
from tests.variants.walk import RecordedWalk

LARGEST_ERROR_M = 0.10
LEAST_USED = 0.99
FEWEST_TIMES = 0.1
"""Of the points; two returns of a shot and two LiDARs share a time, floats of 32 bits more."""
_LINES_S = 8.0
"""Length of a walk with a profiler: more than one sweep of its head."""
_UNVERIFIED = "unverified"
"""So short a planar walk closes no loop, which its verdict says."""


@dataclass(slots=True)
class Outcome:
    """What came of a variant."""

    seed: int
    variant: Variant
    result: str = "mapped"
    """``mapped`` or ``refused``."""
    findings: list[str] = field(default_factory=list)
    """What must not happen."""
    said: list[str] = field(default_factory=list)
    """Warnings, losses and reasons of the verdict."""
    used_ratio: float = float("nan")
    """Of the sound points or scans."""
    error_m: float = float("nan")
    verdict: list[str] = field(default_factory=list)
    """The verdict of the whole map and its reasons, if it was made."""
    seconds: float = 0.0
    """Processor time."""

    def text(self) -> str:
        """One line."""
        v, found = self.variant, "; ".join(self.findings) or "-"
        return (
            f"{self.seed} | {v.kind} | {', '.join(v.traits)} | {self.result} | "
            f"{self.used_ratio:.3f} | {100 * self.error_m:.1f} | {found}"
        )


def run_variant(seed: int, walk: RecordedWalk, folder: Path, *, whole: bool = False) -> Outcome:
    """Draw a variant by its seed, and judge what `info` and `process` make of it.

    Args:
        seed: Of everything that is drawn.
        walk: What is recorded.
        folder: An empty folder.
        whole: Run all stages, not only those that read and track.
    """
    started = time.process_time()
    draw = Draw(seed)
    kind = draw.one(*["bag"] * 6, *["pcap"] * 3, "folder", "folder", "laser", "laser", "profiler")
    out = folder / "out"
    if kind == "laser":
        variant, planar = write_laser(draw, folder)
        outcome = Outcome(seed, variant)
        run = partial(_map_planar, outcome, planar, out)
    elif kind == "profiler":
        lines = line_walk(_LINES_S)
        outcome = Outcome(seed, write_line_walk(draw, lines, folder))
        run = partial(_map_lines, outcome, lines, out)
    else:
        write = {"bag": write_bag, "pcap": write_capture, "folder": write_folder}[kind]
        outcome = Outcome(seed, write(draw, walk, folder))
        run = partial(_map, outcome, walk, out)
    _guarded(outcome, "info", lambda: _inform(outcome))
    _guarded(outcome, "process", run)
    if whole and outcome.result == "mapped":
        _guarded(outcome, "process", lambda: _finish(outcome, out))
    _judge(outcome)
    outcome.seconds = time.process_time() - started
    return outcome


def _guarded(outcome: Outcome, what: str, run: Callable[[], None]) -> None:
    """Run a command; an error of recon4 is a refusal, any other a finding."""
    try:
        run()
    except Recon4Error as error:
        outcome.said.append(f"{what}: {error}")
        if what == "info" and not outcome.variant.refusal:
            outcome.findings.append(f"REFUSED by info: {error}")
        if what == "process":
            outcome.result = "refused"
            if not outcome.variant.refusal:
                outcome.findings.append(f"REFUSED: {error}")
            outcome.findings += [
                f"refused without {words!r}: {error}"
                for words in outcome.variant.remedies
                if words not in str(error)
            ]
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(place.filename).name}:{place.lineno}"
        outcome.findings.append(f"TRACEBACK in {what}: {type(error).__name__}: {error} ({where})")


def _inform(outcome: Outcome) -> None:
    info = describe(outcome.variant.path)
    assert info.lines()


def _sources(variant: Variant) -> Sources:
    return Sources((variant.path,), variant.rig, variant.imu, variant.gnss)


def _settings() -> Settings:
    return override(preset("indoor"), ["calibration.mode=off"])


# -- three dimensions


def _map(outcome: Outcome, walk: RecordedWalk, out: Path) -> None:
    """The stages that read and track; later ones see what they made."""
    variant = outcome.variant
    calibrate_recording(_sources(variant), out, settings=_settings(), progress=Silent())
    found = _judge_frames(outcome, out)
    outcome.error_m = walk.error_m(found, variant.offset_ns)


def _finish(outcome: Outcome, out: Path) -> None:
    """Continue with the stages after the odometry."""
    summary = process(_sources(outcome.variant), out, settings=_settings(), progress=Silent())
    outcome.verdict = [str(summary.verdict.usability), *summary.verdict.reasons]


def _map_lines(outcome: Outcome, walk: LineWalk, out: Path) -> None:
    """The same of a backpack with a profiler."""
    track_lines(_sources(outcome.variant), out, settings=_settings(), progress=Silent())
    outcome.error_m = line_error_m(walk, _judge_frames(outcome, out))


def _judge_frames(outcome: Outcome, out: Path) -> Trajectory:
    """Judge what was read; returns the trajectory."""
    variant = outcome.variant
    store = FrameStore.open(next(out.glob("artifacts/*/index.npy")).parent)
    counts = store.report["counts"]
    outcome.said += map(whole_text, import_notes(store.report).findings)
    unused = [
        finding(FindingKind.IMPORT_UNUSED, Level.CHECK, p.values) for p in unused_parts(counts)
    ]
    outcome.said += map(whole_text, unused)
    usual = sum(counts.get(f"points_{k}", 0) for k in ("near", "far", "of_incomplete_frames"))
    if variant.points:
        outcome.used_ratio = (store.points + usual) / variant.points
    if variant.timed and _times_of(store) < FEWEST_TIMES * store.points:
        outcome.findings.append(f"{_times_of(store)} times of {store.points} points")
    _judge_samples(outcome, "IMU samples", variant.samples, store.imu)
    _judge_samples(outcome, "positions", variant.fixes, store.gnss)
    return load_trajectory(next(out.glob("artifacts/*/trajectory.npz")))


def _times_of(store: FrameStore) -> int:
    """How many different times the points have."""
    t_ns = [store[k].t_ns + store[k].dt_ns.astype(np.int64) for k in range(len(store))]
    return len(np.unique(np.concatenate(t_ns)))


def _judge_samples(
    outcome: Outcome, what: str, expected: int, found: ImuSamples | GnssSamples | None
) -> None:
    used = 0 if found is None else len(found)
    if used >= LEAST_USED * expected:
        return
    names = {"IMU samples": ("IMU", "accel"), "positions": ("GNSS", "position")}[what]
    said = [text for text in outcome.said if any(name in text for name in names)]
    how = "not used" if said else "SILENT: not used"
    outcome.findings.append(f"{how}: {expected - used} of {expected} {what}: {said[:1]}")


# -- planar


def _map_planar(outcome: Outcome, walk: PlanarWalk, out: Path) -> None:
    summary = process(_sources(outcome.variant), out, progress=Silent())
    assert isinstance(summary, Summary2d)
    outcome.said += [text for text in summary.verdict.reasons if _UNVERIFIED not in text]
    outcome.said += [whole_text(one) for one in summary.findings if one.level is Level.NOTE]
    outcome.used_ratio = summary.scans / outcome.variant.points
    found = read_tum(out / "trajectory.tum")
    outcome.error_m = error_m(walk, found.t_ns, from_se3(found.T_a_b))


# -- verdict


def _judge(outcome: Outcome) -> None:
    variant = outcome.variant
    if outcome.used_ratio < LEAST_USED and not outcome.said:
        outcome.findings.append(f"SILENT: {1 - outcome.used_ratio:.1%} is not used")
    if variant.damaged and outcome.result == "mapped" and not outcome.said:
        outcome.findings.append("SILENT: damaged, and nothing is said")
    unsaid = [words for words in variant.must_say if not any(words in t for t in outcome.said)]
    if outcome.result == "mapped" and unsaid:
        outcome.findings.append(f"SILENT: nothing about {' or '.join(unsaid)}: {outcome.said}")
    if outcome.used_ratio > 1.02:
        outcome.findings.append(f"{outcome.used_ratio:.3f} of what there is is used")
    if not outcome.error_m > LARGEST_ERROR_M:
        return
    if not outcome.said:
        outcome.findings.append(f"SILENT: {outcome.error_m:.2f} m wrong")
    elif variant.exact:
        outcome.findings.append(f"{outcome.error_m:.2f} m wrong, though nothing is missing")
