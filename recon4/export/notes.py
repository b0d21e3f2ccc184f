"""Notes of people on a map, as geometries for a GIS (GeoJSON)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from recon4.export.geojson import JsonObject, collection, feature
from recon4.georeference.crs_file import read_crs
from recon4.store.project import read_artifacts


@dataclass(frozen=True, slots=True)
class PlacedNote:
    """A note at a place."""

    p_map: tuple[float, float, float]
    """[m]"""
    about: JsonObject
    """Its properties in the file."""


def notes_geojson(project: Path, notes: Sequence[PlacedNote]) -> str:
    """A point for each note, where the map of a project is now.

    Raises:
        StoreError: If the georeference of the map is damaged.
    """
    artifacts = read_artifacts(project)
    place = read_crs(artifacts["level"]) if "level" in artifacts else None
    features = [feature(np.array([one.p_map]), place, one.about) for one in notes]
    return collection(features, place)
