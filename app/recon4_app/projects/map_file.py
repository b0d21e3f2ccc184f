"""The map of a project as a file of another format, made in a child process of the compute pool."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Literal

from recon4.review.evidence import Evidence
from recon4_app.slices.model import Strict

MapEnding = Literal["copc.laz", "laz", "e57", "ply", "pcd", "xyz"]


class MapFileQuery(Strict):
    """What of the map is written."""

    crs: str = ""
    """Code of a CRS, as EPSG:25832; empty = that of the map, or its local frame."""
    raw: bool = False
    """Points where they were measured, not on their surfaces."""
    all_points: bool = False
    """Also those that the map leaves out, by class: the carrier, what moves, noise; not as E57."""
    draft: bool = False
    """Without an approval, whether or not there is one."""


@dataclass(frozen=True, slots=True, kw_only=True)
class MapFileRequest:
    """Everything that determines the bytes of the file."""

    ending: MapEnding
    query: MapFileQuery
    artifacts: Mapping[str, str]
    """Stage -> folder of its artifact."""
    evidence: Evidence | None
    """Of the approval; None = not approved, or a draft."""

    @property
    def key(self) -> str:
        """Hash of the request."""
        determines = {
            "map file": self.ending,
            "query": self.query.model_dump(),
            "artifacts": dict(self.artifacts),
            "evidence": asdict(self.evidence) if self.evidence else None,
        }
        return hashlib.sha256(json.dumps(determines, sort_keys=True).encode()).hexdigest()

    @property
    def large(self) -> bool:
        """It may take minutes."""
        return True

    def work(self, name: str) -> tuple[Callable[..., str], dict[str, object]]:
        """What the child process calls, with its arguments."""
        facts = {"artifacts": dict(self.artifacts), "evidence": self.evidence}
        return write_map_file, {**facts, "query": self.query, "out": name}


def write_map_file(
    *, artifacts: dict[str, str], evidence: Evidence | None, query: MapFileQuery, out: str
) -> str:
    """Write the map in the format of the suffix, with the approval if there is one.

    Raises:
        Altered: If it is not what was approved.
        ConfigError: If all points are wanted in a format without classes.
        GeoreferenceError: If a CRS is requested and the map is not georeferenced.
    """
    from recon4.export.map_files import map_to_export, write_map
    from recon4.export.options import ExportOptions
    from recon4.progress import Silent

    folders = {stage: Path(folder) for stage, folder in artifacts.items()}
    wanted = ExportOptions(**query.model_dump())
    map_ = map_to_export(folders, evidence, wanted)
    write_map(map_, Path(out), progress=Silent())
    return out
