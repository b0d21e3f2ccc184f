"""From the final trajectory to the map: the same stages for rigs of LiDARs and of a profiler."""

from __future__ import annotations

from collections.abc import Callable

from recon4.store.contents import files_of
from recon4.workflows.stages import CLASSES, INTENSITY, MAP
from recon4.workflows.workflow import Run

POSES = ("trajectory.npz",)
"""What `INTENSITY` reads of the stage ``level``."""
SIGHT = (*POSES, "mirrors.npz")
"""What `CLASSES` reads of it."""
PLACE = (*POSES, "uncertainty.npz", "georeference.json")
"""What `MAP` reads of it."""


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
    run.stage(MAP, **points, **run.corrections, **made, level=run.files("level", PLACE))
