"""Who is lost during a capture: found again, or taken for somebody at another place?

``python -m tests.benchmarks.relocalization`` walks through simulated worlds with a live map. From a
drawn moment on the LiDARs see nothing but noise for some seconds, while the operator walks on; then
they see again. The place is *known* if the map has a path within `KNOWN_M` of it; else nothing that
is found can be true.

A walk that goes on more than `WRONG_M` from the truth is *wrong*: the phone shows a map that is not
true. The table has the number of each outcome, and the seconds until a place was accepted.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.live_walk import Follower, simulated_walk

WRONG_M = 0.3
KNOWN_M = 3.0
SEEN_AGAIN = 120
"""Multiframes that are pushed after the noise, at most."""


@dataclass(frozen=True)
class Lost:
    """One draw and what became of it."""

    world: str
    mapped: int
    lost: int
    away_m: float
    outcome: str
    waited_s: float
    error_m: float


def main() -> None:
    """Draw, walk, and print the table."""
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("--worlds", nargs="+", default=["office", "staircase", "corridor"])
    options.add_argument("--seeds", type=int, default=2)
    options.add_argument("--draws", type=int, default=6)
    options.add_argument("--seconds", type=float, default=40.0)
    asked = options.parse_args()
    found = []
    for world in asked.worlds:
        for seed in range(1, asked.seeds + 1):
            with tempfile.TemporaryDirectory() as folder:
                walk = simulated_walk(Path(folder), world, seconds=asked.seconds, seed=seed)
                rng = np.random.default_rng(seed)
                for _ in range(asked.draws):
                    mapped = int(rng.integers(30, len(walk.store) - 100))
                    lost = int(rng.choice([6, 15, 40, 80]))
                    found.append(_lost(walk, f"{world}/{seed}", mapped=mapped, lost=lost))
    for known in (True, False):
        rows = [one for one in found if (one.away_m < KNOWN_M) == known]
        count = {name: sum(r.outcome == name for r in rows) for name in ("found", "lost", "wrong")}
        waited = [r.waited_s for r in rows if r.outcome == "found"]
        print(
            "known place" if known else "place not in the map",
            count,
            f"median wait {np.median(waited) if waited else np.nan:.1f} s",
        )


def _lost(walk, world, *, mapped, lost) -> Lost:
    follower = Follower(walk)
    for row in range(mapped):
        follower.push(row)
    path = np.array([walk.at(row).t for row in range(mapped)])
    for row in range(mapped, mapped + lost):
        follower.push(row, noise=True)
    again = min(mapped + lost, len(walk.store) - 1)
    away_m = float(np.linalg.norm(path - walk.at(again).t, axis=1).min())
    errors, waited = [], 0
    resets = follower.map.snapshot().messages()[1].generation
    for row in range(again, min(again + SEEN_AGAIN, len(walk.store))):
        pose, off_m = follower.push(row)
        if pose.lost:
            waited += not errors
        else:
            errors.append(off_m)
    error_m = max(errors, default=np.nan)
    if follower.map.snapshot().messages()[1].generation != resets:
        errors = []  # another map has begun, and the page said so
    outcome = "lost" if not errors else "wrong" if error_m > WRONG_M else "found"
    one = Lost(world, mapped, lost, round(away_m, 1), outcome, round(waited * 0.1, 1), error_m)
    print(one, flush=True)
    return one


if __name__ == "__main__":
    main()
