"""Which workflow a recording or a project has."""

from __future__ import annotations

from collections.abc import Container
from pathlib import Path

from recon4.errors import ConfigError
from recon4.locales.coded import CodedText
from recon4.model.rig import format_rig, load_rig
from recon4.progress import Progress
from recon4.recording.lasers.laser2d import is_laser2d
from recon4.recording.lasers.line_tables import is_line_table
from recon4.recording.sources import Sources
from recon4.store.hashing import hash_json
from recon4.store.inputs import input_file, input_files
from recon4.store.ledger import Ledger
from recon4.store.stage import Input
from recon4.workflows.lidar import LIDAR
from recon4.workflows.planar import PLANAR, laser_input
from recon4.workflows.profiler import PROFILER
from recon4.workflows.workflow import Workflow


def is_planar(sources: Sources) -> bool:
    """Whether recordings are of a 2-D laser alone.

    Raises:
        RecordingError: If it cannot be read.
    """
    if sources.rig is not None and sources.rig.row_of("profiler") is not None:
        return False  # only the rig file may know which topic is of the profiler
    first, *others = sources.recordings
    # The tables of a walk with a profiler may come in any order.
    return is_laser2d(first, rig=sources.rig) and not any(map(is_line_table, others))


def check_planar(sources: Sources) -> None:
    """Check that a 2-D laser comes without what its workflow cannot use.

    Raises:
        ConfigError: If a rig of other sensors or CSV files are given.
    """
    rig = sources.rig
    if rig is not None and all(sensor.kind == "laser2d" for sensor in rig.sensors):
        rig = None  # it says how the laser is mounted, and its port in a live capture
    given = {"a rig": rig, "IMU samples": sources.imu, "GNSS samples": sources.gnss}
    unused = [name for name, value in given.items() if value is not None]
    if unused:
        raise ConfigError(
            CodedText(
                "laser-unused", recordings=sources.recordings[0].name, unused=" and ".join(unused)
            )
        )


def import_inputs(
    sources: Sources, ledger: Ledger, progress: Progress, *, planar: bool
) -> dict[str, Input | None]:
    """Inputs of the stage that reads the recording.

    Args:
        sources: The recordings of one walk, its rig, and CSV files in place of their samples.
        ledger: Knows the hashes of files that did not change.
        progress: Counts bytes that are hashed.
        planar: Whether it is of a 2-D laser alone.
    """
    recordings = input_files(sources.recordings, ledger, progress)
    if planar:
        return {"recordings": recordings, "laser": laser_input(sources.rig)}
    rig, imu, gnss = sources.rig, sources.imu, sources.gnss
    return {
        "recordings": recordings,
        "rig": Input(hash_json(format_rig(rig)), rig) if rig else None,
        "imu": Input(input_file(imu, ledger, progress).key, imu) if imu else None,
        "gnss": Input(input_file(gnss, ledger, progress).key, gnss) if gnss else None,
    }


def of_frames(frames: Path) -> Workflow:
    """The workflow of multiframes: the rig that made them decides.

    Args:
        frames: Folder of the stage ``frames``.
    """
    return LIDAR if load_rig(frames / "rig.toml").row_of("profiler") is None else PROFILER


def of_project(made: dict[str, Path]) -> Workflow:
    """The workflow of a project.

    Args:
        made: Stage -> folder of its artifact; without an import its runner refuses to go on.
    """
    if PLANAR.imports.name in made:
        return PLANAR
    frames = made.get(LIDAR.imports.name)
    return of_frames(frames) if frames is not None else LIDAR


def has_map(made: Container[str]) -> bool:
    """Whether a project was processed to its end."""
    return "map" in made or "map_2d" in made
