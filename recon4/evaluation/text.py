"""Text tables of an evaluation for a terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import degrees
from typing import TYPE_CHECKING

from recon4.evaluation.ate import AbsoluteError, Spread
from recon4.evaluation.density import Density
from recon4.evaluation.floor import ErrorFloor
from recon4.evaluation.kitti import Drift
from recon4.evaluation.relations import RelationErrors
from recon4.evaluation.slices import RelativeError, SliceError
from recon4.evaluation.table import number, percentage, text_table
from recon4.locales.coded import CodedText
from recon4.locales.languages import ENGLISH
from recon4.locales.numbers import localized
from recon4.locales.texts import Shown

if TYPE_CHECKING:
    from recon4.evaluation.evaluate import Evaluation, MapQuality

_CM = 100.0
_DEG = degrees(1.0)


@dataclass(frozen=True, slots=True)
class _Words:
    """Texts and numbers of a language."""

    language: str

    def __call__(self, code: str, /, **values: Shown) -> str:
        return CodedText(f"evaluated-{code}", **values).said(self.language)

    def row(self, codes: str) -> tuple[str, ...]:
        """Several texts, of codes with spaces between them."""
        return tuple(self(code) for code in codes.split())

    def number(self, value: float, digits: int = 2, scale: float = 1.0) -> str:
        """A number for a cell."""
        return localized(number(value, digits, scale), self.language)

    def percentage(self, value: float) -> str:
        """A ratio 0..1 as percent."""
        return localized(percentage(value), self.language)

    def hints(self, hints: Iterable[str]) -> Iterator[str]:
        """What is strange about the files."""
        return (self("warning", hint=hint) for hint in hints)


def evaluation_text(found: Evaluation, language: str = ENGLISH) -> str:
    """All tables of an evaluation."""
    say = _Words(language)
    head = say(
        "head",
        estimate=found.estimate,
        truth=found.truth,
        poses=found.poses,
        covered=say.percentage(found.coverage_ratio),
        duration_s=found.duration_s,
        length_m=found.path_length_m,
    )
    drifts = (_drift_text(drift, say) for drift in found.drift)
    parts = [head, *say.hints(found.hints), _ate_text(found, say), *drifts]
    if found.relative is not None:
        parts.append(_relative_text(found.relative, say))
    if found.relative is not None and found.measured is not None:
        parts.append(_surfaces_text(found.relative, found.measured, say))
    if found.floor is not None:
        parts.append(_floor_text(found.floor, say))
    if found.quality is not None:
        parts.append(_quality_text(found.quality, say))
    return "\n\n".join(parts)


def _quality_text(quality: MapQuality, say: _Words) -> str:
    density, sharp = quality.density, quality.sharpness
    lines = (
        say(
            "density",
            median=say.number(density.median_per_cm2),
            low=say.number(density.low_per_cm2),
            high=say.number(density.high_per_cm2),
            radius_m=density.radius_m,
        ),
        say(
            "sharpness",
            entropy=say.number(sharp.entropy, 3),
            thickness_cm=say.number(sharp.plane_thickness_m, 2, _CM),
            radius_m=sharp.radius_m,
            voxel_m=sharp.voxel_m,
            places=sharp.places,
        ),
    )
    return "\n".join(lines)


def relations_text(found: RelationErrors, language: str = ENGLISH) -> str:
    """Errors against reference relations."""
    say = _Words(language)
    shifts = (found.translation_mean_m, found.translation_sd_m, found.translation_largest_m)
    turns = (found.rotation_mean_rad, found.rotation_sd_rad, found.rotation_largest_rad)
    rows = [
        (say("translation"), *(say.number(value, 2, _CM) for value in shifts)),
        (say("rotation"), *(say.number(value, 3, _DEG) for value in turns)),
    ]
    head = say("relations", count=found.relations, outside=found.outside)
    table = text_table(say.row("relative-error mean deviation largest"), rows)
    return "\n".join([head, *say.hints(found.hints), table])


def _ate_text(found: Evaluation, say: _Words) -> str:
    """Absolute errors under the three alignments, in the form of L Table 2."""
    errors = {"svd": found.aligned, "first-pose": found.first_pose, "unaligned": found.unaligned}
    rows = [row for name, error in errors.items() for row in _error_rows(say(name), error, say)]
    table = text_table(say.row("absolute-error rmse mean median least most"), rows)
    return table if found.aligned.determined else f"{table}\n{say('undetermined')}"


def _drift_text(drift: Drift, say: _Words) -> str:
    """One drift metric, one row per length."""
    if not drift.pieces:
        return say("drift-short", metric=drift.metric)
    rows = [
        (
            f"{row.length:g} {drift.unit}",
            str(row.pieces),
            say.number(row.translation, 3, 100.0),
            say.number(row.rotation_rad_m, 4, _DEG),
        )
        for row in drift.rows
        if row.pieces
    ]
    means = say.number(drift.translation, 3, 100.0), say.number(drift.rotation_rad_m, 4, _DEG)
    rows.append((say("all"), str(drift.pieces), *means))
    return text_table((say("drift", metric=drift.metric), say("pieces"), "%", "deg/m"), rows)


def _relative_text(error: RelativeError, say: _Words) -> str:
    """e_r in the form of V Table 3.2."""
    rows = [_slice_row(row, say) for row in error.slices]
    rows.append((say("points-all"), *_slice_row(error.point_weighted, say)[1:]))
    rows.append((say("slices-mean"), "", "", say.number(error.plain_mean_m, 2, _CM), "", ""))
    far = f"> {localized(f'{error.outlier_m:g}', say.language)} m"
    title = say("relative", alignment=error.alignment)
    return text_table((title, say("points"), far, *_within(say)), rows)


def _surfaces_text(delivered: RelativeError, measured: RelativeError, say: _Words) -> str:
    """e_r of the delivered map beside that of the same points where they were measured."""
    pairs = (("fitted", delivered), ("measured", measured))
    rows = [(say(name), *_slice_row(error.point_weighted, say)[1:]) for name, error in pairs]
    return text_table((*say.row("map points far"), *_within(say)), rows)


def _floor_text(floor: ErrorFloor, say: _Words) -> str:
    """e_r of estimated and of true poses from the same points."""
    pairs = (("estimated-poses", floor.estimated), ("true-poses", floor.true))
    rows = [(say(name), *_slice_row(error.point_weighted, say)[1:]) for name, error in pairs]
    header = (say("same-points", frames=floor.frames), *say.row("points far"), *_within(say))
    return f"{text_table(header, rows)}\n{say('ratio', ratio=say.number(floor.ratio, 3))}"


def _within(say: _Words) -> tuple[str, ...]:
    """Titles of the last columns of `_slice_row`."""
    return (say("mean-cm"), "< 2 cm", "< 5 cm")


def density_text(density: Density, language: str = ENGLISH) -> str:
    """Density of a patch."""
    say = _Words(language)
    per_cm2 = say.number(density.points_per_cm2)
    area_m2 = say.number(density.area_m2, 4)
    return say("patch", points=density.points, area_m2=area_m2, per_cm2=per_cm2)


def _error_rows(alignment: str, error: AbsoluteError, say: _Words) -> list[tuple[str, ...]]:
    parts = {
        "position": (error.position_m, _CM),
        "rotation": (error.rotation_rad, _DEG),
        "yaw": (error.yaw_rad, _DEG),
    }
    return [
        (say(f"error-{name}", alignment=alignment), *_spread(spread, scale, say))
        for name, (spread, scale) in parts.items()
    ]


def _spread(spread: Spread, scale: float, say: _Words) -> tuple[str, ...]:
    values = (spread.rmse, spread.mean, spread.median, spread.minimum, spread.maximum)
    return tuple(say.number(value, 3, scale) for value in values)


def _slice_row(row: SliceError, say: _Words) -> tuple[str, ...]:
    return (
        row.name,
        str(row.points),
        str(row.outliers),
        say.number(row.mean_m, 2, _CM),
        say.percentage(row.ratio_within_2cm),
        say.percentage(row.ratio_within_5cm),
    )
