"""People who walk with the carrier and hide part of the view: surfaces that do not stand still.

Each keeps a place beside, before or behind the carrier, as a group does that is being led. They
seem to stand in the body while the world moves past, so a registration that matches them estimates
less motion than there was.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.geometry.raycast import Hits
from recon4.geometry.se3 import Array
from recon4.simulation.person import GAIT
from recon4.simulation.walk import Walk


@dataclass(frozen=True, slots=True, kw_only=True)
class CompanionModel:
    """Size and gait of those who walk along."""

    radius_m: float = 0.27
    height_m: float = 1.75
    sway_m: float = 0.08
    sway_hz: float = 0.9
    """They sway from side to side."""
    lag_s: float = 0.4
    """They follow the heading of the carrier this much later."""
    near_m: float = 0.9
    far_m: float = 1.8
    """How far from the carrier they walk."""


COMPANION = CompanionModel()


@dataclass(frozen=True, slots=True, eq=False)
class Companions:
    """A group of people, as upright cylinders."""

    offset_m: Array
    """Places beside the carrier: ahead and left of the heading [m], (M, 2)."""
    phase_rad: Array
    """Phase of the sway of each, (M, 2)."""

    @staticmethod
    def drawn(count: int, rng: np.random.Generator) -> Companions:
        """People all around, none of them nearer than arm's length."""
        angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(0.2, 0.8, count)) / max(count, 1)
        away_m = rng.uniform(COMPANION.near_m, COMPANION.far_m, count)
        offset_m = away_m[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        return Companions(offset_m, rng.uniform(0.0, 2.0 * np.pi, (count, 2)))

    def __len__(self) -> int:
        return len(self.offset_m)

    @property
    def view_ratio(self) -> float:
        """Part of the horizon they hide, if none stands before another, 0..1."""
        away_m = np.linalg.norm(self.offset_m, axis=1)
        return float(np.minimum(np.arcsin(COMPANION.radius_m / away_m) / np.pi, 1.0).sum())

    def centers(self, walk: Walk, t_s: Array) -> tuple[Array, Array]:
        """Where they stand at some times: x, y (M, N, 2) and the height of their feet (N,) [m]."""
        state = walk.state(t_s)
        yaw = walk.state(np.maximum(t_s - COMPANION.lag_s, 0.0))[:, 5]
        turn = np.stack([np.cos(yaw), -np.sin(yaw), np.sin(yaw), np.cos(yaw)], axis=1)
        turned = np.einsum("nij,mj->mni", turn.reshape(-1, 2, 2), self.offset_m)
        angle = 2.0 * np.pi * COMPANION.sway_hz * t_s[:, None] + self.phase_rad[:, None, :]
        return state[:, :2] + turned + COMPANION.sway_m * np.sin(angle), state[
            :, 2
        ] - GAIT.body_height_m

    def hide(
        self, hits: Hits, rays: NDArray[np.float32], *, walk: Walk, t_s: Array, surface: int
    ) -> Hits:
        """Hits of rays after those that meet a person first are replaced.

        Args:
            hits: Of the standing world.
            rays: Origins and unit directions, (N, 6).
            walk: The carrier.
            t_s: Time of each ray [s], (N,).
            surface: What to put as the triangle of a person.
        """
        radius_m = COMPANION.radius_m
        range_m, triangle = hits.range_m.copy(), hits.triangle.copy()
        normal = hits.normal.copy()
        centers, feet_m = self.centers(walk, t_s)
        origin, along = rays[:, :3].astype(np.float64), rays[:, 3:].astype(np.float64)
        flat2 = np.maximum((along[:, :2] ** 2).sum(axis=1), 1e-12)
        for center in centers:
            to = center - origin[:, :2]
            nearest = (to * along[:, :2]).sum(axis=1) / flat2
            miss2 = (to**2).sum(axis=1) - nearest**2 * flat2
            entry = nearest - np.sqrt(np.maximum(radius_m**2 - miss2, 0.0) / flat2)
            z = origin[:, 2] + entry * along[:, 2]
            met = (miss2 < radius_m**2) & (entry > 0.0) & (entry < range_m)
            met &= (z > feet_m) & (z < feet_m + COMPANION.height_m)
            range_m[met] = entry[met]
            triangle[met] = surface
            out = (origin[met, :2] + entry[met, None] * along[met, :2] - center[met]) / radius_m
            normal[met] = np.column_stack([out, np.zeros(len(out))])
        return Hits(range_m, triangle, normal)
