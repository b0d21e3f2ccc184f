"""What the odometry tried to assume, in words: for the report and the terminal."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.evaluation.table import number
from recon4.model.tried_hypotheses import TriedHypothesis

COLUMNS = (
    "tried because", "IMU", "points left out", "tracked", "lost", "residual [mm]",
    "fixes contradicted [%]", "moved [cm]", "verdict",
)  # fmt: skip


def tried_rows(tried: Sequence[TriedHypothesis]) -> list[tuple[str, ...]]:
    """A row of words for each hypothesis, in the order of `COLUMNS`; the chosen ones say so."""
    return [_row(one) for one in tried]


def _row(one: TriedHypothesis) -> tuple[str, ...]:
    imu = one.imu or "none recorded"
    span = "whole recording" if one.whole else "windows"
    return (
        str(one.because),
        f"{imu}, corrected" if one.corrected else imu,
        f"{one.hidden_points:,}".replace(",", "\u202f") if one.hidden_points else "",
        f"{span}, {one.multiframes}",
        str(one.lost),
        _scaled(one.residual_m, 1000.0, 1),
        _scaled(one.contradicted, 100.0, 0),
        _scaled(one.moved_m, 100.0, 1),
        f"{one.verdict}; chosen" if one.chosen else str(one.verdict),
    )


def _scaled(value: float | None, factor: float, digits: int) -> str:
    return "" if value is None else number(value, digits, factor)


def tried_lines(tried: Sequence[TriedHypothesis]) -> list[str]:
    """The table as lines of text."""
    table = [COLUMNS, *tried_rows(tried)]
    widths = [max(map(len, column)) for column in zip(*table, strict=True)]
    return [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in table
    ]
