"""What the stages need of the multiframes of a recording; `recon4.store.frames` reads them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples
from recon4.model.trajectory import Times


class Frames(Protocol):
    """Multiframes that are read one at a time."""

    @property
    def rig(self) -> Rig:
        """The sensors and their poses."""

    def __len__(self) -> int: ...
    def __getitem__(self, k: int) -> Multiframe: ...


class RecordedFrames(Frames, Protocol):
    """Multiframes of a recording with their IMU."""

    @property
    def imu(self) -> ImuSamples | None:
        """IMU samples, if there are any."""

    @property
    def t_mid_ns(self) -> Times:
        """Middle of each multiframe [ns], (N,)."""

    def with_imu(self, imu: ImuSamples) -> RecordedFrames:
        """The same multiframes with repaired samples."""

    def __iter__(self) -> Iterator[Multiframe]: ...
