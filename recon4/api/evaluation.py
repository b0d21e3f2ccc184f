"""Figures of a result against ground truth."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from recon4.cli.kernel_cache import settle_kernel_cache
from recon4.errors import ConfigError
from recon4.locales.coded import CodedText

if TYPE_CHECKING:
    from recon4.evaluation.evaluate import Evaluation, MapChunks
    from recon4.evaluation.reference_mesh import TriangleMesh
    from recon4.geometry.se3 import Array
    from recon4.mapping.tiles import TileSet


def evaluate(
    result: str | PathLike[str],
    truth: str | PathLike[str],
    *,
    model: str | PathLike[str] | None = None,
    unit: str = "",
    true_poses: bool = False,
) -> Evaluation:
    """Compare a result with ground truth, as ``recon4 evaluate`` does.

    Args:
        result: A project, or a trajectory as ``.tum`` or ``.npz``.
        truth: True trajectory as ``.tum`` or ``.npz``, at any rate, in any frame.
        model: True surfaces as a triangle mesh (``.ply``) in the frame of ``truth``; with a
            project this gives e_r, the distance of the map to them.
        unit: Of ``model``; empty = meters, which is checked.
        true_poses: With ``model``, also e_r of the same points at the true poses.

    Returns:
        ``aligned.position_m.rmse`` is the ATE [m]; ``table()`` shows all figures.

    Raises:
        ConfigError: If ``true_poses`` is set without a project, or the unit is in doubt.
        OutOfRange: If the truth covers fewer than two poses.
        Recon4Error: If a file cannot be read.

    >>> found = api.evaluate("walk", "recording/truth.tum")
    >>> found.aligned.position_m.rmse < 0.05
    True
    """
    settle_kernel_cache()
    from recon4.evaluation.evaluate import evaluate as evaluate_result
    from recon4.mapping.tiles import TileSet
    from recon4.store.frames import open_frames
    from recon4.store.project import is_project, read_artifacts

    root = Path(result)
    artifacts = read_artifacts(root) if is_project(root) else {}
    tiles = TileSet.open(artifacts["map"]) if "map" in artifacts else None
    if true_poses and "frames" not in artifacts:
        raise ConfigError(CodedText("true-poses-project", root=str(root)))
    return evaluate_result(
        root,
        truth=Path(truth),
        model=_mesh(Path(model), unit, tiles) if model else None,
        chunks=_chunks(tiles) if tiles else None,
        frames=(
            open_frames(artifacts["frames"], artifacts.get("calibration")) if true_poses else None
        ),
    )


def _mesh(path: Path, unit: str, tiles: TileSet | None) -> TriangleMesh:
    """The model in meters.

    Raises:
        ConfigError: If the unit is unknown, or none is given and the model is far larger than the
            map.
    """
    from recon4.evaluation.reference_mesh import TriangleMesh, read_mesh
    from recon4.recording.tables.column_names import UNITS_M
    from recon4.slices.reference_placement import check_extent

    chosen = next((known for known in UNITS_M if known == unit), None)
    if unit and chosen is None:
        raise ConfigError(CodedText("unit-unknown", units_m=", ".join(UNITS_M), unit=unit[:40]))
    mesh = read_mesh(path)
    if chosen:
        return TriangleMesh(mesh.vertices_m * UNITS_M[chosen], mesh.triangles)
    check_extent(mesh.bounds(), tiles.bounds_m if tiles else None, certain=False)
    return mesh


def _chunks(tiles: TileSet) -> MapChunks:
    """The points of a map, and the same where they were measured if it has fitted surfaces."""
    from recon4.evaluation.evaluate import MapChunks

    def points(of: TileSet) -> Iterator[Array]:
        return (tile.xyz_m() for tile in of)

    if tiles.surface == "raw":
        return MapChunks(lambda: points(tiles))
    measured = tiles.as_measured()
    return MapChunks(lambda: points(tiles), lambda: points(measured))
