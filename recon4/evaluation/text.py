"""Text tables of an evaluation for a terminal."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING

from recon4.evaluation.ate import AbsoluteError, Spread
from recon4.evaluation.density import Density
from recon4.evaluation.floor import ErrorFloor
from recon4.evaluation.kitti import Drift
from recon4.evaluation.relations import RelationErrors
from recon4.evaluation.slices import RelativeError, SliceError
from recon4.evaluation.table import number, percentage, text_table

if TYPE_CHECKING:
    from recon4.evaluation.evaluate import Evaluation

_CM = 100.0
_DEG = degrees(1.0)


def evaluation_text(found: Evaluation) -> str:
    """All tables of an evaluation."""
    head = (
        f"{found.estimate} against {found.truth}: {found.poses} poses "
        f"({percentage(found.coverage_ratio)} covered by ground truth), "
        f"{found.duration_s:.1f} s, {found.path_length_m:.1f} m"
    )
    hints = [f"Warning: {hint}" for hint in found.hints]
    parts = [head, *hints, ate_text(found), *(drift_text(drift) for drift in found.drift)]
    if found.relative is not None:
        parts.append(relative_text(found.relative))
    if found.relative is not None and found.measured is not None:
        parts.append(surfaces_text(found.relative, found.measured))
    if found.floor is not None:
        parts.append(floor_text(found.floor))
    if found.quality is not None:
        density, sharp = found.quality.density, found.quality.sharpness
        parts.append(
            f"Density: median {number(density.median_per_cm2)} points/cm² "
            f"(10 % of places below {number(density.low_per_cm2)}, "
            f"10 % above {number(density.high_per_cm2)}; radius {density.radius_m:g} m)\n"
            f"Sharpness: mean map entropy {number(sharp.entropy, 3)} nats, "
            f"plane thickness {number(sharp.plane_thickness_m, 2, _CM)} cm "
            f"(radius {sharp.radius_m:g} m, voxel {sharp.voxel_m:g} m, {sharp.places} places)"
        )
    return "\n\n".join(parts)


def relations_text(found: RelationErrors) -> str:
    """Errors against reference relations."""
    rows = [
        (
            "translation [cm]",
            *(
                number(value, 2, _CM)
                for value in (
                    found.translation_mean_m,
                    found.translation_sd_m,
                    found.translation_largest_m,
                )
            ),
        ),
        (
            "rotation [°]",
            *(
                number(value, 3, _DEG)
                for value in (
                    found.rotation_mean_rad,
                    found.rotation_sd_rad,
                    found.rotation_largest_rad,
                )
            ),
        ),
    ]
    head = f"{found.relations} relations compared, {found.outside} outside of the trajectory"
    head = "\n".join([head, *(f"Warning: {hint}" for hint in found.hints)])
    return head + "\n" + text_table(("Relative error", "mean", "deviation", "largest"), rows)


def ate_text(found: Evaluation) -> str:
    """Absolute errors under the three alignments, in the form of L Table 2."""
    rows = []
    for alignment, error in (
        ("SVD-aligned", found.aligned),
        ("first pose", found.first_pose),
        ("not aligned", found.unaligned),
    ):
        rows += _error_rows(alignment, error)
    table = text_table(("Absolute error", "RMSE", "mean", "median", "min", "max"), rows)
    if found.aligned.determined:
        return table
    return (
        table
        + "\n(the positions lie on a line or a point: the rotation of the SVD fit is undetermined)"
    )


def drift_text(drift: Drift) -> str:
    """One drift metric, one row per length."""
    if not drift.pieces:
        return f"Drift, {drift.metric}: the walk is too short"
    rows = [
        (
            f"{row.length:g} {drift.unit}",
            str(row.pieces),
            number(row.translation, 3, 100.0),
            number(row.rotation_rad_m, 4, _DEG),
        )
        for row in drift.rows
        if row.pieces
    ]
    rows.append(
        (
            "all",
            str(drift.pieces),
            number(drift.translation, 3, 100.0),
            number(drift.rotation_rad_m, 4, _DEG),
        )
    )
    return text_table((f"Drift, {drift.metric}", "pieces", "%", "deg/m"), rows)


def relative_text(error: RelativeError) -> str:
    """e_r in the form of V Table 3.2."""
    rows = [_slice_row(row) for row in (*error.slices, error.point_weighted)]
    rows.append(("mean of slices", "", "", number(error.plain_mean_m, 2, _CM), "", ""))
    far = f"> {error.outlier_m:g} m"
    header = (f"e_r (aligned: {error.alignment})", "points", far, "mean cm", "< 2 cm", "< 5 cm")
    return text_table(header, rows)


def surfaces_text(delivered: RelativeError, measured: RelativeError) -> str:
    """e_r of the delivered map beside that of the same points where they were measured."""
    pairs = (("on fitted surfaces", delivered), ("as measured", measured))
    rows = [(name, *_slice_row(error.point_weighted)[1:]) for name, error in pairs]
    return text_table(("Map", "points", "far", "mean cm", "< 2 cm", "< 5 cm"), rows)


def floor_text(floor: ErrorFloor) -> str:
    """e_r of estimated and of true poses from the same points."""
    pairs = (("estimated poses", floor.estimated), ("true poses", floor.true))
    rows = [(name, *_slice_row(error.point_weighted)[1:]) for name, error in pairs]
    header = (
        f"Same points of {floor.frames} frames",
        "points",
        "far",
        "mean cm",
        "< 2 cm",
        "< 5 cm",
    )
    return text_table(header, rows) + f"\nratio {number(floor.ratio, 3)}"


def density_text(density: Density) -> str:
    """Density of a patch."""
    return (
        f"Patch: {density.points} points on {density.area_m2:.4f} m², "
        f"{number(density.points_per_cm2)} points/cm²"
    )


def _error_rows(alignment: str, error: AbsoluteError) -> list[tuple[str, ...]]:
    return [
        (f"{alignment}: position [cm]", *_spread(error.position_m, _CM)),
        (f"{alignment}: rotation [deg]", *_spread(error.rotation_rad, _DEG)),
        (f"{alignment}: yaw only [deg]", *_spread(error.yaw_rad, _DEG)),
    ]


def _spread(spread: Spread, scale: float) -> tuple[str, ...]:
    values = (spread.rmse, spread.mean, spread.median, spread.minimum, spread.maximum)
    return tuple(number(value, 3, scale) for value in values)


def _slice_row(row: SliceError) -> tuple[str, ...]:
    return (
        row.name,
        str(row.points),
        str(row.outliers),
        number(row.mean_m, 2, _CM),
        percentage(row.ratio_within_2cm),
        percentage(row.ratio_within_5cm),
    )
