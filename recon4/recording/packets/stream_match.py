"""Which streams of captured packets are of which sensor of a rig."""

from __future__ import annotations

from collections.abc import Sequence

from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding import Value
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Sensor
from recon4.recording.packets.family import Companion
from recon4.recording.packets.makes import can_be_of
from recon4.recording.packets.streams import PacketStream, fits
from recon4.recording.packets.tuning import CAPTURE_STREAMS
from recon4.recording.report import ImportReport


def match_streams(
    sensors: Sequence[Sensor],
    groups: list[tuple[PacketStream, ...]],
    companions: Sequence[Companion],
    *,
    report: ImportReport,
) -> dict[int, tuple[PacketStream, ...]]:
    """Assign what sends to the sensors of a rig: by address and port, then what is left in order.

    Args:
        sensors: Of the rig.
        groups: Data streams, those of one sensor together.
        companions: Files beside the recording.
        report: Receives what was taken from elsewhere, and what is of no sensor.

    Returns:
        Row of the sensor to its streams; packets of another make are of none.
    """
    chosen: dict[int, tuple[PacketStream, ...]] = {}
    left = list(groups)
    for row in sorted(range(len(sensors)), key=lambda row: not sensors[row].address):
        fitting = [s for s in left if fits(sensors[row], s[0].source, s[0].port)]
        fitting = [s for s in fitting if _can_be(s[0], sensors[row], companions)]
        fitting = [s for s in fitting if _is_of(s[0], sensors[row])] or fitting
        if fitting:
            chosen[row] = _full(fitting, fitting)[0]
            left.remove(chosen[row])
    likely = _full(left, groups)
    for row in (row for row in range(len(sensors)) if row not in chosen):
        alike = [s for s in likely if _can_be(s[0], sensors[row], companions)]
        if not alike:
            continue
        streams = min(alike, key=lambda streams: streams[0].port != sensors[row].port)
        chosen[row] = streams
        left.remove(streams)
        likely.remove(streams)
        expected = sensors[row].address
        where: dict[str, Value] = {"address": expected} if expected else {"anywhere": True}
        report.derive(
            DerivedKind.SENSOR_ELSEWHERE,
            sensor=sensors[row].name,
            sender=streams[0].label,
            port=sensors[row].port,
            **where,
        )
    silent = [sensor for row, sensor in enumerate(sensors) if row not in chosen]
    for stream, *_ in left:
        if not any(fits(sensor, stream.source, stream.port) for sensor in silent):
            report.warn(FindingKind.PACKETS_UNASSIGNED, sender=stream.label)
    return chosen


def _can_be(stream: PacketStream, sensor: Sensor, companions: Sequence[Companion]) -> bool:
    return can_be_of(sensor, stream.found, head=stream.head, companions=companions)


def _is_of(stream: PacketStream, sensor: Sensor) -> bool:
    """Whether a stream of an address and port that several sensors share is of this one."""
    return not stream.shared or sensor.serial == (stream.found.serial if stream.found else "")


def _full(
    some: list[tuple[PacketStream, ...]], all_of: list[tuple[PacketStream, ...]]
) -> list[tuple[PacketStream, ...]]:
    """Those that are no trickle beside the largest of others."""
    most = max((sum(s.packets for s in streams) for streams in all_of), default=0)
    return [k for k in some if sum(s.packets for s in k) >= CAPTURE_STREAMS.foreign_ratio * most]
