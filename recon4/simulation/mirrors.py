"""What a beam meets in a mirror, and through a clear pane or in it at grazing incidence.

A LiDAR puts what it sees in a mirror behind it: a second room, as still as the first one, so that
no registration contradicts it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.raycast import Hits, Scene
from recon4.geometry.se3 import Array
from recon4.geometry.tuning import SURFACES


@dataclass(frozen=True, slots=True, kw_only=True)
class MirrorOptics:
    """How beams are followed over mirrors and panes."""

    most: int = 4
    """A beam is followed over this many of them; then nothing returns."""
    grazing: float = 0.3
    """With a smaller cosine of the angle of incidence a pane reflects the beam; with a larger one
    it lets it through (Fresnel: at 73° it reflects about a third)."""
    beyond_m: float = 1e-3
    """A beam goes on this far from the surface that it left."""


OPTICS = MirrorOptics()


def follow(
    hits: Hits, rays: NDArray[np.float32], *, scene: Scene, reflectivity: NDArray[np.float32]
) -> Hits:
    """Hits of rays (N, 6) with those on mirrors and clear panes replaced by what is seen there.

    The range is the length of the whole path. Normals are turned as the mirrors turn the beam, so
    that the cosine with the ray as it left the sensor is that of the incidence.

    Args:
        hits: First hits.
        rays: Origins and unit directions in the map.
        scene: What stands.
        reflectivity: Of each triangle, (T,).
    """
    special = np.flatnonzero(_special(hits, reflectivity))
    if not len(special):
        return hits
    out = Hits(hits.range_m.copy(), hits.triangle.copy(), hits.normal.copy())
    count = len(special)
    turn, length_m = np.tile(np.eye(3), (count, 1, 1)), np.zeros(count)
    beams = _Beams(special, rays[special].astype(np.float64), turn, length_m)
    met = Hits(hits.range_m[special], hits.triangle[special], hits.normal[special])
    for _ in range(OPTICS.most):
        beams = _beyond(beams, met, reflectivity)
        met = scene.cast(beams.rays.astype(np.float32))
        out.range_m[beams.row] = met.range_m + beams.length_m
        out.triangle[beams.row] = met.triangle
        out.normal[beams.row] = np.einsum("nji,nj->ni", beams.turn, met.normal)
        on = np.flatnonzero(_special(met, reflectivity))
        beams = beams.only(on)
        met = Hits(met.range_m[on], met.triangle[on], met.normal[on])
        if not len(on):
            return out
    out.range_m[beams.row] = np.inf
    return out


@dataclass(frozen=True, slots=True, eq=False)
class _Beams:
    """Beams on their way. N of them."""

    row: NDArray[np.intp]
    """Of the ray as it left the sensor, (N,)."""
    rays: Array
    """Origin and unit direction now, (N, 6)."""
    turn: Array
    """Maps the direction as it left the sensor to the one now, (N, 3, 3)."""
    length_m: Array
    """Of the path so far [m], (N,)."""

    def only(self, rows: NDArray[np.intp]) -> _Beams:
        return _Beams(self.row[rows], self.rays[rows], self.turn[rows], self.length_m[rows])


def _special(hits: Hits, reflectivity: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Hits on mirrors and clear panes."""
    found = np.isfinite(hits.range_m)
    found[found] = reflectivity[hits.triangle[found]] <= SURFACES.clear
    return found


def _beyond(beams: _Beams, met: Hits, reflectivity: NDArray[np.float32]) -> _Beams:
    """The beams after the mirrors and panes that they met."""
    normal, along = met.normal.astype(np.float64), beams.rays[:, 3:]
    cosine = np.einsum("ni,ni->n", normal, along)
    reflected = (reflectivity[met.triangle] <= SURFACES.mirror) | (np.abs(cosine) < OPTICS.grazing)
    leaving = along - 2.0 * (cosine * reflected)[:, None] * normal
    flip = np.eye(3) - 2.0 * reflected[:, None, None] * normal[:, :, None] * normal[:, None, :]
    origin = beams.rays[:, :3] + met.range_m[:, None] * along + OPTICS.beyond_m * leaving
    return _Beams(
        beams.row,
        np.concatenate([origin, leaving], axis=1),
        flip @ beams.turn,
        beams.length_m + met.range_m + OPTICS.beyond_m,
    )
