"""Velodyne position packets: NMEA sentences of the GPS receiver and the HDL-32E's inertial unit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from recon4.model.rig import Sensor
from recon4.model.samples import GnssSamples, ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.report import ImportReport


@dataclass(frozen=True, slots=True, eq=False)
class PositionSamples:
    """What some position packets said; None where they said nothing."""

    imu: ImuSamples | None
    gnss: GnssSamples | None


class PositionDecoder:
    """Turns the position packets of one sensor into samples; one object a sensor."""

    def __init__(self, sensor: Sensor, *, report: ImportReport) -> None:
        raise NotImplementedError

    def push(self, t_arrival_ns: Times, payloads: NDArray[np.uint8]) -> PositionSamples:
        """Samples of these packets, in order; (N,) and (N, 512). A repeated sentence counts once."""
        raise NotImplementedError
