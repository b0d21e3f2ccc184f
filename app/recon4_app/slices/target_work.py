"""Work of naming survey targets of a map, in child processes."""

from __future__ import annotations

from recon4.slices.control_points import ControlPoint
from recon4.slices.targets.named import TargetList, named
from recon4_app.slices.model import ControlState


def name_targets(found: TargetList, state: ControlState, crs: str) -> TargetList:
    """The targets with the names of the survey, if there is one.

    Raises:
        GeoreferenceError: If PROJ does not know the system, or the points are not in it.
    """
    points = [ControlPoint(**point.model_dump()) for point in state.points]
    return named(found, points, crs=crs)
