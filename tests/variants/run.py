"""Draws a variant, reads and maps it, and judges what came of it."""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from recon4.errors import Recon4Error
from recon4.geometry.se2 import from_se3
from recon4.model.unused import unused_parts
from recon4.pipeline import calibrate_recording, process
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.info import describe
from recon4.recording.sources import Sources
from recon4.results_2d import Summary2d
from recon4.settings import Settings, override, preset
from recon4.store.arrays import load_trajectory
from recon4.store.frames import FrameStore
from tests.planar_walks import PlanarWalk
from tests.variants.bags import write_bag
from tests.variants.captures import write_capture
from tests.variants.folders import write_folder
from tests.variants.lasers import error_m, write_laser
from tests.variants.variant import Draw, Variant
from tests.variants.walk import RecordedWalk

LARGEST_ERROR_M = 0.10
LEAST_USED = 0.99
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
    seconds: float = 0.0
    """Processor time."""

    def text(self) -> str:
        """One line."""
        v, found = self.variant, "; ".join(self.findings) or "-"
        return (
            f"{self.seed} | {v.kind} | {', '.join(v.traits)} | {self.result} | "
            f"{self.used_ratio:.3f} | {100 * self.error_m:.1f} | {found}"
        )


def run_variant(seed: int, walk: RecordedWalk, folder: Path) -> Outcome:
    """Draw a variant by its seed, and judge what `info` and `process` make of it.

    Args:
        seed: Of everything that is drawn.
        walk: What is recorded.
        folder: An empty folder.
    """
    started = time.process_time()
    draw = Draw(seed)
    kind = draw.one("bag", "bag", "bag", "pcap", "folder", "laser")
    planar: PlanarWalk | None = None
    if kind == "laser":
        variant, planar = write_laser(draw, folder)
    else:
        write = {"bag": write_bag, "pcap": write_capture, "folder": write_folder}[kind]
        variant = write(draw, walk, folder)
    outcome = Outcome(seed, variant)
    _guarded(outcome, "info", lambda: _inform(outcome))
    if planar is not None:
        _guarded(outcome, "process", lambda: _map_planar(outcome, planar, folder / "out"))
    else:
        _guarded(outcome, "process", lambda: _map(outcome, walk, folder / "out"))
    _judge(outcome)
    outcome.seconds = time.process_time() - started
    return outcome


def _guarded(outcome: Outcome, what: str, run: Callable[[], None]) -> None:
    """Run a command; an error of recon4 is a refusal, any other a finding."""
    try:
        run()
    except Recon4Error as error:
        outcome.said.append(f"{what}: {error}")
        if what == "process":
            outcome.result = "refused"
            if not outcome.variant.refusal:
                outcome.findings.append(f"REFUSED: {error}")
    except Exception as error:
        place = traceback.extract_tb(error.__traceback__)[-1]
        where = f"{Path(place.filename).name}:{place.lineno}"
        outcome.findings.append(f"TRACEBACK in {what}: {type(error).__name__}: {error} ({where})")


def _inform(outcome: Outcome) -> None:
    info = describe(outcome.variant.path)
    assert info.lines()


def _sources(variant: Variant) -> Sources:
    return Sources((variant.path,), variant.rig, variant.imu, None)


def _settings() -> Settings:
    return override(preset("indoor"), ["calibration.mode=off"])


# -- three dimensions


def _map(outcome: Outcome, walk: RecordedWalk, out: Path) -> None:
    """The stages that read and track; later ones see what they made."""
    variant = outcome.variant
    calibrate_recording(_sources(variant), out, settings=_settings(), progress=Silent())
    store = FrameStore.open(next(out.glob("artifacts/*/index.npy")).parent)
    counts = store.report["counts"]
    outcome.said += [*store.report["warnings"], *(part.text for part in unused_parts(counts))]
    usual = sum(counts.get(f"points_{k}", 0) for k in ("near", "far", "of_incomplete_frames"))
    if variant.points:
        outcome.used_ratio = (store.points + usual) / variant.points
    if variant.samples:
        _judge_samples(outcome, 0 if store.imu is None else len(store.imu))
    found = load_trajectory(next(out.glob("artifacts/*/trajectory.npz")))
    outcome.error_m = walk.error_m(found, variant.offset_ns)


def _judge_samples(outcome: Outcome, used: int) -> None:
    expected = outcome.variant.samples
    if used >= LEAST_USED * expected:
        return
    said = [text for text in outcome.said if "IMU" in text or "accel" in text]
    how = "not used" if said else "SILENT: not used"
    outcome.findings.append(f"{how}: {expected - used} of {expected} IMU samples: {said[:1]}")


# -- planar


def _map_planar(outcome: Outcome, walk: PlanarWalk, out: Path) -> None:
    summary = process(_sources(outcome.variant), out, progress=Silent())
    assert isinstance(summary, Summary2d)
    outcome.said += [text for text in summary.verdict.reasons if _UNVERIFIED not in text]
    outcome.said += summary.warnings
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
    if outcome.used_ratio > 1.02:
        outcome.findings.append(f"{outcome.used_ratio:.3f} of what there is is used")
    if not outcome.error_m > LARGEST_ERROR_M:
        return
    if not outcome.said:
        outcome.findings.append(f"SILENT: {outcome.error_m:.2f} m wrong")
    elif variant.exact:
        outcome.findings.append(f"{outcome.error_m:.2f} m wrong, though nothing is missing")


def used_of(outcomes: list[Outcome]) -> float:
    """Mean part of the sound data that is used, where it was read."""
    ratios = [o.used_ratio for o in outcomes if np.isfinite(o.used_ratio)]
    return float(np.mean(ratios))
