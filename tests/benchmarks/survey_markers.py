"""Absolute accuracy at survey markers (requirements A10, V Table 3.3).

    python -m tests.benchmarks.survey_markers PROJECT RECORDING

PROJECT is what ``recon4 process`` made of the simulated RECORDING. Each marker is found in the map
as a person would: by its brightness near where it should be; its center is that of the bright
points, and is compared with the true coordinates.
"""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import numpy as np

from recon4.georeference.crs import GeodeticOrigin, to_enu
from recon4.mapping.tiles import TileSet
from recon4.store.project import read_artifacts

SEARCH_M = 1.0
BRIGHT = 100.0
"""Normalized intensity above which only retro-reflective paint lies."""
FEWEST = 40
"""A plate with fewer points has no edges to be measured between."""


def true_positions(markers: Path, origin: GeodeticOrigin) -> dict[str, np.ndarray]:
    """Markers in the map frame of the result, from their latitudes and longitudes."""
    with markers.open(newline="") as file:
        rows = list(csv.DictReader(file))
    geodetic = np.array(
        [[float(r["lat_deg"]), float(r["lon_deg"]), float(r["height_m"])] for r in rows]
    )
    p = to_enu(origin, *np.deg2rad(geodetic[:, :2]).T, ellipsoidal_height_m=geodetic[:, 2])
    return {row["id"]: p[k] for k, row in enumerate(rows)}


def find_bright(tiles: TileSet, near: np.ndarray) -> tuple[np.ndarray, int]:
    """Middle of the bright plate around a place [m], and how many points it has.

    The middle between its edges, not the mean: passing by, one side gets more points.
    """
    found, bright = [np.empty((0, 3))], [np.empty(0)]
    for tile in tiles:
        p = tile.xyz_m()
        inside = np.linalg.norm(p - near, axis=1) < SEARCH_M
        found.append(p[inside])
        bright.append(tile.read(["intensity_normalized"])["intensity_normalized"][inside])
    p, value = np.concatenate(found), np.concatenate(bright)
    p = p[value > BRIGHT]
    if len(p) < FEWEST:
        return np.full(3, np.nan), len(p)
    low, high = np.quantile(p, [0.03, 0.97], axis=0)
    return np.append(0.5 * (low + high)[:2], np.median(p[:, 2])), len(p)


def main(project: Path, recording: Path) -> None:
    artifacts = read_artifacts(project)
    facts = json.loads((artifacts["level"] / "georeference.json").read_text())
    o = facts["georeference"]["origin"]
    origin = GeodeticOrigin(np.deg2rad(o["lat_deg"]), np.deg2rad(o["lon_deg"]), o["height_m"])
    tiles = TileSet.open(artifacts["map"])
    rows = []
    for name, true in true_positions(recording / "markers.csv", origin).items():
        found, count = find_bright(tiles, true)
        d = found - true
        if not np.isfinite(d).all():
            print(f"{name}: {count} bright points, too few")
            continue
        rows.append(d)
        east, north, up = d * 100
        print(f"{name}: dE {east:6.1f}  dN {north:6.1f}  dU {up:6.1f} cm  {count} points")
    d = 100 * np.array(rows)
    horizontal, vertical = np.linalg.norm(d[:, :2], axis=1), np.abs(d[:, 2])
    print(f"{len(d)} markers, cm")
    print(f"horizontal mean {horizontal.mean():.1f} max {horizontal.max():.1f}")
    print(f"height     mean {vertical.mean():.1f} max {vertical.max():.1f}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
