"""Warnings for the operator of a live capture, the most urgent first. No I/O."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.findings.wording import whole_text
from recon4.live.newest_messages import Newest
from recon4.live.protocol import Fix, Notes, Pose, Sender, Status
from recon4.live.scan_findings import scan_remarks, unobserved_text
from recon4.live.session import loopback_address
from recon4.live.tuning import CAPTURE_WARNINGS
from recon4.model.import_counts import ratio_text
from recon4.model.lidars import lidar_model
from recon4.model.rig import Rig, Sensor
from recon4.model.tuning import OBSERVATION

Level = Literal["error", "warning", "info"]

_BAD_PACKETS = ("packets_duplicate", "packets_out_of_order", "packets_late", "packets_wrong_length")


@dataclass(frozen=True, slots=True)
class CaptureFinding:
    """One line on the phone about the capture now: what fails, and what the operator can do.

    It has no code: it ends with its cause. What stays true of the map is a finding with a code,
    which `WalkSoFar` keeps and puts into a line of its own.
    """

    level: Level
    text: str


def findings(rig: Rig, newest: Newest, problem: str) -> list[CaptureFinding]:
    """Derive the warnings from the newest messages of recorder and mapper.

    Args:
        rig: The sensors that should send.
        newest: Newest messages of recorder and mapper.
        problem: What is wrong with the capture itself; empty = nothing.
    """
    found = [CaptureFinding("error", problem)] if problem else []
    status = newest.status
    if status is not None:
        found += [*_disk(status), *_sensors(rig, status), *_samples(rig, status)]
        found += [*_strangers(rig, status), *_drops(status)]
    found += _too_slow(status, newest.pose)
    if newest.pose is not None:
        found += _tracking(newest.pose)
    if newest.notes is not None:
        found += _reader(newest.notes, lost_here=status is not None and status.kernel_drops > 0)
    if newest.fix is not None:
        found += _position(newest.fix)
    order: dict[Level, int] = {"error": 0, "warning": 1, "info": 2}
    return sorted(found, key=lambda finding: order[finding.level])


def rates(rig: Rig, status: Status) -> dict[str, float]:
    """Datagrams per second of each sensor of a rig, of its IMU and its GNSS receiver."""
    senders = status.senders
    found = {s.name: sum(_rate(s, one) for one in _mine(s, senders)) for s in rig.sensors}
    imu = _imu_senders(rig, senders)
    if imu or (_needs_imu(rig) and not _with_imu(rig)):
        found["IMU"] = sum(one.per_s for one in imu)
    found["GNSS"] = sum(one.per_s for one in senders if one.port == rig.gnss_port != 0)
    return found


def _imu_senders(rig: Rig, senders: list[Sender]) -> list[Sender]:
    """Senders of IMU samples: the IMU of the rig, else what LiDARs with one send beside points."""
    own = [one for one in senders if rig.imu_port and one.port == rig.imu_port]
    ports = {port for sensor in _with_imu(rig) for port in lidar_model(sensor.model).sample_ports}
    return own or [one for one in senders if one.port in ports]


def _with_imu(rig: Rig) -> list[Sensor]:
    """LiDARs with an IMU; some send its samples in their data packets."""
    lidars = [one for one in rig.sensors if one.kind == "lidar"]
    return [s for s in lidars if s.name == rig.imu_sensor or lidar_model(s.model).has_imu]


def _mine(sensor: Sensor, senders: list[Sender]) -> list[Sender]:
    """Senders that can be this sensor: they send data packets to its port."""
    return [
        one
        for one in senders
        if one.port == sensor.port
        and (not sensor.address or one.source in _addresses(sensor))
        and (_rate(sensor, one) > 0 or one.silent_s > 0.5)
    ]


def _addresses(sensor: Sensor) -> set[str]:
    """Where the packets of a sensor come from, or those of its replay on this computer."""
    return {sensor.address, loopback_address(sensor.address)} - {""}


def _rate(sensor: Sensor, sender: Sender) -> float:
    """Datagrams per second that can be measurements: LiDARs send packets of one size."""
    return sender.data_per_s if sensor.kind == "lidar" else sender.per_s


def _disk(status: Status) -> list[CaptureFinding]:
    found = []
    file, left_s = status.file, status.disk.left_s
    if file.problem:
        found.append(CaptureFinding("error", f"Nothing is recorded: {file.problem}"))
    if left_s is not None and left_s < CAPTURE_WARNINGS.low_disk_s:
        found.append(CaptureFinding("error", f"Disk full in {max(left_s, 0) // 60} min"))
    if status.notes:
        found.append(CaptureFinding("error", f"A mark could not be saved: {status.notes}"))
    if status.paused:
        found.append(CaptureFinding("info", "Paused: nothing is recorded"))
    return found


def _sensors(rig: Rig, status: Status) -> list[CaptureFinding]:
    silent_s = {s.name: _silent_s(_mine(s, status.senders), status) for s in rig.sensors}
    silent = {
        name: seconds for name, seconds in silent_s.items() if seconds >= CAPTURE_WARNINGS.silent_s
    }
    if silent and len(silent) == len(silent_s):
        shortest = min(silent.values())
        arrives = _arriving(rig, status)
        what = "LiDAR" if all(sensor.kind == "lidar" for sensor in rig.sensors) else "scanner"
        if arrives:
            return [CaptureFinding("error", f"No {what} of the rig sends: {arrives}")]
        text = f"No {what} sends anything for {_seconds(shortest)}: check power and cables"
        return [CaptureFinding("error", text)]
    return [
        CaptureFinding("error", f"{_title(sensor)} silent for {_seconds(silent[sensor.name])}")
        for sensor in rig.sensors
        if sensor.name in silent
    ]


def _title(sensor: Sensor) -> str:
    """A sensor on the screen; there is only one of the kinds without a name."""
    titles = {"laser2d": "2-D laser", "profiler": "Profiler"}
    return titles.get(sensor.kind, f"{sensor.name} LiDAR")


def _arriving(rig: Rig, status: Status) -> str:
    """Datagrams on the LiDARs' ports although no LiDAR of the rig sends; empty = none."""
    for sensor in rig.sensors:
        there = [one for one in status.senders if one.port == sensor.port]
        if sensor.kind != "lidar":
            other = [one for one in there if one.per_s > 0 and one.source not in _addresses(sensor)]
            if sensor.address and other:
                return (
                    f"{sensor.name} is expected from {sensor.address}, but datagrams for port "
                    f"{sensor.port} come from {_sources(other)}: correct the address in the rig or "
                    "in the sender"
                )
            continue
        data = [one for one in there if one.data_per_s > 0 and one.source not in _addresses(sensor)]
        if sensor.address and data:
            return (
                f"{sensor.name} is expected from {sensor.address}, but data packets for port "
                f"{sensor.port} come from {_sources(data)}: correct the address in the rig or in "
                "the sensor"
            )
        other = [one for one in there if one.per_s > 0]
        if other:
            return (
                f"datagrams for port {sensor.port} ({sensor.name}) come from {_sources(other)}, "
                "but they are not LiDAR data packets"
            )
    return ""


