"""Warnings for the operator of a live capture, the most urgent first. No I/O."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from recon4.findings.wording import whole_text
from recon4.live.newest_messages import Newest
from recon4.live.protocol import Fix, Notes, Pose, Sender, Status
from recon4.live.scan_findings import scan_remarks, unobserved_text
from recon4.live.session import loopback_address
from recon4.live.shared_port import senders_to_another_port
from recon4.live.tuning import CAPTURE_WARNINGS
from recon4.locales.languages import ENGLISH
from recon4.locales.texts import Texts, texts
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


def capture_texts(language: str) -> Texts:
    """The texts of these warnings."""
    return texts(language, "capture")


def findings(
    rig: Rig, newest: Newest, problem: str, *, language: str = ENGLISH
) -> list[CaptureFinding]:
    """Derive the warnings from the newest messages of recorder and mapper.

    Args:
        rig: The sensors that should send.
        newest: Newest messages of recorder and mapper.
        problem: What is wrong with the capture itself; empty = nothing.
        language: Of the texts.
    """
    say = capture_texts(language)
    found = [CaptureFinding("error", problem)] if problem else []
    status = newest.status
    if status is not None:
        found += [*_disk(status, say), *_sensors(rig, status, say), *_samples(rig, status, say)]
        found += [*_strangers(rig, status, say), *_drops(status, say)]
    found += _too_slow(status, newest.pose, say)
    if newest.pose is not None:
        found += _tracking(newest.pose, say)
    if newest.notes is not None:
        lost_here = status is not None and status.kernel_drops > 0
        found += _reader(newest.notes, say, lost_here=lost_here)
    if newest.fix is not None:
        found += _position(newest.fix, say)
    order: dict[Level, int] = {"error": 0, "warning": 1, "info": 2}
    return sorted(found, key=lambda finding: order[finding.level])


def rates(rig: Rig, status: Status) -> dict[str, float]:
    """Datagrams per second of each sensor of a rig, of its IMU and its GNSS receiver."""
    senders = status.senders
    taken = _taken(rig, senders)
    found = {
        s.name: sum(_rate(s, one) for one in _mine(s, senders) or taken.get(s.name, []))
        for s in rig.sensors
    }
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


def _taken(rig: Rig, senders: list[Sender]) -> dict[str, list[Sender]]:
    """Sensor -> the one sender of another address that the reader takes for it.

    `recon4.recording.packets.capture` takes any full stream that is left; here it has to be the
    only one on the port of the LiDAR, so that no other can be meant.
    """
    claimed = [one for sensor in rig.sensors for one in _mine(sensor, senders)]
    least = CAPTURE_WARNINGS.taken_ratio * max((one.data_per_s for one in senders), default=0.0)
    found: dict[str, list[Sender]] = {}
    for sensor in rig.sensors:
        if sensor.kind != "lidar" or not sensor.address or _mine(sensor, senders):
            continue
        left = [one for one in senders if one.port == sensor.port and one not in claimed]
        full = [one for one in left if one.data_per_s > 0.0 and one.data_per_s >= least]
        if len(full) == 1:
            found[sensor.name] = full
            claimed += full
    return found


def _addresses(sensor: Sensor) -> set[str]:
    """Where the packets of a sensor come from, or those of its replay on this computer."""
    return {sensor.address, loopback_address(sensor.address)} - {""}


def _rate(sensor: Sensor, sender: Sender) -> float:
    """Datagrams per second that can be measurements: LiDARs send packets of one size."""
    return sender.data_per_s if sensor.kind == "lidar" else sender.per_s


def _disk(status: Status, say: Texts) -> list[CaptureFinding]:
    found = []
    file, left_s = status.file, status.disk.left_s
    if file.problem:
        found.append(CaptureFinding("error", say("nothing-recorded", problem=file.problem)))
    if left_s is not None and left_s < CAPTURE_WARNINGS.low_disk_s:
        found.append(CaptureFinding("error", say("disk-full", minutes=str(max(left_s, 0) // 60))))
    if status.notes:
        found.append(CaptureFinding("error", say("mark-unsaved", problem=status.notes)))
    if status.paused:
        found.append(CaptureFinding("info", say("paused")))
    return found


def _sensors(rig: Rig, status: Status, say: Texts) -> list[CaptureFinding]:
    taken = _taken(rig, status.senders)
    silent_s = {
        s.name: _silent_s(_mine(s, status.senders) or taken.get(s.name, []), status)
        for s in rig.sensors
    }
    elsewhere = [
        CaptureFinding("info", _sent_elsewhere(s, taken[s.name][0], say))
        for s in rig.sensors
        if s.name in taken
    ]
    silent = {
        name: seconds for name, seconds in silent_s.items() if seconds >= CAPTURE_WARNINGS.silent_s
    }
    if silent and len(silent) == len(silent_s):
        shortest = min(silent.values())
        arrives = _arriving(rig, status, say)
        only_lidars = all(sensor.kind == "lidar" for sensor in rig.sensors)
        what = say("what-lidar" if only_lidars else "what-scanner")
        if arrives:
            return [CaptureFinding("error", say("none-sends", what=what, arrives=arrives))]
        ports = ", ".join(str(port) for port in sorted({s.port for s in rig.sensors}))
        known = {"what": what, "ports": say("ports", ports=ports)}
        text = say("none-sends-anything", time=_seconds(shortest, say), **known)
        return [CaptureFinding("error", text)]
    return elsewhere + [
        CaptureFinding("error", _silence(sensor, rig, status, time=time, say=say))
        for sensor in rig.sensors
        if sensor.name in silent and (time := _seconds(silent[sensor.name], say))
    ]


def _silence(sensor: Sensor, rig: Rig, status: Status, *, time: str, say: Texts) -> str:
    there = senders_to_another_port(rig, status.senders, sensor)
    known = {"sensor": _title(sensor, say), "time": time}
    if not there:
        return say("sensor-silent", **known)
    ports = {"own": str(sensor.port), "port": str(there[0].port), "sources": _sources(there)}
    return say("sensor-silent-shared", **known, **ports)


def _sent_elsewhere(sensor: Sensor, sender: Sender, say: Texts) -> str:
    return say(
        "sensor-elsewhere",
        sensor=_title(sensor, say),
        source=sender.source,
        address=sensor.address,
    )


def _title(sensor: Sensor, say: Texts) -> str:
    """A sensor on the screen; there is only one of the kinds without a name."""
    titles = {"laser2d": "title-laser2d", "profiler": "title-profiler"}
    return say(titles.get(sensor.kind, "title-lidar"), name=sensor.name)


def _arriving(rig: Rig, status: Status, say: Texts) -> str:
    """Datagrams on the LiDARs' ports although no LiDAR of the rig sends; empty = none."""
    for sensor in rig.sensors:
        there = [one for one in status.senders if one.port == sensor.port]
        known = {"sensor": sensor.name, "address": sensor.address, "port": str(sensor.port)}
        others = [one for one in there if one.source not in _addresses(sensor)]
        if sensor.kind != "lidar":
            other = [one for one in others if one.per_s > 0]
            if sensor.address and other:
                return say("datagrams-elsewhere", **known, sources=_sources(other))
            continue
        data = [one for one in others if one.data_per_s > 0]
        if sensor.address and data:
            return say("packets-elsewhere", **known, sources=_sources(data))
        other = [one for one in there if one.per_s > 0]
        if other:
            return say("no-data-packets", **known, sources=_sources(other))
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


