"""The Python interface of recon4: the names that other programs may build on.

    from recon4 import api

    project = api.process("walk.pcap", "walk")
    print(project.summary.verdict, project.summary.path_length_m)

**Stability.** The names in `__all__`, their parameters and the documented attributes of what they
return follow semantic versioning. A change that breaks a program raises the first number of the
version (while that is 0, the second), and stands in the list of changes. Everything else in
`recon4` may change with any version. Files of finished projects stay readable.

**Conventions.** Paths are ``str`` or ``Path``. Lengths are meters, angles radians, times integer
nanoseconds; ``T_a_b`` maps points of frame ``b`` into frame ``a``. Every failure that a caller can
do something about is an `errors.Recon4Error`.

Importing this module loads nothing else, not even numpy; each name loads what it needs when it is
first used. The examples in the docstrings run as tests, in a folder with a recording of a few
seconds (``recording/``) and the project made of it (``walk/``).
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from recon4 import errors

if TYPE_CHECKING:
    from recon4.api.evaluation import evaluate
    from recon4.api.maps import read_tiles
    from recon4.api.project import MapFinding, MapProject, open_project
    from recon4.api.running import process
    from recon4.api.simulation import simulate
    from recon4.api.slices import cut_slice, write_slice
    from recon4.model.pose_graph import PoseGraph
    from recon4.model.rig import load_rig
    from recon4.model.trajectory import Trajectory
    from recon4.recording.sources import Sources
    from recon4.slices.slice_plane import SlicePlane

_HOMES = {
    "MapFinding": "recon4.api.project",
    "MapProject": "recon4.api.project",
    "PoseGraph": "recon4.model.pose_graph",
    "SlicePlane": "recon4.slices.slice_plane",
    "Sources": "recon4.recording.sources",
    "Trajectory": "recon4.model.trajectory",
    "cut_slice": "recon4.api.slices",
    "evaluate": "recon4.api.evaluation",
    "load_rig": "recon4.model.rig",
    "open_project": "recon4.api.project",
    "process": "recon4.api.running",
    "read_tiles": "recon4.api.maps",
    "simulate": "recon4.api.simulation",
    "write_slice": "recon4.api.slices",
}
"""Name -> the module it is loaded from."""

__all__ = [
    "MapFinding",
    "MapProject",
    "PoseGraph",
    "SlicePlane",
    "Sources",
    "Trajectory",
    "cut_slice",
    "errors",
    "evaluate",
    "load_rig",
    "open_project",
    "process",
    "read_tiles",
    "simulate",
    "write_slice",
]


if not TYPE_CHECKING:  # else type checkers take any name for one of the module

    def __getattr__(name: str) -> object:
        """Load a name when it is first used (PEP 562)."""
        if name not in _HOMES:
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        found: object = getattr(import_module(_HOMES[name]), name)
        globals()[name] = found
        return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
