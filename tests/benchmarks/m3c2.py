"""Our M3C2 beside that of py4dgeo, on a part of two real maps.

    python -m tests.benchmarks.m3c2 FIRST SECOND [--box X1,Y1,Z1,X2,Y2,Z2] [--spacing 0.1]

FIRST and SECOND as for ``recon4 compare``, in one frame. py4dgeo is no dependency: install it
beside, ``pip install py4dgeo``. Both are given the same points without normals, cylinders without
layers, and the registration uncertainty 0, so that both compute the equations of the paper.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

import numpy as np

from recon4.comparison.common_frame import open_side
from recon4.comparison.m3c2 import differences
from recon4.comparison.records import CoreState, M3C2Scales
from recon4.geometry.se3 import SE3
from tests.unit.slices.room_map import write_map

PARTS = (0.5, 0.95, 0.99, 1.0)


def points_in(folder, low, high):
    """Points of a map where they were measured, in a box [m], (N, 3)."""
    tiles = open_side(folder).tiles.as_measured()
    found = []
    for tile in tiles:
        if np.all(np.array(tile.low_m) < high) and np.all(np.array(tile.high_m) > low):
            p = tile.xyz_m()
            found.append(p[np.all((p >= low) & (p <= high), axis=1)])
    return np.concatenate(found)


def ours(a, b, scales):
    """Core points, normals, distances, levels of detection, and CPU seconds."""
    with tempfile.TemporaryDirectory() as scratch:
        first, second = (write_map(Path(scratch) / name, p) for name, p in (("a", a), ("b", b)))
        list(differences(first, first, SE3.identity(), scales=scales))  # compiles
        began = time.process_time()
        parts = list(differences(first, second, SE3.identity(), scales=scales))
        took = time.process_time() - began
    names = "p_map", "normal", "distance_m", "lod_m", "state", "points"
    return {k: np.concatenate([getattr(one, k) for one in parts]) for k in names}, took


def theirs(a, b, core, scales):
    """Distances, levels of detection, and CPU seconds of py4dgeo."""
    import py4dgeo

    began = time.process_time()
    algorithm = py4dgeo.M3C2(
        epochs=(py4dgeo.Epoch(a), py4dgeo.Epoch(b)),
        corepoints=core,
        cyl_radius=scales.cylinder_m / 2.0,
        normal_radii=(scales.normal_m / 2.0,),
        max_distance=scales.depth_m,
        registration_error=0.0,
    )
    distance, uncertainty = algorithm.run()
    took = time.process_time() - began
    return distance, uncertainty["lodetection"], algorithm.directions(), took


def main():
    """Print how far the two are apart."""
    parser = argparse.ArgumentParser()
    parser.add_argument("first", type=Path)
    parser.add_argument("second", type=Path)
    parser.add_argument("--box", default="0,0,-1,6,6,2")
    parser.add_argument("--spacing", type=float, default=0.1)
    asked = parser.parse_args()
    low, high = np.array([float(x) for x in asked.box.split(",")]).reshape(2, 3)
    a, b = (points_in(folder, low, high) for folder in (asked.first, asked.second))
    scales = M3C2Scales(core_spacing_m=asked.spacing, layer_m=M3C2Scales().depth_m)
    found, took = ours(a, b, scales)
    core = found["p_map"]
    distance, lod, directions, other_took = theirs(a, b, core, scales)
    print(f"{len(a)} and {len(b)} points, {len(core)} core points")
    known = found["state"] <= CoreState.SIGNIFICANT
    print(f"with a distance: ours {known.sum()}, py4dgeo {np.isfinite(distance).sum()}")
    both = known & np.isfinite(distance) & np.isfinite(lod)
    n = found["normal"][both]
    along = np.einsum("ni,ni->n", n, directions[both])
    apart_deg = np.rad2deg(np.arccos(np.clip(np.abs(along), 0.0, 1.0)))
    offs = {
        "normals [deg]": apart_deg,
        "distances [mm]": 1e3 * np.abs(found["distance_m"][both] - np.sign(along) * distance[both]),
        "levels [mm]": 1e3 * np.abs(found["lod_m"][both] - lod[both]),
    }
    print("quantile       " + "".join(f"{100 * part:10.0f} %" for part in PARTS))
    for name, off in offs.items():
        print(f"{name:15}" + "".join(f"{value:12.4f}" for value in np.quantile(off, PARTS)))
    print(f"CPU: ours {took:.2f} s, py4dgeo {other_took:.2f} s")


if __name__ == "__main__":
    main()
