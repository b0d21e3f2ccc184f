"""Whether each multiframe has a pose by its own points."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from recon4.findings.walk_record import WalkRecord
from recon4.findings.witnesses.base import Witness, finding
from recon4.findings.witnesses.tuning import TRACKING_WITNESS
from recon4.findings.witnesses.uncertainty import is_known
from recon4.findings.witnesses.weak_directions import held_by_surfaces
from recon4.geometry.se3 import Array
from recon4.model.finding import Finding, Level, Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.trajectory import Times

Flags = NDArray[np.bool_]


class Tracking(Witness):
    """Multiframes whose registration was rejected."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Where tracking was lost, and what holds the map there."""
        lost = np.asarray(walk.steps.get("lost", np.empty(0)), dtype=bool)
        if not len(lost):
            return
        held = held_by_surfaces(walk.support, lost)
        if held is not None:
            yield _laser_poses_missing(lost, held, walk.steps["t_mid_ns"])
        elif lost.any():
            yield _lost(lost, walk)
        else:
            yield finding(FindingKind.TRACKING_KEPT, Level.GOOD, {"multiframes": len(lost)})


class Convergence(Witness):
    """Registrations whose iterations were stopped."""

    def check(self, walk: WalkRecord) -> Iterator[Finding]:
        """Whether most multiframes converged, and whether one that did not is far from expected."""
        converged = np.asarray(walk.steps.get("converged", np.empty(0)), dtype=bool)
        if not len(converged):
            return
        far_m = _far_m(walk.steps)
        far = np.flatnonzero(far_m > TRACKING_WITNESS.far_m)
        ratio = float(converged.mean())
        if ratio >= TRACKING_WITNESS.min_converged and not len(far):
            return
        t_s = (walk.steps["t_mid_ns"] - walk.steps["t_mid_ns"][0]) / 1e9
        values: dict[str, Value] = {}
        if ratio < TRACKING_WITNESS.min_converged:
            counts = {"converged": int(converged.sum()), "multiframes": len(converged)}
            values |= counts | {"ratio": ratio}
        if len(far):
            values |= {"far": len(far), "far_m": float(far_m.max()), "far_s": float(t_s[far[0]])}
        yield finding(
            FindingKind.NOT_CONVERGED,
            Level.CHECK if ratio >= TRACKING_WITNESS.half else Level.DO_NOT_USE,
            values,
            span_s=(float(t_s[far[0]]), float(t_s[far[-1]])) if len(far) else None,
        )


def _far_m(steps: Mapping[str, NDArray[Any]]) -> Array:
    """How far from their prediction multiframes lie that did not converge [m], (N,).

    The first one has no prediction, and lost ones are reported by themselves.
    """
    offset_m = np.asarray(steps.get("prediction_offset_m", np.zeros(len(steps["converged"]))))
    stopped = ~np.asarray(steps["converged"], bool) & ~np.asarray(steps["lost"], bool)
    stopped[0] = False
    return np.where(stopped, np.nan_to_num(offset_m), 0.0)


def _lost(lost: Flags, walk: WalkRecord) -> Finding:
    t_ns = walk.steps["t_mid_ns"]
    held = _short_gaps(lost, t_ns) and is_known(walk)
    return finding(
        FindingKind.TRACKING_LOST,
        Level.CHECK if held else Level.DO_NOT_USE,
        _counts(lost, t_ns) | {"held": held},
        span_s=_span_s(lost, t_ns),
    )


def _short_gaps(lost: Flags, t_ns: Times) -> bool:
    """Whether few multiframes are lost, and never many in a row."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], lost, [False]]).astype(np.int8)))
    begin, end = edges[::2], np.minimum(edges[1::2], len(t_ns) - 1)
    longest_s = float((t_ns[end] - t_ns[begin]).max()) / 1e9
    return (
        float(lost.mean()) <= TRACKING_WITNESS.few_lost
        and longest_s <= TRACKING_WITNESS.short_gap_s
    )


def _laser_poses_missing(lost: Flags, held: Flags, t_ns: Times) -> Finding:
    """What became of multiframes without a pose by the 2-D laser."""
    return finding(
        FindingKind.LASER_POSES_MISSING,
        Level.CHECK if held.all() else Level.DO_NOT_USE,
        _counts(lost, t_ns) | {"held": bool(held.all()), "not_held": int((~held).sum())},
        span_s=_span_s(lost, t_ns),
    )


def _counts(lost: Flags, t_ns: Times) -> dict[str, Value]:
    return {
        "lost": int(lost.sum()),
        "multiframes": len(lost),
        "ratio": float(lost.mean()),
        "first_s": float(t_ns[lost][0] - t_ns[0]) / 1e9,
    }


def _span_s(lost: Flags, t_ns: Times) -> tuple[float, float]:
    """From the first to the last of them [s]."""
    first, last = t_ns[lost][[0, -1]]
    return float(first - t_ns[0]) / 1e9, float(last - t_ns[0]) / 1e9
