"""Density images: the walls around a place from above, their descriptor and their correlation.

The vertical is known, so two visits of a place differ by a rotation about it and a shift. As in
MapClosures (Gupta 2024) the place is drawn as an image from above; here the rotation-invariant
spectrum of the image finds candidates, and a correlation by FFT over rotations and all shifts
finds the pose.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy import fft, ndimage

from recon4.geometry.se3 import Array
from recon4.pose_graph.tuning_places import DENSITY

_REACH = round(DENSITY.max_shift_m / DENSITY.cell_m)
_SHIFTS = np.arange(-_REACH, _REACH + 1)
"""Shifts that are tried along each axis, in cells."""
_HEIGHTS_M = np.arange(*DENSITY.heights_m)
"""Lower edges of the layers, and the upper one of the last."""

Spectrum = NDArray[np.complex64]
Layers = NDArray[np.int64]
"""Points in each layer, (L,)."""


@dataclass(frozen=True, slots=True, eq=False)
class DensityImage:
    """The walls around a place, with what is compared of them."""

    walls_m: Array
    """Horizontal positions of wall points relative to the place, map axes [m], (N, 2)."""
    spectrum: Spectrum
    """Fourier transform of the blurred image of unit norm."""
    descriptor: Array
    """Unit vector, invariant to rotations and shifts, (D,)."""

    def without_walls(self) -> DensityImage:
        """What others can be laid onto, but itself not onto others."""
        return replace(self, walls_m=np.empty((0, 2)))


@dataclass(frozen=True, slots=True)
class Overlay:
    """A rotation and shift that lays one image onto another."""

    yaw_rad: float
    shift_m: tuple[float, float]
    score: float
    """Cosine of the two images, 0..1."""


def make_density_image(walls_m: Array, layers: Layers) -> DensityImage:
    """Draw the walls around a place.

    Args:
        walls_m: Horizontal positions relative to the place [m], (N, 2); Fortran order is faster.
        layers: `layers_of` all points: floor and ceiling.
    """
    x, y = walls_m.T
    is_near = np.sqrt(x**2 + y**2) < DENSITY.radius_m
    near = np.compress(is_near, walls_m.T, axis=1).T  # rows of two would take several times as long
    image = ndimage.gaussian_filter(_raster(near), 1.0)
    spectrum = fft.rfft2(image / max(float(np.linalg.norm(image)), 1e-9))
    return DensityImage(near, spectrum, _descriptor(image, layers))


def layers_of(heights_m: Array) -> Layers:
    """How many points are in each layer around the body, by their heights from it [m], (M,)."""
    above = np.searchsorted(_HEIGHTS_M, heights_m, side="right")
    return np.bincount(above, minlength=len(_HEIGHTS_M) + 1)[1:-1]


class TurnedImage:
    """An image to be laid onto others; what is computed of a rotation is kept for all of them."""

    def __init__(self, image: DensityImage) -> None:
        """Not turned yet."""
        self._walls_m = image.walls_m
        self._spectra: dict[float, Spectrum] = {}

    def spectrum(self, yaw: float) -> Spectrum:
        """Conjugate Fourier transform of the image turned by ``yaw`` [rad]."""
        if yaw not in self._spectra:
            c, s = np.cos(yaw), np.sin(yaw)
            image = _raster(self._walls_m @ np.array([[c, s], [-s, c]]))
            # The source is not blurred: blurring both would widen the maximum.
            image /= max(float(np.linalg.norm(ndimage.gaussian_filter(image, 1.0))), 1e-9)
            self._spectra[yaw] = np.conj(fft.rfft2(image))
        return self._spectra[yaw]


def overlays(target: DensityImage, source: TurnedImage, *, yaws: Array, most: int) -> list[Overlay]:
    """The best overlays of ``source`` onto ``target``, best first, at most ``most``.

    Args:
        target: Image of the earlier place.
        source: Image to be moved.
        yaws: Rotations that are tried [rad], (Y,).
        most: Number of overlays; those next to a better one are omitted.
    """
    scores = _correlate(target, source, yaws)
    found = []
    for _ in range(most):
        k, a, b = np.unravel_index(int(np.argmax(scores)), scores.shape)
        shift = (float(_SHIFTS[a] * DENSITY.cell_m), float(_SHIFTS[b] * DENSITY.cell_m))
        found.append(Overlay(float(yaws[k]), shift, float(scores[k, a, b])))
        _suppress(scores, yaws, at=(int(k), int(a), int(b)))
    return [one for one in found if np.isfinite(one.score)]


def yaws_within(bound_rad: float) -> Array:
    """Rotations to try: up to a bound on either side, at most a full turn, (Y,)."""
    if bound_rad >= np.pi:
        return np.arange(-np.pi, np.pi, DENSITY.yaw_step_rad, dtype=np.float64)
    steps = int(np.ceil(bound_rad / DENSITY.yaw_step_rad))
    return np.asarray(np.arange(-steps, steps + 1) * DENSITY.yaw_step_rad, np.float64)


def _correlate(target: DensityImage, source: TurnedImage, yaws: Array) -> NDArray[np.float32]:
    """Cosine of the images for all shifts of the source, turned by each yaw, (Y, S, S)."""
    turned = np.stack([source.spectrum(float(yaw)) for yaw in yaws])
    # As `irfft2` does it, one axis after the other, without the rows that no shift asks for.
    rows = fft.ifft(target.spectrum * turned, axis=1)[:, _SHIFTS]
    chosen: NDArray[np.float32] = fft.irfft(rows, n=DENSITY.cells, axis=2)[:, :, _SHIFTS]
    return chosen


def _suppress(scores: NDArray[np.float32], yaws: Array, *, at: tuple[int, int, int]) -> None:
    """Exclude the neighborhood of a maximum."""
    near = round(DENSITY.apart_m / DENSITY.cell_m)
    turned = np.abs((yaws - yaws[at[0]] + np.pi) % (2.0 * np.pi) - np.pi)
    a, b = max(at[1] - near, 0), max(at[2] - near, 0)
    rows = np.flatnonzero(turned <= DENSITY.apart_rad)
    scores[rows, a : at[1] + near + 1, b : at[2] + near + 1] = -np.inf


def _raster(p_m: Array) -> NDArray[np.float32]:
    # Axis by axis: rows of two numbers take several times as long.
    x, y = (
        np.floor(axis / DENSITY.cell_m + 0.5).astype(np.int64) + DENSITY.cells // 2
        for axis in p_m.T
    )
    inside = (x >= 0) & (x < DENSITY.cells) & (y >= 0) & (y < DENSITY.cells)
    cells = (x * DENSITY.cells + y)[inside]
    counts = np.bincount(cells, minlength=DENSITY.cells**2)
    full = np.minimum(counts.reshape(DENSITY.cells, DENSITY.cells), DENSITY.most) / DENSITY.most
    return full.astype(np.float32)


def _descriptor(image: NDArray[np.float32], layers: Layers) -> Array:
    """Magnitudes of the spectrum are invariant to shifts; their own spectrum around the circle is
    invariant to rotations. A histogram of heights tells low rooms from halls.
    """
    center = DENSITY.cells // 2
    reach = np.arange(-center // 2 - 1, center // 2 + 2)
    magnitude = np.log1p(np.abs(fft.fft2(image)[np.ix_(reach, reach)]))
    radius = np.linspace(2.0, DENSITY.cells / 4.0, DENSITY.radii)
    angle = np.arange(DENSITY.angles) * np.pi / DENSITY.angles  # the other half repeats it
    at = np.stack([np.outer(radius, np.cos(angle)), np.outer(radius, np.sin(angle))]) + center
    at -= center + reach[0]  # exact: the fractions stay
    polar = ndimage.map_coordinates(magnitude, at, order=1)
    waves = np.abs(fft.rfft(polar, axis=1))[:, : DENSITY.angles // 4]
    # The means of the rings are alike everywhere; they would hide the rest.
    rings = (waves[:, 1:] / np.maximum(waves[:, :1], 1e-9)).ravel()
    heights = np.sqrt(layers.astype(np.float64))
    parts = [part / max(float(np.linalg.norm(part)), 1e-9) for part in (rings, heights)]
    return np.concatenate(parts) / np.sqrt(2.0)
