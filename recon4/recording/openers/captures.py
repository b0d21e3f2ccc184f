"""Openers of capture files: datagrams of scans, packets of LiDARs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

from recon4.model.derived_kinds import DerivedKind
from recon4.model.rig import Rig, load_rig
from recon4.recording.formats.datagrams import address_text
from recon4.recording.frame_files.copies import without_copies
from recon4.recording.info.files_near import COMPANION_SUFFIXES
from recon4.recording.kinds import capture_files
from recon4.recording.lasers.scan_capture import ScanCapture, scan_streams
from recon4.recording.openers.request import Item, OpenRequest, Recording
from recon4.recording.packets.capture import ChooseRig, PacketCapture
from recon4.recording.packets.family import PacketSamples
from recon4.recording.packets.livox.lvx import read_lvx_head
from recon4.recording.packets.streams import PacketStream, require_one_capture
from recon4.recording.packets.tuning import CAPTURE_STREAMS
from recon4.recording.rigs.choice import Stream, choose_rig, rig_to_complete, with_lidars
from recon4.recording.rigs.mismatch import mismatch_text
from recon4.recording.rigs.profiler import WUERZBURG


def open_scan_capture(request: OpenRequest) -> Recording | None:
    """Datagrams with scans of 2-D lasers or of a profiler."""
    files = _files(request)
    rig = _scan_rig(files, request)
    if rig is None:
        return None
    scans = ScanCapture(files, rig, report=request.report, open_file=request.open_file)
    return Recording(rig, scans.read)


def open_lidar_capture(request: OpenRequest) -> Recording:
    """Packets of LiDARs; they are searched for in every capture that nobody else reads."""
    return _opened(request, request.rig or partial(choose_rig, report=request.report))


def open_lvx(request: OpenRequest) -> Recording:
    """Files of Livox Viewer; several devices are mounted as the file says."""
    return _opened(request, request.rig or partial(_rig_of_devices, request=request))


def _opened(request: OpenRequest, rig: Rig | ChooseRig) -> Recording:
    pcap = PacketCapture(
        [*_files(request), *_companions(request)],
        rig,
        settings=request.settings,
        report=request.report,
        open_file=request.open_file,
    )
    return Recording(
        pcap.rig,
        partial(_read_pcap, pcap),
        _seconds(pcap.streams),
        wait_s=CAPTURE_STREAMS.wait_s,
        seen=mismatch_text(rig, pcap.seen) if isinstance(rig, Rig) else "",
    )


def _rig_of_devices(streams: Sequence[Stream], request: OpenRequest) -> Rig:
    """The devices of LVX files with the mounts in them, if there are several with mounts."""
    files = _files(request)
    devices = {
        address_text(device.address): device
        for file in files
        for device in read_lvx_head(file).devices
    }
    heads = rig_to_complete(streams)
    found = [(sensor, devices[sensor.address]) for sensor in heads.sensors]
    mounted = [
        replace(sensor, T_body_sensor=device.mount, serial=device.serial)
        for sensor, device in found
        if device.mount is not None
    ]
    if len(found) < 2 or len(mounted) < len(found):
        return choose_rig(streams, request.report)
    names = ", ".join(f"{s.name} ({s.model}, {s.serial})" for s in mounted)
    request.report.derive(DerivedKind.RIG_CHOSEN, sensors=names, by_file=True)
    return with_lidars(heads, mounted)


def _companions(request: OpenRequest) -> list[Path]:
    return [path for path in request.paths if path.suffix.lower() in COMPANION_SUFFIXES]


def _files(request: OpenRequest) -> list[Path]:
    captures = [p for p in request.paths if p.suffix.lower() not in COMPANION_SUFFIXES]
    files = [file for path in captures for file in capture_files(path)]
    require_one_capture(files)
    return without_copies(files, request.report)


def _scan_rig(files: Sequence[Path], request: OpenRequest) -> Rig | None:
    """The rig of captured datagrams of scans; None = they are packets of LiDARs."""
    if (rig := request.rig) is not None:
        kinds = {sensor.kind for sensor in rig.sensors if sensor.enabled}
        return rig if kinds <= {"laser2d", "profiler"} else None
    if not scan_streams(files).heads:
        return None
    request.report.derive(DerivedKind.RIG_CHOSEN, preset=WUERZBURG, line_scans=True)
    return load_rig(WUERZBURG)


def _seconds(streams: Sequence[PacketStream]) -> float:
    """Duration of capture files [s]; an estimate for large files."""
    if not streams:
        return 0.0
    return (max(s.t_end_ns for s in streams) - min(s.t_first_ns for s in streams)) / 1e9


def _read_pcap(pcap: PacketCapture) -> Iterator[Item]:
    for item in pcap.read():
        if not isinstance(item, PacketSamples):
            yield item
            continue
        if item.imu is not None:
            yield item.imu
        if item.gnss is not None:
            yield item.gnss
