"""Velodyne data packets to points: filter, clock, order, decode."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from recon4.model.rig import Sensor
from recon4.model.trajectory import Times
from recon4.recording.report import ImportReport
from recon4.recording.shots import Shots
from recon4.settings import IngestSettings


class PacketDecoder:
    """Turns the data packets of one sensor into shots; one object a sensor.

    The frame of the points is that of the sensor: x forward (azimuth 0), y left, z up, as in
    ``velodyne-decoder`` and the ROS driver. Azimuth grows clockwise seen from above.
    """

    def __init__(
        self,
        sensor_row: int,
        sensor: Sensor,
        *,
        settings: IngestSettings,
        report: ImportReport,
    ) -> None:
        raise NotImplementedError

    def push(self, t_arrival_ns: Times, payloads: NDArray[np.uint8]) -> Shots:
        """Take packets in, give out the shots that are certain to be in order.

        Args:
            t_arrival_ns: When the host received each packet [ns], (N,).
            payloads: UDP payloads, (N, 1206) or any other width (then all are dropped, counted).

        Returns:
            Shots in firing order; those of the last ``settings.reorder_window_s`` are held back.
        """
        raise NotImplementedError

    def flush(self) -> Shots:
        """Give out what was held back."""
        raise NotImplementedError

    @property
    def rotation_hz(self) -> float:
        """Measured rotation rate [Hz]; NaN before the first packets."""
        raise NotImplementedError
