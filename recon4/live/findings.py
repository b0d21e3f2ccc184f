"""What a person must know while walking, in words, the most urgent first. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from recon4.model.rig import Rig, Sensor

Level = Literal["bad", "care", "info"]
Fields = dict[str, Any]

_TURN_RAD_S = 3.0
_LATE_S = 1.5
_LOW_DISK_S = 600
_SILENT_S = 1.5
_GRACE_S = 3.0
"""After the start nothing has to come yet."""
_MOST_LOST = 0.01
_UNSURE_SHARE, _UNSURE_ERROR_M, _UNSURE_GAP_M = 0.4, 0.08, 0.25
_UNSURE_HELD = 0.002
"""Degeneracy: 1/3 = held alike in all directions, 0 = one of them is free (a long corridor)."""


@dataclass(frozen=True, slots=True)
class Finding:
    """One line on the phone."""

    level: Level
    text: str


def words(rig: Rig, newest: dict[str, Fields], problem: str) -> list[Finding]:
    """Warnings from the newest messages.

    Args:
        rig: What should be there.
        newest: Kind of message to the last of it (`Picture.newest`).
        problem: Of the capture itself.
    """
    found = [Finding("bad", problem)] if problem else []
    status = newest.get("status")
    if status:
        found += [*_disk(status), *_sensors(rig, status), *_samples(rig, status)]
        found += [*_strangers(rig, status), *_drops(status)]
    found += [*_tracking(newest.get("pose", {})), *_reader(newest.get("notes", {}))]
    found += _position(newest.get("fix"))
    order: dict[Level, int] = {"bad": 0, "care": 1, "info": 2}
    return sorted(found, key=lambda word: order[word.level])


def rates(rig: Rig, status: Fields) -> dict[str, float]:
    """Datagrams a second of each sensor of a rig, of its IMU and GNSS."""
    senders = status.get("senders", [])
    found = {s.name: sum(_data_rate(one) for one in _mine(s, senders)) for s in rig.sensors}
    for name, port in (("IMU", rig.imu_port), ("GNSS", rig.gnss_port)):
        found[name] = sum(one["per_s"] for one in senders if port and one["port"] == port)
    return found


def _mine(sensor: Sensor, senders: list[Fields]) -> list[Fields]:
    """Senders that may be this sensor: they send data packets to its port."""
    return [
        one
        for one in senders
        if one["port"] == sensor.port
        and sensor.address in {"", one["source"]}
        and (_data_rate(one) > 0 or one.get("silent_s", 0.0) > 0.5)
    ]


def _data_rate(sender: Fields) -> float:
    rate: float = sender["data_per_s"] if "data_per_s" in sender else sender["per_s"]
    return rate


def _disk(status: Fields) -> list[Finding]:
    found = []
    file, left_s = status["file"], status["disk"]["left_s"]
    if file["problem"]:
        found.append(Finding("bad", f"Nothing is recorded: {file['problem']}"))
    if left_s is not None and left_s < _LOW_DISK_S:
        found.append(Finding("bad", f"Disk full in {max(left_s, 0) // 60} min"))
    if status.get("notes"):
        found.append(Finding("bad", f"A mark could not be noted: {status['notes']}"))
    if status["paused"]:
        found.append(Finding("info", "Paused: nothing is recorded"))
    return found


def _sensors(rig: Rig, status: Fields) -> list[Finding]:
    silent_s = {s.name: _silent_s(_mine(s, status["senders"]), status) for s in rig.sensors}
    silent = {name: seconds for name, seconds in silent_s.items() if seconds >= _SILENT_S}
    if silent and len(silent) == len(silent_s):
        shortest = min(silent.values())
        arrives = _arriving(rig, status)
        if arrives:
            return [Finding("bad", f"No LiDAR of the rig sends: {arrives}")]
        text = f"No LiDAR sends anything for {_seconds(shortest)}: check power and cables"
        return [Finding("bad", text)]
    return [Finding("bad", f"{name} LiDAR silent for {_seconds(s)}") for name, s in silent.items()]


def _arriving(rig: Rig, status: Fields) -> str:
    """What comes in on the LiDARs' ports though none of the rig's LiDARs is heard; empty = none."""
    for sensor in rig.sensors:
        there = [one for one in status["senders"] if one["port"] == sensor.port]
        data = [one for one in there if _data_rate(one) > 0 and one["source"] != sensor.address]
        if sensor.address and data:
            return (
                f"{sensor.name} is expected from {sensor.address}, but data packets for port "
                f"{sensor.port} come from {_sources(data)}: correct the address in the rig or in "
                "the sensor"
            )
        other = [one for one in there if one["per_s"] > 0]
        if other:
            return (
                f"datagrams for port {sensor.port} ({sensor.name}) come from {_sources(other)}, "
                "but they are no data packets of a LiDAR"
            )
    return ""


def _sources(senders: list[Fields]) -> str:
    """Addresses of some senders, at most three."""
    sources = sorted({str(one["source"]) for one in senders})
    return ", ".join(sources[:3]) + " …" * (len(sources) > 3)


def _silent_s(senders: list[Fields], status: Fields) -> float:
    """For how long none of some senders was heard [s]; 0 in the first moments."""
    if senders:
        return float(min(one.get("silent_s", 0.0) for one in senders))
    return float(status["seconds"]) if status["seconds"] >= _GRACE_S else 0.0


def _samples(rig: Rig, status: Fields) -> list[Finding]:
    found = []
    imu = [one for one in status["senders"] if one["port"] == rig.imu_port]
    silent_s = _silent_s(imu, status)
    if rig.imu_port and imu and silent_s >= _SILENT_S:
        found.append(Finding("care", f"IMU silent for {_seconds(silent_s)}: turn slowly"))
    elif silent_s >= _SILENT_S:
        found.append(Finding("care", "No IMU: walk and turn slowly"))
    if status.get("serial"):
        found.append(Finding("care", f"GNSS receiver: {status['serial']}"))
    return found


def _strangers(rig: Rig, status: Fields) -> list[Finding]:
    """Senders to a LiDAR's port that are none of the rig's, or send something else."""
    ports: dict[int, list[Sensor]] = {}
    for sensor in rig.sensors:
        ports.setdefault(sensor.port, []).append(sensor)
    found = []
    for port, sensors in ports.items():
        there = [one for one in status["senders"] if one["port"] == port and one["per_s"] > 0]
        there.sort(key=lambda one: -_data_rate(one))
        known = {s.address for s in sensors if s.address} or {
            one["source"] for one in there[: len(sensors)]
        }
        strangers = sorted({one["source"] for one in there if one["source"] not in known})
        mixed = [one for one in there if one["per_s"] - _data_rate(one) > 0]
        if strangers:
            some = ", ".join(strangers[:3]) + (" …" if len(strangers) > 3 else "")
            found.append(Finding("info", f"Foreign traffic on port {port} from {some}"))
        elif mixed:
            text = f"Packets on port {port} that are none of a LiDAR, from {mixed[0]['source']}"
            found.append(Finding("info", text))
    return found


def _drops(status: Fields) -> list[Finding]:
    found = []
    if status["kernel_drops"]:
        count = status["kernel_drops"]
        found.append(Finding("bad", f"{count} packets were lost: this computer is too busy"))
    if status["file"]["dropped"]:
        count = status["file"]["dropped"]
        text = f"{count} packets are not in the recording: the disk was full or too slow"
        found.append(Finding("bad", text))
    return found


def _tracking(pose: Fields) -> list[Finding]:
    found = []
    if pose.get("lost"):
        found.append(Finding("bad", "Tracking lost: stop, then go back a few steps"))
    elif (pose.get("turn_rad_s") or 0.0) > _TURN_RAD_S:
        found.append(Finding("care", "Turn slower"))
    elif _unsure(pose):
        found.append(Finding("care", "Tracking is unsure: walk slower, look at more walls"))
    if pose.get("remark"):
        found.append(Finding("care", f"{pose['remark'][0].upper()}{pose['remark'][1:]}"))
    return found + _late(pose)


def _late(pose: Fields) -> list[Finding]:
    """The preview lags; frames are left out of it, never of the recording."""
    age_s, lately = pose.get("age_s") or 0.0, pose.get("lately") or {"frames": 0, "thinned": 0}
    behind = f"The preview is {age_s:.0f} s behind" if age_s > _LATE_S else ""
    left_out = (
        f"{lately['thinned']} of the last {lately['frames']} frames are left out of the preview "
        f"({pose['thinned']} in all)"
        if lately["thinned"]
        else ""
    )
    said = ": ".join(text for text in (behind, left_out) if text)
    level: Level = "care" if behind else "info"
    return [Finding(level, f"{said}; the recording is whole")] if said else []


def _unsure(pose: Fields) -> bool:
    match_ratio, error_m, prediction_offset_m = (
        pose.get(name) for name in ("match_ratio", "error_m", "prediction_offset_m")
    )
    held = pose.get("degeneracy")
    return bool(
        (match_ratio is not None and match_ratio < _UNSURE_SHARE and pose.get("frame_id", 0) > 0)
        or (held is not None and held < _UNSURE_HELD and pose.get("frame_id", 0) > 0)
        or (error_m is not None and error_m > _UNSURE_ERROR_M)
        or (prediction_offset_m is not None and prediction_offset_m > _UNSURE_GAP_M)
    )


def _reader(notes: Fields) -> list[Finding]:
    found = [Finding("care", text) for text in notes.get("warnings", [])[-3:]]
    recent: Fields = notes.get("recent") or {}
    packets, missing = recent.get("packets", 0), recent.get("packets_missing", 0)
    if packets > 1000 and missing > _MOST_LOST * packets:
        match_ratio = 100.0 * missing / (packets + missing)
        found.append(
            Finding("care", f"{match_ratio:.0f} % of the packets never arrived: check the cable")
        )
    for name, what in (
        ("packets_duplicate", "came twice: the copies are left out"),
        ("packets_out_of_order", "came out of order: put right"),
        ("packets_late", "came too late for their frame"),
        ("packets_wrong_length", "on a LiDAR's port have a wrong size: left out"),
    ):
        if packets > 1000 and recent.get(name, 0) > _MOST_LOST * packets:
            found.append(Finding("info", f"{100 * recent[name] / packets:.0f} % of packets {what}"))
    return found


def _position(fix: Fields | None) -> list[Finding]:
    if not fix:
        return []
    if fix.get("jumped_m"):
        text = f"GNSS jumped by {fix['jumped_m']:.0f} m: the map is made without it"
        return [Finding("care", text)]
    sd_m = fix.get("sd_m")
    within = f", ±{max(sd_m[:2]):.2g} m" if sd_m else ""
    if fix["quality"] == 0:
        return [Finding("info", "GNSS has no position")]
    return [] if fix["quality"] in (4, 5) else [Finding("info", f"GNSS without RTK fix{within}")]


def _seconds(seconds: float) -> str:
    return f"{seconds:.0f} s" if seconds < 120 else f"{seconds / 60:.0f} min"
