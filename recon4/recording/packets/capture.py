"""Capture files of LiDARs: assigns streams to sensors and decodes their shots."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from recon4.errors import EmptyRecording
from recon4.locales.coded import CodedText
from recon4.model.derived_kinds import DerivedKind
from recon4.model.finding_kinds import FindingKind
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig, Sensor
from recon4.recording.assembly.shots import Shots
from recon4.recording.clocks.compare import LIDAR
from recon4.recording.formats.datagrams import (
    NO_DATAGRAMS,
    Datagrams,
    address_number,
    join_datagrams,
)
from recon4.recording.formats.pcap import OpenFile, open_plain
from recon4.recording.info.files_near import COMPANION_SUFFIXES
from recon4.recording.packets.companions import companions_of, described_in
from recon4.recording.packets.datagram_files import read_datagrams
from recon4.recording.packets.decoder import PacketDecoder, open_decoder
from recon4.recording.packets.family import PacketSamples, PacketSensor
from recon4.recording.packets.file_overlaps import goes_on_in
from recon4.recording.packets.lidar_imu import LidarImu
from recon4.recording.packets.slots import in_slots
from recon4.recording.packets.stream_match import match_streams
from recon4.recording.packets.streams import (
    PacketStream,
    fits,
    late_stream,
    scan_pcap,
    unread_text,
)
from recon4.recording.packets.tuning import CAPTURE_STREAMS
from recon4.recording.report import ImportReport
from recon4.recording.rigs.choice import Stream
from recon4.recording.samples.datagrams import SampleDecoder
from recon4.recording.tuning import LISTED
from recon4.settings import IngestSettings


@dataclass(frozen=True, slots=True, eq=False)
class _Channel:
    """One sensor of the rig and its streams."""

    sensor: Sensor
    streams: tuple[PacketStream, ...]
    """Its data streams: one per file of the recording."""
    decoder: PacketDecoder


ChooseRig = Callable[[Sequence[Stream]], Rig]
"""Chooses the rig of the LiDARs that were found.

Raises:
    ConfigError: If it cannot.
