"""Maps of real 2-D logs, with and without odometry and loop closure.

    python -m tests.benchmarks.laser2d [LOG …] [--set slam2d.…=…]

Logs of ``RECON4_DATA/laser2d`` if none is given. Where ``LOG.relations`` lies beside a log the
relative poses are compared with it, without any alignment.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path

from recon4.evaluation.relations import read_relations, relation_errors
from recon4.evaluation.table import number, percentage, text_table
from recon4.evaluation.trajectories import find_trajectory
from recon4.pipeline import process
from recon4.recording.sources import Sources
from recon4.settings import Settings, override
from recon4.workflows.planar_results import Summary2d
from tests.benchmarks.real_sequences import DATA

_VARIANTS = {"": (), "no odometry": ("slam2d.use_odometry=false",)}
_HEADER = (
    "log", "variant", "path m", "scans", "lost", "loops", "translation cm", "rotation °",
    "beams across walls", "verdict", "CPU s", "recorded s",
)  # fmt: skip


def main() -> None:
    """Map each log in each variant and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("logs", nargs="*", type=Path)
    parser.add_argument("--set", action="append", default=[], dest="changes")
    given = parser.parse_args()
    logs = given.logs or sorted((DATA.parent / "laser2d").glob("*.clf.bz2"))
    rows = [
        _row(log, variant, [*changes, *given.changes])
        for log in logs
        for variant, changes in _VARIANTS.items()
    ]
    print(text_table(_HEADER, rows))


def _row(log: Path, variant: str, changes: Sequence[str]) -> list[str]:
    with tempfile.TemporaryDirectory(prefix="recon4-laser2d-") as folder:
        out = Path(folder) / "project"
        summary = process(Sources((log,)), out, settings=override(Settings(), changes))
        assert isinstance(summary, Summary2d)
        translation_m, rotation_rad = _errors(log, out)
    return [
        log.name.partition(".")[0],
        variant,
        number(summary.path_length_m, 0),
        str(summary.scans),
        str(summary.lost),
        str(summary.loops),
        number(translation_m, 2, 100.0),
        number(rotation_rad, 3, 57.29578),
        percentage(summary.grid.crossing_ratio),
        str(summary.verdict.usability),
        number(sum(stage.cpu_seconds for stage in summary.stages), 0),
        number(summary.duration_s, 0),
    ]


def _errors(log: Path, project: Path) -> tuple[float, float]:
    beside = log.with_name(log.name.partition(".")[0] + ".relations")
    if not beside.exists():
        return float("nan"), float("nan")
    errors = relation_errors(find_trajectory(project), read_relations(beside))
    return errors.translation_mean_m, errors.rotation_mean_rad


if __name__ == "__main__":
    main()
