"""Add a finding of your own: a check of the results beside those of recon4.

This one asks for a slow walk, and names the stretches that were faster with their time and place.
The exit code is 1 if the map must not be used. A check that belongs to every map is better placed
in recon4 itself: a witness in `recon4/findings/witnesses/`, its code and its text in the catalog.
"""

from collections.abc import Iterator

import numpy as np

from recon4 import api

MOST_M_S = 1.2
STEP_NS = 500_000_000


def too_fast(walk: api.Trajectory) -> Iterator[str]:
    """A sentence for each stretch of the walk that was faster than `MOST_M_S`."""
    t_ns = np.arange(walk.t_ns[0], walk.t_ns[-1], STEP_NS)
    places_m = walk.at(t_ns).t
    speed_m_s = np.linalg.norm(np.diff(places_m, axis=0), axis=1) / (STEP_NS / 1e9)
    fast = np.concatenate([[False], speed_m_s > MOST_M_S, [False]])
    begins, ends = np.flatnonzero(np.diff(fast)).reshape(-1, 2).T
    for begin, end in zip(begins, ends, strict=True):
        start_s, end_s = (t_ns[[begin, end]] - walk.t_ns[0]) / 1e9
        x, y, _ = places_m[begin]
        most = speed_m_s[begin:end].max()
        yield f"{start_s:.1f}-{end_s:.1f} s, from x {x:.1f} y {y:.1f} m: up to {most:.1f} m/s"


def main() -> None:
    """Print the findings of recon4 that need a look, and our own."""
    project = api.open_project("walk")
    reasons = [f"{one.kind}: {one.text} {one.remedy}" for one in project.findings if one.is_reason]
    own = [f"FAST-WALK: {text}" for text in too_fast(project.trajectory)]
    print(f"verdict: {project.summary.verdict.usability}", *reasons, *own, sep="\n  ")
    if project.summary.verdict.usability == "do not use":
        raise SystemExit(1)


if __name__ == "__main__":
    main()
