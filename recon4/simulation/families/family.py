"""What a family of LiDARs gives so that it can be simulated: one module, one row in `families`.

The inverse of `recon4.recording.packets.family`: the pattern of a model, and packets of shots.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times
from recon4.recording.packets.family import Payloads
from recon4.simulation.lidar import Firings, Lidar
from recon4.simulation.patterns import FiringPattern


class WithinData(Protocol):
    """Puts samples into the data packets."""

    def __call__(self, payloads: Payloads, samples: ImuSamples) -> None:
        """Write the newest sample of each packet, (P, size); at least one sample."""
        ...


@dataclass(frozen=True, slots=True, kw_only=True)
class BuiltInImu:
    """The IMU in a LiDAR, in the axes in which the family's reader gives its samples.

    Where it is says `recon4.model.rig.imu_mount`.
    """

    packets: Callable[[ImuSamples], Payloads] | None = None
    """One packet for each sample, whose times are on the clock of the sensor; None = …"""
    within: WithinData | None = None
    """… they are in the data packets."""
    rate_hz: int = 200


class SimulatedFamily(Protocol):
    """The LiDARs of one maker."""

    @property
    def name(self) -> str:
        """As in `recon4.model.lidar_facts.LidarFacts.maker`."""
        ...

    def pattern(self, model: str) -> FiringPattern | None:
        """How a model fires; None = it is not simulated."""
        ...

    def imu(self, model: str) -> BuiltInImu | None:
        """Its IMU; None = it has none, or none that is read."""
        ...

    def data_packets(self, lidar: Lidar, firings: Firings, t_ns: Times) -> Payloads:
        """Packets of shots.

        Args:
            lidar: The sensor.
            firings: Its shots.
            t_ns: Start of each packet on the clock of the sensor [ns], (P,).
        """
        ...

    def companions(self, lidar: Lidar) -> Mapping[str, bytes]:
        """Files that the maker delivers with the sensor: name -> contents."""
        ...


def encoder_cdeg(lidar: Lidar, firings: Firings, since_ns: float = 0.0) -> NDArray[np.int64]:
    """What the encoder of a LiDAR that spins says at each sequence [0.01°], (P, S).

    Args:
        lidar: The sensor.
        firings: Its shots.
        since_ns: Time from the reading of the encoder to the shot of the first laser [ns].
    """
    turned = 2.0 * np.pi * lidar.turn_rate_hz * 1e-9 * since_ns
    turn = np.mod(firings.turn_rad[:, :, 0] - turned, 2.0 * np.pi)
    return np.rint(np.rad2deg(turn) * 100.0).astype(np.int64)
