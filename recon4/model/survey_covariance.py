"""Covariance of a surveyed point, as the adjustment of a survey states it."""

from __future__ import annotations

import math
from typing import TypeAlias

import numpy as np

from recon4.errors import ConfigError
from recon4.geometry.se3 import Array
from recon4.locales.coded import CodedText
from recon4.model.tuning import SURVEY_COVARIANCES

Covariance: TypeAlias = tuple[float, float, float, float, float, float]
"""EE, EN, EH, NN, NH, HH [m²], E and N along the axes of the survey."""


def covariance_of(sd_m: tuple[float, float, float]) -> Covariance:
    """The covariance of independent coordinates, by their standard deviations E, N, H [m].

    Raises:
        ConfigError: As `check_covariance`.
    """
    e, n, h = sd_m
    if min(sd_m) < 0.0:
        raise ConfigError(CodedText("survey-deviations", e=e, n=n, h=h))
    return check_covariance((e * e, 0.0, 0.0, n * n, 0.0, h * h))


def covariance_matrix(values: Covariance) -> Array:
    """The same as a matrix [m²], (3, 3)."""
    ee, en, eh, nn, nh, hh = values
    return np.array([[ee, en, eh], [en, nn, nh], [eh, nh, hh]])


def check_covariance(values: Covariance) -> Covariance:
    """A covariance that a survey can have.

    Raises:
        ConfigError: If it is not positive definite, or a standard deviation is out of bounds: its
            unit is another one.
    """
    if not np.isfinite(values).all():
        raise ConfigError(CodedText("survey-covariance-finite"))
    matrix = covariance_matrix(values)
    for axis, variance in zip("ENH", np.diag(matrix).tolist(), strict=True):
        least, most = SURVEY_COVARIANCES.least_m, SURVEY_COVARIANCES.most_m
        sd_m = math.sqrt(variance) if variance > 0.0 else variance
        if not least <= sd_m <= most:
            raise ConfigError(
                CodedText(
                    "survey-deviation-range", axis=axis, sd_m=float(sd_m), least=least, most=most
                )
            )
    sd = np.sqrt(np.diag(matrix))
    least_root = float(np.linalg.eigvalsh(matrix / np.outer(sd, sd))[0])
    if least_root < SURVEY_COVARIANCES.least_root:
        raise ConfigError(CodedText("survey-covariance-definite"))
    return values