def _sources(senders: list[Sender]) -> str:
    """Addresses of senders, at most three of them."""
    sources = sorted({one.source for one in senders})
    return ", ".join(sources[:3]) + " …" * (len(sources) > 3)


def _silent_s(senders: list[Sender], status: Status) -> float:
    """Time since the last datagram of some senders [s]; 0 soon after the start."""
    if senders:
        return min(one.silent_s for one in senders)
    return status.seconds if status.seconds >= CAPTURE_WARNINGS.grace_s else 0.0


def _samples(rig: Rig, status: Status) -> list[CaptureFinding]:
    found = []
    imu = _imu_senders(rig, status.senders)
    silent_s = _silent_s(imu, status)
    if imu and silent_s >= CAPTURE_WARNINGS.silent_s:
        found.append(CaptureFinding("warning", f"IMU silent for {_seconds(silent_s)}: turn slowly"))
    elif silent_s >= CAPTURE_WARNINGS.silent_s and _needs_imu(rig) and not _with_imu(rig):
        found.append(CaptureFinding("warning", "No IMU: walk and turn slowly"))
    if status.serial:
        found.append(CaptureFinding("warning", f"GNSS receiver: {status.serial}"))
    return found


def _needs_imu(rig: Rig) -> bool:
    """A 2-D laser alone may stand on a robot."""
    return any(sensor.kind != "laser2d" for sensor in rig.sensors)


def _strangers(rig: Rig, status: Status) -> list[CaptureFinding]:
    """Foreign senders to a LiDAR's port, and datagrams there that are not data packets."""
    ports: dict[int, list[Sensor]] = {}
    for sensor in rig.sensors:
        ports.setdefault(sensor.port, []).append(sensor)
    found = []
    for port, sensors in ports.items():
        there = [one for one in status.senders if one.port == port and one.per_s > 0]
        there.sort(key=lambda one: -_rate(sensors[0], one))
        known = set[str]().union(*map(_addresses, sensors)) or {
            one.source for one in there[: len(sensors)]
        }
        strangers = sorted({one.source for one in there if one.source not in known})
        mixed = [one for one in there if one.per_s - one.data_per_s > 0]
        if strangers:
            some = ", ".join(strangers[:3]) + (" …" if len(strangers) > 3 else "")
            found.append(CaptureFinding("info", f"Foreign traffic on port {port} from {some}"))
        elif mixed and sensors[0].kind == "lidar":
            source = mixed[0].source
            text = f"Packets on port {port} that are not LiDAR data packets, from {source}"
            found.append(CaptureFinding("info", text))
    return found