def _samples(rig: Rig, status: Status, say: Texts) -> list[CaptureFinding]:
    found = []
    imu = _imu_senders(rig, status.senders)
    silent_s = _silent_s(imu, status)
    if imu and silent_s >= CAPTURE_WARNINGS.silent_s:
        text = say("imu-silent", time=_seconds(silent_s, say))
        found.append(CaptureFinding("warning", text))
    elif silent_s >= CAPTURE_WARNINGS.silent_s and _needs_imu(rig) and not _with_imu(rig):
        found.append(CaptureFinding("warning", say("imu-none")))
    if status.serial:
        found.append(CaptureFinding("warning", say("gnss-receiver", problem=status.serial)))
    return found


def _needs_imu(rig: Rig) -> bool:
    """A 2-D laser alone may stand on a robot."""
    return any(sensor.kind != "laser2d" for sensor in rig.sensors)


def _strangers(rig: Rig, status: Status, say: Texts) -> list[CaptureFinding]:
    """Foreign senders to a LiDAR's port, and datagrams there that are not data packets."""
    ports: dict[int, list[Sensor]] = {}
    for sensor in rig.sensors:
        ports.setdefault(sensor.port, []).append(sensor)
    found = []
    taken = {one.source for some in _taken(rig, status.senders).values() for one in some}
    for port, sensors in ports.items():
        there = [one for one in status.senders if one.port == port and one.per_s > 0]
        there.sort(key=lambda one: -_rate(sensors[0], one))
        known = set[str]().union(*map(_addresses, sensors)) or {
            one.source for one in there[: len(sensors)]
        }
        strangers = sorted({one.source for one in there if one.source not in known | taken})
        mixed = [one for one in there if one.per_s - one.data_per_s > 0]
        if strangers:
            some = ", ".join(strangers[:3]) + (" …" if len(strangers) > 3 else "")
            text = say("foreign-traffic", port=str(port), sources=some)
            found.append(CaptureFinding("info", text))
        elif mixed and sensors[0].kind == "lidar":
            text = say("packets-not-lidar", port=str(port), source=mixed[0].source)
            found.append(CaptureFinding("info", text))
    return found