"""


class PacketCapture:
    """The recording in one or several capture files, all sensors on one clock.

    ``rig`` is the one given, or the one chosen of what sends. Streams go to the sensors of a given
    rig by address and port, but no trickle when a full stream fits too; a sensor left over gets a
    stream left over, in order, which is reported. A sensor that is not in the heads of the files is
    read from when it first sends.
    """

    def __init__(
        self,
        paths: Sequence[Path],
        rig: Rig | ChooseRig,
        *,
        settings: IngestSettings,
        report: ImportReport,
        open_file: OpenFile = open_plain,
    ) -> None:
        """Scan the heads of the files and assign streams to sensors.

        Args:
            paths: Capture files, and files that describe their LiDARs; the same stream in files
                that follow each other is one sensor, in files of the same time it is two.
            rig: The rig, or what chooses one of the LiDARs that send.
            settings: Range limits and reorder window.
            report: Takes counts, warnings and what was derived.
            open_file: How to open the files for reading; a live capture's file still grows.

        Raises:
            UnknownFormat: If a file is not a capture file.
            EmptyRecording: If there is no data packet of a LiDAR in the heads of the files and no
                rig, whose ports and addresses identify later ones.
            ConfigError: If the model of a sensor is not decoded from packets, or no rig can be
                chosen.
        """
        self._report = report
        heads = ImportReport()
        given = rig if isinstance(rig, Rig) else None
        self._companions = [*described_in(given), *companions_of(paths)]
        self._paths = [path for path in paths if path.suffix.lower() not in COMPANION_SUFFIXES]
        scans = (
            scan_pcap(path, open_file=open_file, report=heads, companions=self._companions)
            for path in self._paths
        )
        self.streams = [stream for scan in scans for stream in scan]
        groups = sensors_of(self.streams, open_file)
        if given is None and not groups:
            found = _found_instead(self.streams, heads)
            raise EmptyRecording(CodedText("packets-none", paths=paths[0].name, found=found))
        self.rig = rig if isinstance(rig, Rig) else self._chosen(rig, groups)
        self._warn_of_others()
        self._imu = LidarImu(self.rig, other=self._own_imu(), report=report)
        self.rig = self._imu.rig
        self._settings = settings
        self._channels = self._assign(groups)
        self.streams = [_without_head(stream) for stream in self.streams]
        self._claimed = {(s.source, s.port) for s in self.streams if s.kind == "data"}
        self._samples, self._open = SampleDecoder(report), open_file

    def _chosen(self, choose: ChooseRig, groups: list[tuple[PacketStream, ...]]) -> Rig:
        for stream in self.streams:
            for found in stream.findings:
                self._report.add(found)
        return choose([_lidar(group[0]) for group in groups])

    def read(self) -> Iterator[Shots | PacketSamples]:
        """Stream the whole recording once; the shots of one sensor are in order of time."""
        for path, datagrams in self._merged():
            yield from self._decode_samples(datagrams)  # first: points are mapped with them
            self._find_late(datagrams)
            for channel in self._channels:
                yield from self._decode(channel, path, datagrams)
        for channel in self._channels:
            yield channel.decoder.flush()

    def _merged(self) -> Iterator[tuple[Path, Datagrams]]:
        """The slots of all files in order of time."""
        batches = [self._batches(path) for path in self._paths]
        if len(batches) == 1:  # the merge of one keeps its first, which is the largest
            return batches[0]
        return heapq.merge(*batches, key=lambda batch: int(batch[1].t_ns[0]))

    @property
    def seen(self) -> str:
        """The streams of the heads of the files in words."""
        return _listed(self.streams)

    @property
    def rotation_hz(self) -> dict[str, float]:
        """Measured rotation rate by the name of the sensor [Hz]; complete after reading."""
        return {channel.sensor.name: channel.decoder.rotation_hz for channel in self._channels}

    def _batches(self, path: Path) -> Iterator[tuple[Path, Datagrams]]:
        return ((path, slot) for slot in in_slots(read_datagrams(path, self._report, self._open)))

    def _find_late(self, datagrams: Datagrams) -> None:
        """Start to read sensors that were silent in the heads of the files."""
        if len(self._channels) == len(self.rig.sensors):
            return
        there = {channel.sensor.name for channel in self._channels}
        for row, sensor in enumerate(self.rig.sensors):
            if sensor.name in there:
                continue
            stream = late_stream(
                self._paths[0],
                datagrams,
                sensor,
                claimed=self._claimed,
                companions=self._companions,
            )
            if stream is not None:
                self._claimed.add((stream.source, stream.port))
                streams = tuple(replace(stream, file=path) for path in self._paths)
                self._channels.append(self._channel(row, streams))
                self._report.derive(
                    DerivedKind.SENSOR_LATER, sensor=sensor.name, sender=stream.label
                )

    def _decode(
        self, channel: _Channel, path: Path, datagrams: Datagrams
    ) -> Iterator[Shots | PacketSamples]:
        stream = next((s for s in channel.streams if s.file == path), None)
        if stream is None:
            return
        decoder = channel.decoder
        from_sensor = datagrams.source == address_number(stream.source)
        to_data = from_sensor & (datagrams.port == stream.port)
        whole = to_data & (datagrams.length == decoder.size)
        beside = from_sensor & np.isin(datagrams.length, list(decoder.sample_sizes))
        other = to_data & ~whole & ~beside & ~np.isin(datagrams.length, self._sizes_at(stream))
        self._report.count("packets_wrong_length", int(other.sum()))
        rows = np.flatnonzero(whole)
        if len(rows):  # first: they tell the clock best
            payloads = datagrams.payloads(rows, decoder.size)
            yield from decoder.push_in_parts(datagrams.t_ns[rows], payloads)
        samples = decoder.samples(datagrams.take(beside)) if beside.any() else None
        if samples is not None:
            yield self._imu.of(channel.sensor.name, samples)
        if len(rows) and channel.sensor.name in self._report.ahead_ns:
            ahead_ns = self._report.ahead_ns[channel.sensor.name] - self._report.utc_ahead_ns
            self._report.note_lag(LIDAR, -ahead_ns)

    def _sizes_at(self, stream: PacketStream) -> list[int]:
        """Bytes of the data packets of all sensors behind an address and port."""
        here = (stream.source, stream.port)
        at = [(c.decoder.size, c.streams[0]) for c in self._channels]
        return [size for size, other in at if (other.source, other.port) == here]

    def _decode_samples(self, datagrams: Datagrams) -> Iterator[PacketSamples]:
        """Samples of an IMU or a GNSS receiver on separate ports."""
        ports = {port for port in (self.rig.imu_port, self.rig.gnss_port) if port}
        mine = datagrams.take(np.isin(datagrams.port, list(ports)))
        if len(mine):
            texts = [mine.payload(row) for row in range(len(mine))]
            yield self._imu.of("", PacketSamples(*self._samples.push(mine.t_ns.tolist(), texts)))

    def _assign(self, groups: list[tuple[PacketStream, ...]]) -> list[_Channel]:
        chosen = match_streams(self.rig.sensors, groups, self._companions, report=self._report)
        channels = []
        for row, sensor in enumerate(self.rig.sensors):
            if row not in chosen and (other := self._of_another_make(sensor, chosen)):
                self._report.warn(
                    FindingKind.MODEL_CONTRADICTED,
                    sensor=sensor.name,
                    says=other.model,
                    expected=sensor.model,
                )
                continue
            if row not in chosen:
                self._report.warn(
                    FindingKind.PACKETS_MISSING,
                    sensor=sensor.name,
                    address=sensor.address,
                    anywhere=not sensor.address,
                    port=sensor.port,
                    found=self._sent_instead(sensor, chosen),
                )
                continue
            channels.append(self._channel(row, chosen[row]))
        return channels

    def _warn_of_others(self) -> None:
        """Name senders of much that is not read, such as a LiDAR of another make."""
        most = max((s.packets for s in self.streams if s.kind == "data"), default=0)
        for stream in self.streams:
            known = any(fits(sensor, stream.source, stream.port) for sensor in self.rig.sensors)
            if (
                stream.refused
                and not known
                and stream.packets > CAPTURE_STREAMS.foreign_ratio * most
            ):
                self._report.warn(
                    FindingKind.PACKETS_UNREAD,
                    sender=stream.label,
                    packets=stream.packets,
                    why=stream.refused,
                )
            expected = {"IMU": self.rig.imu_port, "GNSS": self.rig.gnss_port}.get(stream.kind)
            if expected is not None and stream.port != expected:
                self._report.warn(
                    FindingKind.SAMPLES_PORT,
                    what=stream.kind,
                    table=stream.kind.lower(),
                    expected=expected,
                    packets=stream.packets,
                    sender=stream.label,
                    port=stream.port,
                )

    def _own_imu(self) -> str:
        """Sender of an IMU that is in no LiDAR; empty = none, or the rig names a LiDAR with one."""
        own = [s.label for s in self.streams if s.kind == "IMU" and s.port == self.rig.imu_port]
        named = [s for s in self.rig.sensors if s.name == self.rig.imu_sensor]
        if own and any(lidar_model(sensor.model).has_imu for sensor in named):
            self._report.derive(DerivedKind.IMU_CHOSEN, sensor=named[0].name, other=own[0])
            return ""
        return next(iter(own), "")

    def _of_another_make(
        self, sensor: Sensor, chosen: dict[int, tuple[PacketStream, ...]]
    ) -> PacketStream | None:
        """What comes from its address to its port and cannot be of its model."""
        taken = {id(stream) for streams in chosen.values() for stream in streams}
        left = (s for s in self.streams if _is_left(s, taken) and s.model)
        return next((s for s in left if fits(sensor, s.source, s.port)), None)

    def _sent_instead(self, sensor: Sensor, chosen: dict[int, tuple[PacketStream, ...]]) -> str:
        """What is refused of its address and port, or is a LiDAR of another make."""
        taken = {id(stream) for streams in chosen.values() for stream in streams}
        others = [s for s in self.streams if s.refused and fits(sensor, s.source, s.port)]
        return _listed([*others, *(s for s in self.streams if _is_left(s, taken))])

    def _beside(self, data: PacketStream) -> Datagrams:
        """First other packets of a LiDAR: those of its sender to other ports."""
        others = [s for s in self.streams if s.kind == "samples" and s.source == data.source]
        return join_datagrams([stream.head for stream in others])

    def _channel(self, row: int, streams: tuple[PacketStream, ...]) -> _Channel:
        sensor = self.rig.sensors[row]
        of = PacketSensor(
            row=row,
            sensor=sensor,
            head=streams[0].head,
            beside=self._beside(streams[0]),
            companions=self._companions,
            settings=self._settings,
            report=self._report,
        )
        decoder = open_decoder(
            of, utc_offset_ns=streams[0].utc_offset_ns, alone=len(self.rig.sensors) == 1
        )
        return _Channel(sensor, tuple(map(_without_head, streams)), decoder)


def _without_head(stream: PacketStream) -> PacketStream:
    """A stream of points whose sensor is found: its first packets are not needed any more."""
    return replace(stream, head=NO_DATAGRAMS) if stream.kind == "data" else stream


def _found_instead(streams: Sequence[PacketStream], heads: ImportReport) -> str:
    """What capture files without data packets have, and why it is not read."""
    return "; ".join(filter(None, [_listed(streams), unread_text(heads)]))


def _listed(streams: Sequence[PacketStream]) -> str:
    """Some streams in words."""
    texts = [stream.text for stream in streams[: LISTED.streams]]
    more = len(streams) - len(texts)
    texts += [f"{more} other streams"] * (more > 0)
    return "; ".join(texts)


def _is_left(stream: PacketStream, taken: set[int]) -> bool:
    """Whether a stream of points was not taken for a sensor."""
    return stream.kind == "data" and id(stream) not in taken


def sensors_of(streams: list[PacketStream], open_file: OpenFile) -> list[tuple[PacketStream, ...]]:
    """Data streams of one sensor together: same sender and port, in files that follow each other
    or share packets.

    Args:
        streams: Of all files.
        open_file: Opens the files.
    """
    groups: list[list[PacketStream]] = []
    for stream in sorted((s for s in streams if s.kind == "data"), key=lambda s: s.t_first_ns):
        for group in groups:
            if _place(group[-1]) == _place(stream) and _goes_on(group, stream, open_file):
                group.append(stream)
                break
        else:
            groups.append([stream])
    order = {id(stream): place for place, stream in enumerate(streams)}
    return sorted((tuple(group) for group in groups), key=lambda group: order[id(group[0])])


def _goes_on(group: Sequence[PacketStream], stream: PacketStream, open_file: OpenFile) -> bool:
    """Whether a stream is of the sensor of streams that begin before it."""
    beside = [one for one in group if one.t_end_ns > stream.t_first_ns]
    return all(goes_on_in(one, stream, open_file) for one in beside)


def _place(stream: PacketStream) -> tuple[str, int, str]:
    return stream.source, stream.port, stream.shared


def _lidar(stream: PacketStream) -> Stream:
    """The LiDAR that sends a stream."""
    return Stream(
        f"{stream.source}:{stream.port}",
        stream.model or "generic",
        stream.source,
        stream.port,
        serial=stream.found.serial if stream.found and stream.shared else "",
    )
