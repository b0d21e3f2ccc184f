"""Registration and odometry without an IMU on real data, beside small_gicp and KISS-ICP.

    python -m tests.benchmarks.real_sequences [nclt] [corridor] [muehlburg] [--every N] [--skip N]

The same run, one thread each. ``nclt``: consecutive key scans against the truth. ``corridor`` and
``muehlburg``: whole sequences by `Odometry`; no truth, so length, closure and map sharpness.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from recon4.evaluation.sharpness import draw_places, sharpness
from recon4.evaluation.table import number, text_table
from recon4.geometry.se3 import SE3, Array
from recon4.kernels.imu import place_points
from recon4.model.multiframe import Multiframe
from recon4.model.rig import Rig
from recon4.model.trajectory import Trajectory
from recon4.recording.formats.cloud_files import read_cloud
from recon4.registration.odometry import Odometry
from recon4.registration.scan_registration import make_scan, search_scans
from recon4.registration.tuning import ScanTuning
from recon4.settings import Settings
from tests.benchmarks.loaders import FRAME_NS, muehlburg, nclt, nclt_truth, one_sensor
from tests.benchmarks.peers import PeerRun, kiss_icp, run

ROOT = Path(__file__).parents[2]
DATA = Path(os.environ.get("RECON4_DATA", ROOT.parent / "shared" / "data")) / "sequences"
GROSS_M = 0.5
_SHARPNESS_FRAMES = 60
_KNOTS = 20

Align = Callable[[Array, Array, SE3], tuple[SE3, bool, float]]
"""Points of target and source (N, 3), initial pose -> ``T_target_source``, converged, seconds."""


def corridor(folder: Path) -> list[Multiframe]:
    """``vlp16-corridor``: frames kept every 0.58 m of a walk, so their times are made up: rigid."""
    frames = []
    paths = sorted(folder.glob("*.pcd"), key=lambda path: int(path.stem))
    for k, path in enumerate(paths):
        cloud = read_cloud(path)
        xyz = np.stack([cloud[axis] for axis in "xyz"], axis=1).astype(np.float32)
        good = np.isfinite(xyz).all(axis=1) & (np.linalg.norm(xyz, axis=1) > 0.3)
        n = int(good.sum())
        frames.append(
            Multiframe(
                frame_id=k,
                t_ns=k * FRAME_NS,
                duration_ns=FRAME_NS,
                xyz=np.ascontiguousarray(xyz[good]),
                intensity=np.zeros(n, np.uint16),
                ring=cloud["ring"][good].astype(np.uint8),
                sensor=np.zeros(n, np.uint8),
                echo=np.zeros(n, np.uint8),
                dt_ns=np.full(n, FRAME_NS // 2, np.int32),
            )
        )
    return frames


def ours(settings: ScanTuning) -> Align:
    """`search_scans`: independent of the initial pose."""

    def align(target: Array, source: Array, initial: SE3) -> tuple[SE3, bool, float]:
        b = make_scan(source, settings)
        start = time.perf_counter()
        a = make_scan(target, settings)
        found = search_scans(a, b, initial=initial, settings=settings)
        return found.T_target_source, found.converged, time.perf_counter() - start

    return align


def small_gicp_pairs(voxel_m: float = 0.25, gate_m: float = 1.0) -> Align:
    """small_gicp's GICP; one of the two scans is prepared beforehand, as in a sequence."""
    import small_gicp

    def align(target: Array, source: Array, initial: SE3) -> tuple[SE3, bool, float]:
        b, _ = small_gicp.preprocess_points(source, voxel_m, num_threads=1)
        start = time.perf_counter()
        a, tree = small_gicp.preprocess_points(target, voxel_m, num_threads=1)
        found = small_gicp.align(
            a, b, tree, initial.matrix(), max_correspondence_distance=gate_m, num_threads=1
        )
        seconds = time.perf_counter() - start
        return SE3.from_matrix(found.T_target_source), bool(found.converged), seconds

    return align


def pairs(align: Align, scans: Sequence[Array], truth: SE3, *, initial: str, every: int) -> Array:
    """Error [m], [deg], converged, seconds of every ``every``-th consecutive pair, (K, 4)."""
    rows = []
    motion = SE3.identity()
    for k in range(0, len(scans) - 1, every):
        T_true = truth[k].inverse() @ truth[k + 1]
        start = {"truth": T_true, "identity": SE3.identity(), "before": motion}[initial]
        T, converged, seconds = align(scans[k], scans[k + 1], start)
        error = T_true.inverse() @ T
        rows.append((np.linalg.norm(error.t), np.rad2deg(float(error.angle())), converged, seconds))
        motion = T if converged else SE3.identity()
    return np.array(rows, dtype=np.float64)


