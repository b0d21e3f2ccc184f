"""What a person must know while walking, in words, the most urgent first. Pure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal

from recon4.model.rig import Rig

Level = Literal["bad", "care", "info"]

_TURN_RAD_S = 3.0
_LATE_S = 1.5
_LOW_DISK_S = 600
_SILENT_PER_S = 10.0


@dataclass(frozen=True, slots=True)
class Word:
    """One line on the phone."""

    level: Level
    text: str


def words(rig: Rig, newest: dict[str, dict[str, Any]], problem: str) -> list[Word]:
    """Warnings from the newest messages.

    Args:
        rig: What should be there.
        newest: Kind of message to the last of it (`Picture.newest`).
        problem: Of the capture itself.
    """
    found = [Word("bad", problem)] if problem else []
    status, pose = newest.get("status", {}), newest.get("pose", {})
    found += _disk(status) + _sensors(rig, status, newest) + _drops(status)
    if pose.get("lost"):
        found.append(Word("bad", "Tracking lost: stop, then go back a few steps"))
    elif (pose.get("turn_rad_s") or 0.0) > _TURN_RAD_S:
        found.append(Word("care", "Turn slower"))
    if pose.get("remark"):
        found.append(Word("care", f"{pose['remark'][0].upper()}{pose['remark'][1:]}"))
    if (pose.get("age_s") or 0.0) > _LATE_S:
        late = f"The preview is {pose['age_s']:.0f} s behind; the recording is not"
        found.append(Word("care", late))
    found += _reader(newest.get("notes", {})) + _position(newest)
    order: dict[Level, int] = {"bad": 0, "care": 1, "info": 2}
    return sorted(found, key=lambda word: order[word.level])


def rates(rig: Rig, status: dict[str, Any]) -> dict[str, float]:
    """Datagrams a second of each sensor of a rig, of its IMU and GNSS."""
    per_port: dict[int, float] = {}
    for sender in status.get("senders", []):
        per_port[sender["port"]] = per_port.get(sender["port"], 0.0) + sender["per_s"]
    found = {sensor.name: per_port.get(sensor.port, 0.0) for sensor in rig.sensors}
    return found | {
        "IMU": per_port.get(rig.imu_port, 0.0),
        "GNSS": per_port.get(rig.gnss_port, 0.0),
    }


def _disk(status: dict[str, Any]) -> list[Word]:
    if not status:
        return []
    found = []
    file, disk = status["file"], status["disk"]
    if file["problem"]:
        found.append(Word("bad", f"Nothing is recorded: {file['problem']}"))
    left_s = disk["left_s"]
    if left_s is not None and left_s < _LOW_DISK_S:
        found.append(Word("bad", f"Disk full in {max(left_s, 0) // 60} min"))
    if status["paused"]:
        found.append(Word("info", "Paused: nothing is recorded"))
    return found


def _sensors(rig: Rig, status: dict[str, Any], newest: dict[str, dict[str, Any]]) -> list[Word]:
    if not status or (not status["senders"] and status["seconds"] < 3.0):
        return []
    found = []
    by_name = rates(rig, status)
    silent = [s.name for s in rig.sensors if by_name[s.name] < _SILENT_PER_S]
    if len(silent) == len(rig.sensors):
        found.append(Word("bad", "No LiDAR sends anything: check power and cables"))
    else:
        found += [Word("bad", f"{name} LiDAR is silent") for name in silent]
    if by_name["IMU"] < 1.0:
        found.append(Word("care", "No IMU: walk and turn slowly"))
    foreign = [
        sender
        for sender in status["senders"]
        if sender["port"] in {s.port for s in rig.sensors} and 0 < sender["per_s"] < _SILENT_PER_S
    ]
    if foreign and not silent:
        found.append(Word("info", f"Foreign traffic from {foreign[0]['source']}"))
    return found


def _drops(status: dict[str, Any]) -> list[Word]:
    if not status:
        return []
    lost = status["kernel_drops"] + status["file"]["dropped"]
    return [Word("bad", f"{lost} packets were lost: this computer is too busy")] if lost else []


def _reader(notes: dict[str, Any]) -> list[Word]:
    found = [Word("care", text) for text in notes.get("warnings", [])[-3:]]
    counts = notes.get("counts", {})
    packets = counts.get("packets", 0)
    missing = counts.get("packets_missing", 0)
    if packets > 1000 and missing > 0.01 * packets:
        share = 100.0 * missing / (packets + missing)
        found.append(Word("care", f"{share:.0f} % of the packets never arrived: check the cable"))
    return found


def _position(newest: dict[str, dict[str, Any]]) -> list[Word]:
    fix = newest.get("fix")
    if fix and fix["quality"] not in (4, 5):
        return [Word("info", "GNSS without RTK fix")]
    return []
