"""Distance of all delivered points of a map to the true surfaces, outliers included.

    python -m tests.benchmarks.delivered WALK RECORDING [WALK RECORDING ...]

WALK is a project of ``recon4 process``, RECORDING the folder of ``recon4 simulate`` with its truth.
The map is laid on the true model by the fit of its trajectory, then by ICP, as by
``recon4 evaluate``.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from recon4.evaluation.ate import AbsoluteError, absolute_error, pair_poses
from recon4.evaluation.evaluate import at_frames
from recon4.evaluation.floor import map_onto_model
from recon4.evaluation.reference_mesh import TriangleMesh, distance_to, read_mesh
from recon4.evaluation.table import text_table
from recon4.geometry.se3 import SE3, Array
from recon4.mapping.tiles import TileSet
from recon4.recording.formats.poses import read_tum
from recon4.store.project import read_artifacts

FAR_M = 0.5
EVERY = 20
HEAD = ("walk", "points", "mean cm", "median cm", "95 % cm", "> 50 cm %")


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folders", nargs="+", type=Path)
    folders = parser.parse_args().folders
    print(text_table(HEAD, [row_of(*folders[k : k + 2]) for k in range(0, len(folders), 2)]))


def row_of(walk: Path, recording: Path) -> tuple[str, ...]:
    """Figures of a walk; median and 95 % of every 20th point."""
    tiles = TileSet.open(read_artifacts(walk)["map"])
    mesh = read_mesh(recording / "model.ply")
    T, _ = onto_truth(tiles, mesh, walk, recording)
    distance = distance_to(mesh)
    total, far, some = 0.0, 0, list[Array]()
    for p_map in _chunks(tiles):
        off_m = np.abs(distance(T @ p_map))
        total, far = total + float(off_m.sum()), far + int((off_m > FAR_M).sum())
        some.append(off_m[::EVERY])
    off_m = 100.0 * np.concatenate(some)
    median, most = np.quantile(off_m, (0.5, 0.95))
    return (
        walk.name,
        str(len(tiles)),
        f"{100.0 * total / len(tiles):.3f}",
        f"{median:.3f}",
        f"{most:.3f}",
        f"{100.0 * far / len(tiles):.4f}",
    )


def onto_truth(
    tiles: TileSet, mesh: TriangleMesh, walk: Path, recording: Path
) -> tuple[SE3, AbsoluteError]:
    """The map laid on the true model, and the error of its trajectory after its own fit."""
    found, true = read_tum(walk / "trajectory.tum"), read_tum(recording / "truth.tum")
    error = absolute_error(pair_poses(at_frames(found), true))
    rng = np.random.default_rng(0)
    return map_onto_model(_chunks(tiles), mesh, start=error.T_true_map, rng=rng), error


def _chunks(tiles: TileSet) -> Iterator[Array]:
    return (tile.xyz_m() for tile in tiles)


if __name__ == "__main__":
    main()
