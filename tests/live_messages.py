"""Messages of a live capture with default values, for tests."""

from recon4.live import protocol


def sender(port, per_s=754.0, *, source="10.0.0.1", data_per_s=None, silent_s=0.0):
    data_per_s = (per_s if port < 3000 else 0.0) if data_per_s is None else data_per_s
    return protocol.Sender(source, port, per_s, data_per_s, silent_s)


def status(*senders, **changed):
    fields = {
        "t_ns": 1,
        "began_ns": 1,
        "seconds": 60.0,
        "paused": False,
        "skipped_in_pauses": 0,
        "senders": list(senders),
        "ports": {},
        "kernel_drops": 0,
        "serial": None,
        "file": protocol.FileState(),
        "disk": protocol.DiskState(left_s=7200),
        "notes": "",
    }
    return protocol.Status(**fields | changed)


def pose(**changed):
    fields = {
        "frame_id": 9,
        "t_ns": 1,
        "p": [0.0, 0.0, 0.0],
        "yaw": 0.0,
        "lost": False,
        "lost_frames": 0,
        "relocated": 0,
        "error_m": 0.02,
        "match_ratio": 0.9,
        "weak_sd_m": 0.005,
        "prediction_offset_m": 0.01,
        "turn_rad_s": 0.5,
        "points": [100, 100],
        "thinned": 0,
        "lately": protocol.RecentFrames(frames=100, thinned=0),
        "imu": True,
        "remark": "",
        "age_s": 0.2,
    }
    return protocol.Pose(**fields | changed)


def notes(*, findings=(), counts=None, recent=None):
    return protocol.Notes(list(findings), counts or {}, recent or {})


def fix(**changed):
    fields = {
        "t_ns": 1,
        "quality": 4,
        "lat_rad": 0.8,
        "lon_rad": 0.2,
        "sd_m": None,
        "jumped_m": None,
    }
    return protocol.Fix(**fields | changed)
