"""Fitted surfaces on real sequences: thickness of planar surfaces before and after.

    python -m tests.benchmarks.surfaces_real [corridor] [muehlburg] [nclt] [--images FOLDER]

``nclt`` is placed by its true poses, the others by `Odometry` without refinement. Images are
horizontal slices of 10 cm, as measured on the left and fitted on the right.
"""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.evaluation.table import number, text_table
from recon4.evaluation.thickness import plane_thickness
from recon4.evaluation.tuning import THICKNESS
from recon4.geometry.cubes import cube_keys, cubes_of
from recon4.geometry.se3 import SE3
from recon4.mapping.build import MapInputs, build_map
from recon4.mapping.tiles import TileSet
from recon4.model.figures import PlaneThickness
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.trajectory import Trajectory
from recon4.registration.odometry import Odometry
from recon4.settings import MapSettings, Settings
from recon4.slices.points import SliceWindow
from recon4.slices.slice_image import RasterGrid, draw, png
from recon4.slices.slice_plane import SlicePlane
from tests.benchmarks.loaders import muehlburg, nclt, nclt_truth, one_sensor, store
from tests.benchmarks.real_sequences import DATA, corridor

_KEPT_NS = 500_000_000
"""Time between the multiframes of the corridor: 1.2 m/s."""
_SCANS = 150
"""Multiframes used of the long sequences."""
_LEAST = 15
"""Points of a cube that is tested for a plane."""


@dataclass(frozen=True, slots=True, eq=False)
class Sequence:
    """Multiframes with poses."""

    frames: list[Multiframe]
    rig: Rig
    trajectory: Trajectory


def main() -> None:
    """Run the requested sequences, by default all."""
    parser = argparse.ArgumentParser()
    parser.add_argument("names", nargs="*", default=["corridor", "muehlburg", "nclt"])
    parser.add_argument("--images", type=Path)
    a = parser.parse_args()
    rows = []
    for name in a.names:
        with tempfile.TemporaryDirectory() as folder:
            tiles = fitted(loaded(name), Path(folder))
            measured = plane_thickness(tiles.as_measured())
            now = plane_thickness(tiles)
            rows += [_row(name, "as measured", measured), _row("", "fitted", now)]
            print(f"{name}: {same_places(tiles)}", flush=True)
            if a.images:
                (a.images / f"surfaces_{name}.png").write_bytes(slice_pair(tiles))
    head = ("sequence", "points", "p50 mm", "p95 mm", "planar places %")
    print(text_table(head, rows))


def loaded(name: str) -> Sequence:
    """A sequence by its name."""
    if name == "nclt":
        frames = list(nclt(DATA / "nclt-hdl32"))[:_SCANS]
        return Sequence(frames, one_sensor("HDL-32E"), nclt_truth(DATA / "nclt-hdl32"))
    if name == "corridor":
        # Kept every 0.58 m of a walk, without times: at 10 Hz nobody walks as fast.
        kept = corridor(DATA / "vlp16-corridor")
        frames = [replace(frame, t_ns=_KEPT_NS * k) for k, frame in enumerate(kept)]
        rig = one_sensor("VLP-16")
    else:
        frames = list(muehlburg(DATA / "hdl64-muehlburg"))[:_SCANS]
        rig = one_sensor("HDL-64E")
    odometry = Odometry(rig, Settings(), None)
    steps = [odometry.push(frame) for frame in frames]
    t_ns = np.array([step.t_mid_ns for step in steps], np.int64)
    return Sequence(frames, rig, Trajectory(t_ns, SE3.stack(step.T_odom_body for step in steps)))


def fitted(sequence: Sequence, folder: Path) -> TileSet:
    """The map with fitted surfaces, which holds the points as measured too."""
    (folder / "map").mkdir()
    frames = store(sequence.frames, sequence.rig, folder / "frames")
    settings = replace(MapSettings(), surface="fitted")
    return build_map(MapInputs(frames, sequence.trajectory), folder / "map", settings=settings)


def same_places(tiles: TileSet) -> str:
    """Thickness of the cubes that are planar as measured, before and after."""
    fitted_m = np.concatenate([tile.xyz_m() for tile in tiles])
    measured_m = np.concatenate([tile.xyz_m() for tile in tiles.as_measured()])
    key = cube_keys(cubes_of(measured_m, THICKNESS.cell_m))
    order = np.argsort(key, kind="stable")
    found = []
    for rows in np.split(order, np.flatnonzero(np.diff(key[order])) + 1):
        if len(rows) < _LEAST:
            continue
        a, b, c = np.linalg.eigvalsh(np.cov(measured_m[rows].T))
        if a < 0.1 * b and b > 0.1 * c:
            least = np.linalg.eigvalsh(np.cov(fitted_m[rows].T))[0]
            found.append((np.sqrt(a), np.sqrt(max(least, 0.0))))
    before, after = 1e3 * np.median(np.array(found), axis=0)
    return f"{len(found)} places planar as measured: p50 {before:.1f} mm, fitted {after:.1f} mm"


def slice_pair(tiles: TileSet, *, side_m: float = 5.0, pixels: int = 420) -> bytes:
    """A square of a slice where most vertical surfaces are, as measured and fitted."""
    p = np.concatenate([tile.xyz_m(limit=2000) for tile in tiles])
    normal = np.concatenate([tile.read(["normal"], limit=2000)["normal"] for tile in tiles])
    walls = p[(np.abs(normal[:, 2]) < 0.2) & (np.abs(normal).max(axis=1) > 0.1)]
    z_m = float(np.median(walls[:, 2]))
    cell = np.floor(walls[:, :2] / side_m).astype(np.int64)
    cells, count = np.unique(cell, axis=0, return_counts=True)
    left, bottom = cells[np.argmax(count)] * side_m
    window = SliceWindow(left, bottom, left + side_m, bottom + side_m)
    grid = RasterGrid(window, side_m / pixels)
    images = []
    for shown in (tiles.as_measured(), tiles):
        made = draw(shown, SlicePlane.horizontal(z_m, thickness_m=0.1), grid)
        images.append(made.rgba(made.span, "light"))
    gap = np.zeros((images[0].shape[0], 12, 4), np.uint8)
    return png(np.concatenate([images[0], gap, images[1]], axis=1))


def _row(name: str, points: str, found: PlaneThickness) -> tuple[str, ...]:
    p50, p95, planar = (
        number(value if value is not None else float("nan"), 1, scale)
        for value, scale in (
            (found.p50_m, 1e3),
            (found.p95_m, 1e3),
            (found.planar_coverage, 100.0),
        )
    )
    return name, points, p50, p95, planar


if __name__ == "__main__":
    main()
