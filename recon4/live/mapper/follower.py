"""What follows the contents of a capture: each kind of rig has its own map."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Generic, Protocol, TypeVar

from recon4.live.ipc.messages import Snapshot
from recon4.live.mapper.imu_synchronization import ImuSynchronization
from recon4.live.mapper.latency import Latency
from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.scan_map import ScanMap
from recon4.live.mapper.scan_tracker import end_of
from recon4.live.mapper.tuning import FOLLOWER
from recon4.live.protocol import MapperMessage, Pose
from recon4.model.laser_scans import LaserScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples

Measured = Multiframe | ImuSamples | LaserScans
_Mapped = TypeVar("_Mapped")
_Taken = TypeVar("_Taken", contravariant=True)


class Follower(Protocol):
    """Maps what a reader delivers."""

    def take(self, item: Measured) -> Iterator[MapperMessage]:
        """Take the next content; gives messages as soon as they are known."""
        ...

    def flush(self) -> Iterator[MapperMessage]:
        """The rest, at the end of the capture."""
        ...

    def snapshot(self) -> Snapshot:
        """The current state, for clients that connect late."""
        ...


def frame_end_ns(frame: Multiframe) -> int:
    """End of a multiframe [ns]."""
    return frame.t_ns + frame.duration_ns


class _LiveMap(Protocol[_Taken]):
    """A map of a running capture."""

    def extend_imu(self, imu: ImuSamples) -> None: ...

    def push(self, item: _Taken, /) -> tuple[Pose, list[MapperMessage]]: ...

    def thin(self, item: _Taken, /) -> None: ...

    def snapshot(self) -> Snapshot: ...


class _MapFollower(Generic[_Mapped]):
    """Maps what has waited for its IMU samples."""

    def __init__(
        self,
        live_map: _LiveMap[_Mapped],
        rig: Rig,
        latency: Latency,
        *,
        synchronization: ImuSynchronization[_Mapped],
    ) -> None:
        self._map, self._latency = live_map, latency
        self._offset_ns = round(rig.imu_clock_offset_s * 1e9)
        self._synchronization = synchronization

    def flush(self) -> Iterator[MapperMessage]:
        """Map what still waits."""
        yield from self._map_all(self._synchronization.flush())

    def snapshot(self) -> Snapshot:
        """The current state."""
        return self._map.snapshot()

    def _extend_imu(self, imu: ImuSamples) -> Iterator[MapperMessage]:
        self._map.extend_imu(imu)
        until_ns = int(imu.t_ns[-1]) + self._offset_ns
        yield from self._map_all(self._synchronization.imu_until(until_ns))

    def _map_all(self, items: Iterable[_Mapped]) -> Iterator[MapperMessage]:
        for item in items:
            if self._latency.leave_out(self._synchronization.end_ns(item)):
                self._map.thin(item)
                continue
            pose, others = self._map.push(item)
            pose.t_ns = self._latency.on_recorder_clock(pose.t_ns)
            pose.age_s = self._latency.age_s(pose.t_ns)
            yield pose
            yield from others


class LidarFollower(_MapFollower[Multiframe]):
    """Maps the multiframes of LiDARs."""

    def __init__(self, live_map: LiveMap, rig: Rig, latency: Latency) -> None:
        waiting = ImuSynchronization(frame_end_ns)
        super().__init__(live_map, rig, latency, synchronization=waiting)

    def take(self, item: Measured) -> Iterator[MapperMessage]:
        """Map the multiframes whose IMU samples are there."""
        if isinstance(item, ImuSamples):
            yield from self._extend_imu(item)
        elif isinstance(item, Multiframe):
            yield from self._map_all(self._synchronization.push(item))


class ScanFollower(_MapFollower[LaserScans]):
    """Maps the scans of a 2-D laser, and the multiframes of a profiler."""

    def __init__(self, scan_map: ScanMap, rig: Rig, latency: Latency) -> None:
        waiting = ImuSynchronization(end_of, most=FOLLOWER.most_scans)
        super().__init__(scan_map, rig, latency, synchronization=waiting)
        self._scan_map = scan_map

    def take(self, item: Measured) -> Iterator[MapperMessage]:
        """Map the scans whose IMU samples are there."""
        if isinstance(item, Multiframe):
            yield from self._scan_map.sweep(item)
        elif isinstance(item, ImuSamples):
            yield from self._extend_imu(item)
        else:
            rows = (item[slice(k, k + 1)] for k in range(len(item)))
            ready = [scan for row in rows for scan in self._synchronization.push(row)]
            yield from self._map_all(ready)
