"""Which metadata file belongs to which sender."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from recon4.errors import ConfigError, CorruptFile
from recon4.geometry.distinct import distinct
from recon4.locales.coded import CodedText, joined, text_of
from recon4.model.finding import Finding
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Sensor
from recon4.recording.formats.datagrams import Datagrams, address_text
from recon4.recording.packets.family import Companion, Payloads, same_start
from recon4.recording.packets.ouster.columns import sound_columns
from recon4.recording.packets.ouster.layouts import (
    FUSA_HEADER,
    HEADER_BYTES,
    STANDARD_HEADER,
    TYPE_DATA,
    TYPE_IMU,
    PacketLayout,
    numbers,
)
from recon4.recording.packets.ouster.metadata import OusterMetadata, read_metadata
from recon4.recording.packets.ouster.tuning import SHARED_ADDRESS
from recon4.recording.packets.tuning import HEAD
from recon4.recording.report import warning


@dataclass(frozen=True, slots=True)
class MetadataFiles:
    """The metadata files beside a recording."""

    metadata: tuple[OusterMetadata, ...]
    damaged: tuple[str, ...]
    """Why others cannot be read."""


@dataclass(frozen=True, slots=True)
class ChosenMetadata:
    """The metadata of a sender."""

    metadata: OusterMetadata
    doubts: tuple[Finding, ...]
    """How the packets contradict it."""
    passed_over: str
    """Files that only their names have ruled out."""


def find_metadata(companions: Sequence[Companion]) -> MetadataFiles:
    """Read all metadata files among some files."""
    found, damaged = list[OusterMetadata](), list[str]()
    for companion in companions:
        try:
            metadata = read_metadata(companion)
        except CorruptFile as error:
            damaged.append(text_of(error))
        else:
            found += [metadata] if metadata else []
    return MetadataFiles(tuple(found), tuple(damaged))


def sound_head(head: Datagrams, layout: PacketLayout) -> Payloads:
    """The first datagrams that are data packets of a layout, (N, size)."""
    rows = np.flatnonzero(head.length == layout.size)[: HEAD.packets]
    payloads = head.payloads(rows, layout.size)
    return payloads[sound_columns(layout, payloads)] if len(rows) else payloads


def layout_fits(head: Datagrams, layout: PacketLayout) -> bool:
    """Whether most datagrams of the size of a layout are data packets of it; not without any."""
    of_size = int((head.length == layout.size).sum())
    return of_size > 0 and 2 * len(sound_head(head, layout)) > min(of_size, HEAD.packets)


def usual_serial(layout: PacketLayout, payloads: Payloads) -> str:
    """Serial number of most packets; empty if they have none."""
    return str(_usual(layout, payloads, "serial") or "")


def serials(layout: PacketLayout, payloads: Payloads) -> NDArray[np.int64]:
    """Serial numbers in the headers, (P,)."""
    return numbers(layout.records(payloads)["header"]["serial"])


def _usual(layout: PacketLayout, payloads: Payloads, field: str) -> int:
    """The most frequent value in the headers; 0 if they have none."""
    if not layout.profile.has_header or not len(payloads):
        return 0
    values, count = np.unique(
        numbers(layout.records(payloads)["header"][field]), return_counts=True
    )
    return int(values[np.argmax(count)])


def choose(
    head: Datagrams, found: MetadataFiles, sensor: Sensor | None = None
) -> ChosenMetadata | None:
    """The metadata of the sender of some datagrams; None if there is none that fits.

    Size and contents of its packets decide, then serial number, start of the sensor (``init_id``),
    and whether the name of the file holds the address or the sensor's name. A file that states
    another port is out if one is left that does not: many sensors send to the same port. At last
    the name counts that begins most like that of the recording or topic.

    Raises:
        ConfigError: If several fit equally and give other points.
    """
    fitting = [item for item in found.metadata if not len(head) or layout_fits(head, item.layout)]
    if not fitting:
        return None
    likeness = [_likeness(item, sensor) for item in fitting]
    known = _best(fitting, [_rank(head, item, sensor) for item in fitting])
    best = _best(known, [likeness[fitting.index(item)] for item in known])
    if not _same_points(best):
        names = ", ".join(item.name for item in best)
        raise ConfigError(
            CodedText("ouster-metadata-choice", head=_sender(head, sensor), names=names)
        )
    by_name = "" if _same_points(known) else ", ".join(k.name for k in known if k is not best[0])
    return ChosenMetadata(best[0], _doubts(head, best[0]), by_name)


_Rank = TypeVar("_Rank", tuple[bool, ...], int)


def _best(items: list[OusterMetadata], ranks: list[_Rank]) -> list[OusterMetadata]:
    return [item for item, rank in zip(items, ranks, strict=True) if rank == max(ranks)]


def _same_points(items: Sequence[OusterMetadata]) -> bool:
    return all(items[0].same_geometry(item) for item in items[1:])


def _likeness(item: OusterMetadata, sensor: Sensor | None) -> int:
    topic = sensor.topic if sensor else ""
    return max(item.likeness, same_start(topic, item.name))


def _rank(head: Datagrams, item: OusterMetadata, sensor: Sensor | None) -> tuple[bool, ...]:
    """Better fits are larger."""
    payloads = sound_head(head, item.layout)
    serial = usual_serial(item.layout, payloads) or (sensor.serial if sensor else "")
    init_id = _usual(item.layout, payloads, "init_id")
    ports = set(head.port[:1].tolist()) or ({sensor.port} if sensor else set())
    names = [address_text(int(source)) for source in head.source[:1] if source]
    names += [sensor.name, sensor.address] if sensor else []
    return (
        bool(serial) and serial == item.serial,
        bool(init_id) and init_id == item.init_id,
        any(name and _is_in(name, item.name) for name in names),
        ports == {0} or item.port in {0, *ports},
    )


def _is_in(name: str, file_name: str) -> bool:
    """Whether a name stands in that of a file, not as a part of another: 10.0.0.1, 10.0.0.12."""
    around = "[A-Za-z0-9]"
    return bool(re.search(f"(?<!{around}){re.escape(name)}(?!{around})", file_name))


def _doubts(head: Datagrams, item: OusterMetadata) -> tuple[Finding, ...]:
    serial = usual_serial(item.layout, sound_head(head, item.layout))
    if serial and item.serial and serial != item.serial:
        values = {"name": item.name, "serial": str(item.serial), "packets": str(serial)}
        return (warning(FindingKind.METADATA_ELSEWHERE, **values),)
    return ()


def missing_text(head: Datagrams, found: MetadataFiles, sensor: Sensor) -> str:
    """Why there is no metadata for a sensor, for a message."""
    sizes = distinct(head.length).tolist()
    seen = [_other_packets(item, sizes) for item in found.metadata]
    needed = CodedText("ouster-metadata-needed", sensor=_sender(head, sensor))
    return joined([needed, *seen, *found.damaged])


def _other_packets(item: OusterMetadata, sizes: Sequence[int]) -> CodedText:
    same = item.layout.size in sizes
    return CodedText(
        "ouster-metadata-of-others",
        name=item.name,
        bytes=item.layout.size,
        profile=item.layout.profile.name,
        beams=item.layout.beams,
        columns=item.layout.columns,
        sizes="" if same else ", ".join(map(str, sizes[:4])),
        here="contents" if same else "sizes",
    )


def _sender(head: Datagrams, sensor: Sensor | None) -> str:
    if sensor is not None:
        return sensor.name
    return address_text(int(head.source[0])) if len(head) else "a sensor"


def header_serials(payloads: Payloads) -> NDArray[np.int64]:
    """Serial numbers in the headers of data and IMU packets, (N,); -1 = they have none."""
    serial = np.full(len(payloads), -1, dtype=np.int64)
    if payloads.shape[1] < HEADER_BYTES:
        return serial
    begin = np.ascontiguousarray(payloads[:, :HEADER_BYTES])
    for header, types in ((STANDARD_HEADER, (TYPE_DATA, TYPE_IMU)), (FUSA_HEADER, (TYPE_DATA,))):
        record = begin.view(header)[:, 0]
        known = np.isin(record["type"], types) & (serial < 0)
        serial[known] = numbers(record["serial"][known])
    return serial


def parts_by_sensor(head: Datagrams) -> list[NDArray[np.bool_]]:
    """Rows of the datagrams of each sensor behind one address, if several send data packets.

    They differ by the serial numbers in the headers, or by the size of their packets.
    """
    data = head.length >= SHARED_ADDRESS.smallest_bytes
    serial = np.full(len(head), -1, dtype=np.int64)
    rows = np.flatnonzero(data)
    serial[rows] = header_serials(head.payloads(rows, HEADER_BYTES))
    _, of, count = np.unique(
        np.column_stack([serial, head.length])[data],
        axis=0,
        return_inverse=True,
        return_counts=True,
    )
    usual = np.flatnonzero(SHARED_ADDRESS.fewest_ratio * count > data.sum())
    if not 1 < len(usual) <= SHARED_ADDRESS.sensors:
        return [np.ones(len(head), dtype=np.bool_)]
    parts = [np.zeros(len(head), dtype=np.bool_) for _ in usual]
    for part, key in zip(parts, usual.tolist(), strict=True):
        part[rows[of.reshape(-1) == key]] = True
    return parts
