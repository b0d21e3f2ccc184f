"""What follows the contents of a capture: each kind of rig has its own map."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from recon4.live.ipc.messages import Snapshot
from recon4.live.mapper.imu_synchronization import ImuSynchronization
from recon4.live.mapper.latency import Latency
from recon4.live.mapper.live_map import LiveMap
from recon4.live.mapper.scan_map import ScanMap
from recon4.live.mapper.scan_tracker import end_of
from recon4.live.protocol import MapperMessage, Pose
from recon4.model.laser_scans import LaserScans
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.samples import ImuSamples

Measured = Multiframe | ImuSamples | LaserScans
_MOST_SCANS = 8
"""Scans that wait for the IMU at most, 0.3 s at 25 Hz."""


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


class LidarFollower:
    """Maps the multiframes of LiDARs."""

    def __init__(self, live_map: LiveMap, rig: Rig, latency: Latency) -> None:
        self._map, self._latency = live_map, latency
        self._offset_ns = round(rig.imu_time_offset_s * 1e9)
        self._synchronization = ImuSynchronization(frame_end_ns)

    def take(self, item: Measured) -> Iterator[MapperMessage]:
        """Map the multiframes whose IMU samples are there."""
        if isinstance(item, ImuSamples):
            self._map.extend_imu(item)
            ready = self._synchronization.imu_until(int(item.t_ns[-1]) + self._offset_ns)
        elif isinstance(item, Multiframe):
            ready = self._synchronization.push(item)
        else:
            return
        for frame in ready:
            yield from self._map_frame(frame)

    def flush(self) -> Iterator[MapperMessage]:
        """Map the multiframes that still wait."""
        for frame in self._synchronization.flush():
            yield from self._map_frame(frame)

    def snapshot(self) -> Snapshot:
        """The current state."""
        return self._map.snapshot()

    def _map_frame(self, frame: Multiframe) -> Iterator[MapperMessage]:
        if self._latency.leave_out(frame_end_ns(frame)):
            self._map.thin(frame)
            return
        pose, others = self._map.push(frame)
        yield on_recorder_clock(pose, self._latency)
        yield from others


class ScanFollower:
    """Maps the scans of a 2-D laser, and the multiframes of a profiler."""

    def __init__(self, scan_map: ScanMap, rig: Rig, latency: Latency) -> None:
        self._map, self._latency = scan_map, latency
        self._offset_ns = round(rig.imu_time_offset_s * 1e9)
        self._synchronization = ImuSynchronization(end_of, most=_MOST_SCANS)

    def take(self, item: Measured) -> Iterator[MapperMessage]:
        """Map the scans whose IMU samples are there."""
        if isinstance(item, Multiframe):
            yield from self._map.sweep(item)
            return
        if isinstance(item, ImuSamples):
            self._map.extend_imu(item)
            ready = self._synchronization.imu_until(int(item.t_ns[-1]) + self._offset_ns)
        else:
            rows = (item[slice(k, k + 1)] for k in range(len(item)))
            ready = [scan for row in rows for scan in self._synchronization.push(row)]
        for scan in ready:
            yield from self._map_scan(scan)

    def flush(self) -> Iterator[MapperMessage]:
        """Map the scans that still wait."""
        for scan in self._synchronization.flush():
            yield from self._map_scan(scan)

    def snapshot(self) -> Snapshot:
        """The current state."""
        return self._map.snapshot()

    def _map_scan(self, scan: LaserScans) -> Iterator[MapperMessage]:
        if self._latency.leave_out(end_of(scan)):
            self._map.thin(int(scan.t_ns[0]))
            return
        pose, others = self._map.push(scan)
        yield on_recorder_clock(pose, self._latency)
        yield from others


def on_recorder_clock(pose: Pose, latency: Latency) -> Pose:
    """The pose with its time on the recorder's clock, and its age."""
    pose.t_ns = latency.on_recorder_clock(pose.t_ns)
    pose.age_s = latency.age_s(pose.t_ns)
    return pose
