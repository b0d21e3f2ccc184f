"""Reads trajectories to evaluate: ``.tum``, ``.npz`` or a project folder."""

from __future__ import annotations

from pathlib import Path

from recon4.errors import UnknownFormat
from recon4.locales.coded import CodedText
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.poses import read_tum, tum_hint
from recon4.recording.report import ImportReport
from recon4.store.arrays import load_trajectory


def find_trajectory(path: Path, report: ImportReport | None = None) -> Trajectory:
    """The trajectory at a path: a file, or ``trajectory.tum`` of a project folder.

    Args:
        path: The file or the folder.
        report: Gets the counts of poses and damaged lines of a text file; None = not wanted.

    Raises:
        UnknownFormat: If there is none, or the ending is neither ``.tum``, ``.txt`` nor ``.npz``.
        CorruptFile: If too many lines are damaged, naming the first.
        EmptyRecording: If the file holds no pose.
    """
    file = path / "trajectory.tum" if path.is_dir() else path
    if not file.is_file():
        raise UnknownFormat(CodedText("trajectory-none", file=path.name))
    if file.suffix == ".npz":
        return load_trajectory(file)
    if file.suffix in {".tum", ".txt"}:
        return read_tum(file, report)
    raise UnknownFormat(CodedText("trajectory-endings", file=file.name))


def trajectory_with_hints(path: Path) -> tuple[Trajectory, tuple[str, ...]]:
    """A trajectory, and what the reader of the figures must know of its file."""
    report = ImportReport()
    walk = find_trajectory(path, report)
    hints = [*report.lost(), tum_hint(walk)]
    return walk, tuple(f"{path.name}: {hint}" for hint in hints if hint)
