"""From the final trajectory to the map: the same stages for rigs of LiDARs and of a profiler."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from recon4.model.figures import ClassFigures, Figures, MapFigures
from recon4.review.decisions import StandingCorrection
from recon4.settings.reads import IntensityReads, MapReads, ReadsNothing
from recon4.store.hashing import hash_json
from recon4.store.input_contents import files_of
from recon4.store.stage import Artifact, Input, Stage, StageContext
from recon4.workflows.workflow import Run

if TYPE_CHECKING:
    from recon4.mapping.carry import CarriedTo
    from recon4.workflows.publish import Results

POSES = ("trajectory.npz",)
"""What `INTENSITY` reads of the stage ``level``."""
SIGHT = (*POSES, "mirrors.npz")
"""What `CLASSES` reads of it."""
PLACE = (*POSES, "uncertainty.npz", "georeference.json")
"""What `MAP` reads of it."""


@dataclass(frozen=True, slots=True)
class UndecidedMap:
    """The map without decisions."""

    made: Path
    """Artifact of the stage ``map``."""
    level: Path
    """Artifact of the stage ``level`` that it was made of; only `POSES` are read of it."""


def make_map(run: Run, to_trajectory: Callable[[Run], None], **measurements: str) -> None:
    """Intensities, classes and map; verdicts that leave the trajectory alone change none of them.

    Args:
        run: Its stage ``level`` is there.
        to_trajectory: Ran the stages up to it.
        measurements: Inputs of a stage that places points, but for the odometry.
    """
    points = measurements | {"odometry": "odometry"}
    seen = run.seen(to_trajectory)
    run.stage(INTENSITY, **points, level=files_of(seen, POSES))
    run.stage(CLASSES, **points, level=files_of(seen, SIGHT))
    made = {"intensity": "intensity", "classes": "classes"}
    given = run.corrections or _undecided(run, seen, to_trajectory, **measurements)
    run.stage(MAP, **points, **given, **made, level=run.files("level", PLACE))


def _undecided(
    run: Run, seen: Artifact, to_trajectory: Callable[[Run], None], **measurements: str
) -> dict[str, Input]:
    """Input of the stage ``map``: the map without decisions, if these hardly move it.

    Where people corrected classes there is none: corrections apply to the places of the map.

    Args:
        run: Its stage ``level`` is there.
        seen: As `Run.seen` found it.
        to_trajectory: See `make_map`.
        measurements: See `make_map`.
    """
    if seen.key == run.runner.runs["level"].artifact.key:
        return {}
    aside = Run(run.runner.aside())
    to_trajectory(aside)
    make_map(aside, to_trajectory, **measurements)
    made = aside.runner.runs["map"].artifact
    key = hash_json([made.key, files_of(seen, POSES).key])
    return {"undecided": Input(key, UndecidedMap(made.folder, seen.folder))}


def map_results() -> Results[Any]:
    """What a finished run leaves in the project folder."""
    from recon4.workflows.map_results import MAP_RESULTS

    return MAP_RESULTS


def _intensity(
    context: StageContext[IntensityReads],
    *,
    frames: Path,
    odometry: Path,
    level: Path,
    calibration: Path | None = None,
) -> None:
    from recon4.intensity.normalize import write_intensity
    from recon4.intensity.tuning import IntensityTuning
    from recon4.settings.tuning import tuned
    from recon4.store.arrays import load_trajectory
    from recon4.store.frames import open_frames

    write_intensity(
        open_frames(frames, calibration, odometry),
        load_trajectory(level / "trajectory.npz"),
        context.out,
        settings=tuned(IntensityTuning, context.settings.intensity),
        progress=context.progress,
    )


def _classes(
    context: StageContext[ReadsNothing],
    *,
    frames: Path,
    odometry: Path,
    level: Path,
    calibration: Path | None = None,
) -> ClassFigures:
    from recon4.classes.class_parts import ClassedWalk, OrderedClasses
    from recon4.classes.stage import classify, write_classes
    from recon4.mapping.mirrors import load_mirrors
    from recon4.orders.confined import workers_of_this_process
    from recon4.store.arrays import load_trajectory
    from recon4.store.frame_folders import FrameFolders

    folders = FrameFolders.of(frames, odometry, calibration)
    walk = ClassedWalk(folders=folders, level=str(level.absolute()))
    found = classify(
        folders.open(),
        load_trajectory(level / "trajectory.npz"),
        mirrors=load_mirrors(level / "mirrors.npz"),
        progress=context.progress,
        ordered=OrderedClasses.of(workers_of_this_process(), walk),
    )
    return write_classes(found, context.out)


def _map(
    context: StageContext[MapReads],
    *,
    level: Path,
    intensity: Path,
    classes: Path,
    corrections: tuple[StandingCorrection, ...] = (),
    undecided: UndecidedMap | None = None,
    **points: Path,
) -> MapFigures:
    from recon4.mapping.build import MapInputs, MapMeans, build_map
    from recon4.mapping.carry import CarriedTo
    from recon4.mapping.tiles import TileSet
    from recon4.orders.confined import workers_of_this_process
    from recon4.sandbox.freed_memory import return_freed_memory
    from recon4.store.arrays import load_intensity_table, load_trajectory
    from recon4.store.classes import StoredClasses
    from recon4.store.frames import open_frames
    from recon4.workflows.corrected_classes import corrections_in
    from recon4.workflows.map_figures import map_figures, write_map_files
    from recon4.workflows.result_files import covariances_of

    store = open_frames(points["frames"], points.get("calibration"), points["odometry"])
    covariances_at = covariances_of(level)
    trajectory = load_trajectory(level / "trajectory.npz")
    covariances = None if covariances_at is None else covariances_at(store.t_mid_ns)
    placed = corrections_in(corrections, trajectory)
    to = CarriedTo(store.rig, trajectory, store.t_mid_ns, covariances)
    bent_ratio = _carried(context, undecided, to) if undecided else None
    if bent_ratio is None:
        inputs = MapInputs(
            store,
            trajectory,
            load_intensity_table(intensity / "table.npz"),
            covariances=covariances,
            classes=StoredClasses.open(classes),
            corrections=placed.volumes,
        )
        build_map(
            inputs,
            context.out,
            settings=context.settings.map,
            progress=context.progress,
            means=MapMeans(workers_of_this_process()),
        )
    return_freed_memory()
    write_map_files(context.out, level, trajectory.T_a_b.t, progress=context.progress)
    return map_figures(TileSet.open(context.out), placed, bent_ratio)


def _carried(
    context: StageContext[MapReads], undecided: UndecidedMap, to: CarriedTo
) -> float | None:
    """Carry the map without decisions along: its `bent_ratio`; None = it has to be made again."""
    from recon4.mapping.carry import carry_map
    from recon4.store.arrays import load_trajectory

    before = load_trajectory(undecided.level / "trajectory.npz")
    return carry_map(undecided.made, before, to, out=context.out, progress=context.progress)


INTENSITY: Stage[IntensityReads, Figures] = Stage(
    "intensity", 2, IntensityReads, _intensity, percent=4.0
)
CLASSES = Stage("classes", 9, ReadsNothing, _classes, ClassFigures, percent=5.0)
MAP = Stage("map", 18, MapReads, _map, MapFigures, percent=21.0)
TO_MAP = (INTENSITY, CLASSES, MAP)
"""The stages that `make_map` runs, in order."""