def _drops(status: Status, say: Texts) -> list[CaptureFinding]:
    count = status.file.dropped
    text = say("packets-not-recorded", count=count)
    return [CaptureFinding("error", text)] if count else []


def _tracking(pose: Pose, say: Texts) -> list[CaptureFinding]:
    found = []
    if pose.lost:
        found.append(CaptureFinding("error", say("tracking-lost")))
    elif (pose.turn_rad_s or 0.0) > CAPTURE_WARNINGS.turn_rad_s:
        found.append(CaptureFinding("warning", say("turn-slower")))
    elif unobserved := unobserved_text(pose, say):
        found.append(CaptureFinding("warning", unobserved))
    elif _degraded(pose) and not _behind(pose):
        found.append(CaptureFinding("warning", say("tracking-degraded")))
    if pose.remark:
        found.append(CaptureFinding("warning", _remark(pose.remark, say)))
    return found


def _remark(remark: str, say: Texts) -> str:
    """A remark of the mapper in words: its code, and what it is about."""
    code, _, why = remark.partition(" ")
    if f"remark-{code}" not in say:
        return remark
    return say(f"remark-{code}", why=say(f"why-{why}") if why else "")


def _too_slow(status: Status | None, pose: Pose | None, say: Texts) -> list[CaptureFinding]:
    """One finding for all that a computer without enough time does.

    Frames are left out of the preview, never of the recording; packets that the kernel drops are
    in neither.
    """
    lost = status.kernel_drops if status is not None else 0
    late = _late(pose, say) if pose is not None else ""
    if lost:
        late = late[:1].lower() + late[1:]  # within a sentence
        text = say("packets-lost-late" if late else "packets-lost", count=lost, late=late)
        return [CaptureFinding("error", text)]
    level: Level = "warning" if pose is not None and _behind(pose) else "info"
    return [CaptureFinding(level, say("preview-late", late=late))] if late else []


def _behind(pose: Pose) -> bool:
    return pose.age_s > CAPTURE_WARNINGS.late_s


def _late(pose: Pose, say: Texts) -> str:
    """Latency of the preview in words; empty = there is none."""
    recent, parts = pose.lately, []
    if _behind(pose):
        parts.append(say("preview-behind", seconds=pose.age_s))
    if recent.thinned:
        counts = {"thinned": recent.thinned, "frames": recent.frames, "all": pose.thinned}
        parts.append(say("frames-left-out", **counts))
    return ": ".join(parts)


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


def _reader(notes: Notes, say: Texts, *, lost_here: bool) -> list[CaptureFinding]:
    """What the reader repairs; packets that this computer lost are no fault of the cable."""
    language = say.language
    found = [CaptureFinding("warning", whole_text(one, language)) for one in notes.findings[-3:]]
    found += [CaptureFinding("warning", text) for text in scan_remarks(notes, say)]
    recent = notes.recent
    packets, missing = recent.get("packets", 0), recent.get("packets_missing", 0)
    if packets > 1000 and missing > CAPTURE_WARNINGS.max_lost * packets and not lost_here:
        text = ratio_text("packets_missing", missing / (packets + missing), language)
        found.append(CaptureFinding("warning", text))
    for name in _BAD_PACKETS:
        if packets > 1000 and recent.get(name, 0) > CAPTURE_WARNINGS.max_lost * packets:
            text = ratio_text(name, recent[name] / packets, language)
            found.append(CaptureFinding("info", text))
    return found


def _position(fix: Fix, say: Texts) -> list[CaptureFinding]:
    if fix.jumped_m:
        return [CaptureFinding("warning", say("gnss-jumped", m=fix.jumped_m))]
    if fix.quality == 0:
        return [CaptureFinding("info", say("gnss-none"))]
    if fix.quality in (4, 5):
        return []
    known = fix.sd_m
    text = say("gnss-no-rtk-within", m=max(known[:2])) if known else say("gnss-no-rtk")
    return [CaptureFinding("info", text)]


def _seconds(seconds: float, say: Texts) -> str:
    if seconds < 120:
        return say("seconds", value=seconds)
    return say("minutes", value=seconds / 60)
