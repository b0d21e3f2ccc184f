"""Tables of line scans and of a 2-D laser, as `recon4.recording.lasers.line_tables` reads them."""

import numpy as np

from recon4.model.laser_scans import LaserScans

START_NS = 1_700_000_000_000_000_000
LINE_NS = 10_000_000
SHOTS = 21


def line_scans(count, *, range_m=4.0):
    """Scans of equal ranges, 100 a second."""
    return LaserScans.of_rows(
        START_NS + LINE_NS * np.arange(count, dtype=np.int64),
        np.full((count, SHOTS), range_m, np.float32),
        angles=(-0.5, 0.05),
        range_max_m=100.0,
        time_step_s=4e-4,
    )


def line_columns(scans, head_rad):
    """Columns of a profiler; ``head_rad`` gives the angle of the head at times."""
    t_ns, angles_deg = _shots(scans)
    return {
        "t_ns": t_ns,
        "head_deg": np.repeat(np.rad2deg(head_rad(scans.t_ns)), scans.beams),
        "shot_deg": angles_deg,
        "range_m": scans.range_m,
        "intensity": np.full(t_ns.size, 7, np.uint8),
    }


def laser_columns(scans):
    """Columns of a 2-D laser."""
    t_ns, angles_deg = _shots(scans)
    columns = {
        "t_ns": t_ns,
        "beam_deg": angles_deg,
        "range_m": scans.range_m,
    }
    if scans.odometry is not None:
        x_m, y_m, yaw_rad = np.repeat(scans.odometry, scans.beams, axis=0).T
        columns |= {"x_m": x_m, "y_m": y_m, "yaw_deg": np.rad2deg(yaw_rad)}
    return columns


def write_npz(path, columns):
    """One array a column."""
    np.savez_compressed(path, **columns)


def write_csv(path, columns):
    """One row a shot; no return is an empty cell."""
    rows = zip(*(values.tolist() for values in columns.values()), strict=True)
    text = "".join(",".join(map(_cell, row)) + "\n" for row in rows)
    path.write_text(",".join(columns) + "\n" + text)


def _cell(value):
    return "" if value != value else repr(value)


def _shots(scans):
    scan = np.repeat(np.arange(len(scans)), scans.beams)
    beam = np.arange(len(scan)) - scans.start[scan]
    t_ns = scans.t_ns[scan] + np.rint(1e9 * scans.time_step_s[scan] * beam).astype(np.int64)
    return t_ns, np.rad2deg(scans.angle_min_rad[scan] + beam * scans.angle_step_rad[scan])