def _drops(status: Status) -> list[CaptureFinding]:
    count = status.file.dropped
    text = f"{count} packets are not in the recording: the disk was full or too slow"
    return [CaptureFinding("error", text)] if count else []


def _tracking(pose: Pose) -> list[CaptureFinding]:
    found = []
    if pose.lost:
        found.append(CaptureFinding("error", "Tracking lost: stop, then go back a few steps"))
    elif (pose.turn_rad_s or 0.0) > CAPTURE_WARNINGS.turn_rad_s:
        found.append(CaptureFinding("warning", "Turn slower"))
    elif unobserved_text(pose):
        found.append(CaptureFinding("warning", unobserved_text(pose)))
    elif _degraded(pose) and not _behind(pose):
        found.append(
            CaptureFinding("warning", "Tracking is degraded: walk slower, look at more walls")
        )
    if pose.remark:
        found.append(CaptureFinding("warning", f"{pose.remark[0].upper()}{pose.remark[1:]}"))
    return found


def _too_slow(status: Status | None, pose: Pose | None) -> list[CaptureFinding]:
    """One finding for all that a computer without enough time does.

    Frames are left out of the preview, never of the recording; packets that the kernel drops are
    in neither.
    """
    lost = status.kernel_drops if status is not None else 0
    late = _late(pose) if pose is not None else ""
    if lost:
        behind = f"; {late[0].lower()}{late[1:]}" if late else ""
        text = f"{lost} packets were lost: this computer is too busy{behind}"
        return [CaptureFinding("error", text)]
    level: Level = "warning" if pose is not None and _behind(pose) else "info"
    return [CaptureFinding(level, f"{late}; the recording is complete")] if late else []


def _behind(pose: Pose) -> bool:
    return pose.age_s > CAPTURE_WARNINGS.late_s


def _late(pose: Pose) -> str:
    """Latency of the preview in words; empty = there is none."""
    recent = pose.lately
    behind = f"The preview is {pose.age_s:.0f} s behind" if _behind(pose) else ""
    left_out = (
        f"{recent.thinned} of the last {recent.frames} frames are left out of the preview "
        f"({pose.thinned} in all)"
        if recent.thinned
        else ""
    )
    return ": ".join(part for part in (behind, left_out) if part)


def _degraded(pose: Pose) -> bool:
    """Whether tracking is degraded: poor match, residual, prediction or observability."""
    match_ratio, weak_sd_m = pose.match_ratio, pose.weak_sd_m
    registered = pose.frame_id > 0
    return bool(
        (
            registered
            and match_ratio is not None
            and match_ratio < CAPTURE_WARNINGS.degraded_match_ratio
        )
        or (registered and weak_sd_m is not None and weak_sd_m > OBSERVATION.weak_sd_m)
        or (pose.error_m or 0.0) > CAPTURE_WARNINGS.degraded_error_m
        or (pose.prediction_offset_m or 0.0) > CAPTURE_WARNINGS.degraded_offset_m
    )


def _reader(notes: Notes, *, lost_here: bool) -> list[CaptureFinding]:
    """What the reader repairs; packets that this computer lost are no fault of the cable."""
    found = [CaptureFinding("warning", whole_text(one)) for one in notes.findings[-3:]]
    found += [CaptureFinding("warning", text) for text in scan_remarks(notes)]
    recent = notes.recent
    packets, missing = recent.get("packets", 0), recent.get("packets_missing", 0)
    if packets > 1000 and missing > CAPTURE_WARNINGS.max_lost * packets and not lost_here:
        text = ratio_text("packets_missing", missing / (packets + missing))
        found.append(CaptureFinding("warning", text))
    for name in _BAD_PACKETS:
        if packets > 1000 and recent.get(name, 0) > CAPTURE_WARNINGS.max_lost * packets:
            text = ratio_text(name, recent[name] / packets)
            found.append(CaptureFinding("info", text))
    return found


def _position(fix: Fix) -> list[CaptureFinding]:
    if fix.jumped_m:
        text = f"GNSS jumped by {fix.jumped_m:.0f} m: the map does not use it"
        return [CaptureFinding("warning", text)]
    sd_m = fix.sd_m
    within = f", ±{max(sd_m[:2]):.2g} m" if sd_m else ""
    if fix.quality == 0:
        return [CaptureFinding("info", "GNSS has no position")]
    return (
        [] if fix.quality in (4, 5) else [CaptureFinding("info", f"GNSS without RTK fix{within}")]
    )


def _seconds(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"
