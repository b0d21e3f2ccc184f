"""Bridges across gaps on real scans: how many are found, and how many of those are wrong.

    python -m tests.benchmarks.bridges [PAIRS]

Of NCLT: every step of more than a meter and every tenth other one, and as many pairs of scans from
anywhere in the walk as asked for (200). A bridge 1 m or 0.2 rad away from the truth is wrong.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from recon4.geometry.se3 import SE3
from recon4.registration.bridge import RecentScans, SeenScan, sure_pose
from recon4.registration.scan_chain import body_points
from recon4.registration.scan_registration import make_scan
from recon4.registration.tuning import ScanTuning
from tests.benchmarks.loaders import nclt, nclt_truth, one_sensor
from tests.benchmarks.real_sequences import DATA

_WRONG_M, _WRONG_RAD = 1.0, 0.2
_STEP_M, _BEFORE = 1.0, 12
SCANS = ScanTuning(source_points=3000)


@dataclass(frozen=True)
class Tried:
    """One bridge that was looked for."""

    found: bool
    error_m: float = 0.0
    error_rad: float = 0.0

    @property
    def wrong(self) -> bool:
        """Whether it leads elsewhere."""
        return self.error_m > _WRONG_M or self.error_rad > _WRONG_RAD


def bridge(seen: list[SeenScan], truth: SE3, k: int, j: int) -> Tried:
    """Look for scan ``j`` on the scans up to ``k``, which lie at their true poses."""
    recent = RecentScans(SCANS)
    for row in range(max(0, k - _BEFORE), k + 1):
        recent.keep(seen[row].scan, truth[row], row)
    target = recent.joined(seen[k].scan, truth[k], since_ns=0)
    T = sure_pose(target, seen[j], seen[k], initial=[SE3.identity()], settings=SCANS)
    if T is None:
        return Tried(found=False)
    apart = (truth[k].inverse() @ truth[j]).inverse() @ T
    return Tried(True, float(np.linalg.norm(apart.t)), float(apart.angle()))


def report(name: str, tries: Iterable[Tried]) -> None:
    """One line: how many were found, wrong, and how well the others fit."""
    made = list(tries)
    right = [one for one in made if one.found and not one.wrong]
    wrong = sum(one.found and one.wrong for one in made)
    error_m = np.array([one.error_m for one in right] or [np.nan])
    turn_deg = np.rad2deg([one.error_rad for one in right] or [np.nan])
    print(
        f"{name}: {len(made)} tried, {len(right)} right, {wrong} wrong; error of the right ones "
        f"{100 * np.median(error_m):.1f} cm, at most {100 * error_m.max():.1f} cm; "
        f"{np.median(turn_deg):.2f}°, at most {turn_deg.max():.2f}°",
        flush=True,
    )


def main() -> None:
    """Try steps and pairs of scans from anywhere."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    rig = one_sensor("HDL-32E")
    points = [body_points(frame, rig) for frame in nclt(DATA / "nclt-hdl32")]
    seen = [SeenScan(make_scan(p, SCANS), p) for p in points]
    truth = nclt_truth(DATA / "nclt-hdl32").T_a_b
    steps_m = [float(np.linalg.norm(b.t - a.t)) for a, b in pairwise(truth[k] for k in range(450))]
    steps = [k for k, step_m in enumerate(steps_m) if step_m > _STEP_M or k % 10 == 0]
    report("steps", (bridge(seen, truth, k, k + 1) for k in steps))
    rng = np.random.default_rng(0)
    near: list[tuple[int, int]] = []
    far: list[tuple[int, int]] = []
    while len(near) + len(far) < count:
        k, j = (int(row) for row in rng.integers(_BEFORE, len(seen), 2))
        apart_m = float(np.linalg.norm(truth[k].t - truth[j].t))
        (near if apart_m < 30.0 else far).append((k, j))
    report("pairs less than 30 m apart", (bridge(seen, truth, k, j) for k, j in near))
    report("pairs farther apart", (bridge(seen, truth, k, j) for k, j in far))


if __name__ == "__main__":
    main()
