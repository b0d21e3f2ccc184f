"""Recordings of a 2-D laser, as its drivers write them."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from recon4.geometry.se2 import between
from tests.builders import T0_NS, bag_path
from tests.line_tables import laser_columns, write_csv, write_npz
from tests.planar_walks import (
    START_NS,
    PlanarWalk,
    along,
    clockwise_and_back,
    drifting,
    full_turns,
    furnished_room,
    interlaced,
    scanned,
    scanned_in,
    write_carmen,
)
from tests.robot_bags import RobotBag, mount
from tests.variants.variant import Draw, Variant

_STEP_NS = 100_000_000
_CORNERS = np.array([[-3.0, 0.0], [0.0, -1.0], [3.0, -2.0]])


def planar_walk(draw: Draw, variant: Variant) -> PlanarWalk:
    """The walk, with the angles that a laser has."""
    truth = along(_CORNERS)[:50]
    layouts = {"turns": full_turns, "interlaced": interlaced, "to and fro": clockwise_and_back}
    how = draw.one("equal", "equal", *layouts)
    variant.say(how)
    if how == "equal":
        return scanned(furnished_room(), truth, odometry=draw.chance(0.5))
    walk = scanned_in(furnished_room(), truth, layouts[how](len(truth)))
    if draw.chance(0.5):
        variant.say("odometry of the wheels")
        odometry = drifting(truth, np.random.default_rng(2))
        walk = replace(walk, scans=replace(walk.scans, odometry=odometry))
    return walk


def write_laser(draw: Draw, folder: Path) -> tuple[Variant, PlanarWalk]:
    """Draw and write a recording of a 2-D laser."""
    kind = draw.one("bag1", "db3", "mcap", "carmen", "csv", "npz")
    variant = Variant(f"2-D laser, {kind}")
    walk = planar_walk(draw, variant)
    if kind == "carmen":
        variant.path = folder / "walk.log"
        write_carmen(variant.path, walk.scans)
        variant.points = len(walk.scans)
        _spoil_log(draw, variant)
        return variant, walk
    if kind in ("csv", "npz"):
        _write_table(draw, walk, folder, variant, kind=kind)
        return variant, walk
    variant.path = bag_path(folder, kind)
    with RobotBag(variant.path, kind) as bag:
        _write_scans(draw, bag, walk, variant)
    return variant, walk


def _write_table(draw, walk, folder, variant, *, kind):
    variant.path = folder / f"laser2d.{kind}"
    variant.points = len(walk.scans)
    columns = laser_columns(walk.scans)
    if draw.chance(0.5):
        variant.say("beams without a return left out")
        rows = np.isfinite(columns["range_m"])
        columns = {name: column[rows] for name, column in columns.items()}
    if draw.chance(0.3):
        variant.say("columns in another order")
        columns = dict(reversed(columns.items()))
    {"csv": write_csv, "npz": write_npz}[kind](variant.path, columns)


def _write_scans(draw, bag, walk, variant):
    upside_down = draw.chance(0.25)
    none = draw.one(np.inf, np.nan, 0.0, 30.0)
    scale = 1000.0 if draw.chance(0.15) else 1.0
    turn = mount(0.0, 0.0, 0.3, roll=180.0 * upside_down)
    stated, frame = upside_down or draw.chance(0.3), "laser"
    if stated:
        prefix = draw.one("", "", "robot1/", "/robot1/")
        frame = f"{prefix}laser"
        bag.tf((f"{prefix}base_link", frame, turn), t_ns=T0_NS - 1)
    skipped, again, unstamped = _damage(draw, len(walk.scans))
    traits = {
        f"no return = {none}": True,
        "upside down": upside_down,
        "in millimeters": scale > 1.0,
        "tf": stated,
        "scans missing": bool(skipped),
        "twice": bool(again),
        "without stamps": bool(unstamped),
    }
    for trait in (name for name, is_so in traits.items() if is_so):
        variant.say(trait)
    topic = draw.one("/scan", "/base_scan", "/robot 1/laser")
    other = draw.chance(0.2)
    if other:
        variant.say("an empty laser beside it")
    for k in range(len(walk.scans)):
        if k in skipped:
            continue
        t_ns = T0_NS + k * _STEP_NS
        first, step = walk.scans.angle_min_rad[k], walk.scans.angle_step_rad[k]
        ranges = walk.scans.ranges(k).astype(np.float64)
        angles = first + step * np.arange(len(ranges))
        if upside_down:
            angles = -angles
        ranges = np.where(np.isfinite(ranges), ranges, none) * scale
        bag.frame = frame
        for copy in range(1 + (k in again)):
            stamp_ns = 0 if k in unstamped else t_ns
            _scan(bag, topic, t_ns + copy, stamp_ns, ranges=ranges, angles=angles)
        variant.points += 1
        if other:
            blind = np.full(90, np.inf)
            _scan(bag, "/rear_scan", t_ns, t_ns, ranges=blind, angles=np.linspace(-0.5, 0.5, 90))
        if walk.scans.odometry is not None:
            bag.frame = "base_link"
            bag.walk("/odom", t_ns, walk.scans.odometry[k])


def _damage(draw, count):
    inner = range(3, count - 3)
    skipped = set(draw.rows(len(inner), 2)) if draw.chance(0.2) else set()
    again = set(draw.rows(len(inner), 4)) if draw.chance(0.2) else set()
    unstamped = set(draw.rows(len(inner), 2)) if draw.chance(0.15) else set()
    return skipped, again, unstamped


def _scan(bag, topic, t_ns, stamp_ns, *, ranges, angles):
    """Write a scan recorded at another time than its stamp; NaN, 0 and inf as they are."""
    message = bag.make(
        "sensor_msgs/msg/LaserScan",
        header=bag.header(stamp_ns),
        angle_min=float(angles[0]),
        angle_max=float(angles[-1]),
        angle_increment=float(angles[1] - angles[0]),
        time_increment=0.0,
        scan_time=0.1,
        range_min=0.05,
        range_max=30.0,
        ranges=ranges.astype(np.float32),
        intensities=np.full(len(ranges), 47.0, np.float32),
    )
    bag.write(topic, "sensor_msgs/msg/LaserScan", int(t_ns) + 5_000_000, message)


def _spoil_log(draw, variant):
    lines = variant.path.read_text("ascii").splitlines()
    how = draw.one("", "", "damaged lines", "carriage returns", "cut")
    if how:
        variant.say(how)
    if how == "damaged lines":
        for k in draw.rows(len(lines) - 4, 2):
            lines[k + 3] = lines[k + 3][:200]
        variant.points -= 2
    end = "\r\n" if how == "carriage returns" else "\n"
    text = end.join(lines) + end
    if how == "cut":
        text = text[: text.rindex("ROBOTLASER1", 0, int(0.9 * len(text))) + 900]
        variant.points = text.count(f"{end}ROBOTLASER1") - 1
    variant.path.write_bytes(text.encode("ascii"))


def error_m(walk: PlanarWalk, t_ns, poses) -> float:
    """Largest distance of poses of the laser from the truth [m], aligned at the first one."""
    start_ns = T0_NS if t_ns[0] >= T0_NS else START_NS
    rows = np.clip(np.rint((t_ns - start_ns) / _STEP_NS).astype(int), 0, len(walk.truth) - 1)
    true = between(walk.truth[rows[0]], walk.truth[rows])
    off = true - between(poses[0], poses)
    return float(np.hypot(off[:, 0], off[:, 1]).max())