def nclt_table(every: int) -> str:
    """Consecutive key scans of ``nclt-hdl32`` against the truth."""
    folder = DATA / "nclt-hdl32"
    scans = [frame.xyz.astype(np.float64) for frame in nclt(folder)]
    truth = nclt_truth(folder).T_a_b
    rows = []
    ways = (("ours", ours(ScanTuning()), ("before",)),
            ("small_gicp", small_gicp_pairs(), ("before", "truth")))  # fmt: skip
    for name, align, hypotheses in ways:
        for initial in hypotheses:
            found = pairs(align, scans, truth, initial=initial, every=every)
            gross = found[:, 0] > GROSS_M
            silent = int((gross & (found[:, 2] > 0)).sum())
            cells = (100 * np.median(found[:, 0]), np.median(found[:, 1]))
            rows.append(
                (name, initial, number(cells[0], 2), number(cells[1], 3),
                 number(100 * np.quantile(found[:, 0], 0.95), 1),
                 f"{int(gross.sum())} of {len(found)}", str(silent),
                 number(1e3 * np.median(found[:, 3]), 0))
            )  # fmt: skip
    header = ("pairs", "initial", "cm median", "deg median", "cm p95", "gross", "silent", "ms")
    return text_table(header, rows)


def odometry_run(frames: Sequence[Multiframe], rig: Rig) -> tuple[PeerRun, int]:
    """Our odometry without an IMU, and how many frames it lost."""
    odometry, steps, seconds = Odometry(rig, Settings()), [], []
    for frame in frames:
        start = time.perf_counter()
        steps.append(odometry.push(frame))
        seconds.append(time.perf_counter() - start)
    T = SE3.stack(step.T_odom_body for step in steps)
    t_ns = np.array([step.t_mid_ns for step in steps], np.int64)
    found = PeerRun("ours", Trajectory(t_ns, T), np.array(seconds), np.zeros(len(steps)))
    return found, sum(step.lost for step in steps)


def placed(frames: Sequence[Multiframe], trajectory: Trajectory, rig: Rig) -> list[Array]:
    """Points of the frames by the pose at their own time [m], (N, 3) each."""
    clouds = []
    T_body_sensor = rig.sensors[0].T_body_sensor
    for frame in frames:
        knots = frame.t_ns + np.arange(_KNOTS + 1, dtype=np.int64) * frame.duration_ns // _KNOTS
        T = trajectory.at(np.clip(knots, trajectory.t_ns[0], trajectory.t_ns[-1]))
        t_s = (knots - frame.t_ns) * 1e-9
        p_body = T_body_sensor @ frame.xyz.astype(np.float64)
        clouds.append(place_points(t_s, T.R, T.t, frame.dt_ns * 1e-9, p_body))
    return clouds


def sequence_table(frames: Sequence[Multiframe], rig: Rig, *, voxel_m: float) -> str:
    """Length, way back and crispness of the last frames, ours beside KISS-ICP's."""
    found, lost = odometry_run(frames, rig)
    # KISS-ICP aborts on a scan whose points all have the same time.
    peer = kiss_icp(deskew=bool(np.ptp(frames[0].dt_ns)), voxel_m=voxel_m)
    runs = [found, run(f"KISS-ICP {voxel_m:g} m", peer, frames, rig)]
    rows = []
    for k, one in enumerate(runs):
        t_m = one.trajectory.T_a_b.t
        clouds = placed(frames[-_SHARPNESS_FRAMES:-1], one.trajectory, rig)
        places = draw_places(clouds, rng=np.random.default_rng(1))
        crisp = sharpness(np.concatenate(clouds), places=places)
        steps = np.linalg.norm(np.diff(t_m, axis=0), axis=1)
        rows.append(
            (one.name, number(float(steps.sum()), 2), number(float(np.ptp(t_m[:, 2])), 2),
             number(crisp.entropy, 3), number(1e3 * crisp.plane_thickness_m, 1),
             str(lost) if k == 0 else "-", number(1e3 * float(np.median(one.register_s)), 0))
        )  # fmt: skip
    header = ("odometry", "path m", "height m", "entropy", "plane mm", "lost", "ms")
    return text_table(header, rows)


def main() -> None:
    """Run the requested benchmarks, by default all."""
    every = int(sys.argv[sys.argv.index("--every") + 1]) if "--every" in sys.argv else 1
    skip = int(sys.argv[sys.argv.index("--skip") + 1]) if "--skip" in sys.argv else 0
    wanted = [word for word in sys.argv[1:] if word in {"nclt", "corridor", "muehlburg"}]
    for name in wanted or ["nclt", "corridor", "muehlburg"]:
        if name == "nclt":
            print(nclt_table(every))
        elif name == "corridor":
            frames = corridor(DATA / "vlp16-corridor")
            print(sequence_table(frames, one_sensor("VLP-16"), voxel_m=0.25))
        else:
            frames = list(muehlburg(DATA / "hdl64-muehlburg"))[skip:]
            print(sequence_table(frames, one_sensor("HDL-64E"), voxel_m=0.6))


if __name__ == "__main__":
    main()
