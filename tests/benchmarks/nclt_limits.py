"""How much of the error on ``nclt-hdl32`` is the registration's own: a three-cornered hat.

    python -m tests.benchmarks.nclt_limits

Truth, `search_scans` and small_gicp (started at the truth) are three witnesses of each motion. If
their errors are independent, the variances of the three differences give that of each witness;
what the two registrations share (scans are not undistorted) counts to the truth's side.
"""

from __future__ import annotations

import numpy as np

from recon4.evaluation.table import number, text_table
from recon4.geometry.se3 import SE3, Array, so3_log
from recon4.registration.tuning import ScanTuning
from tests.benchmarks.loaders import nclt, nclt_truth
from tests.benchmarks.real_sequences import DATA, Align, ours, small_gicp_pairs

_SIGMA_PER_MAD = 1.4826


def chain(align: Align, scans: list[Array], hypotheses: SE3 | None) -> SE3:
    """``T_k_k+1`` of all consecutive pairs, started at hypotheses or at the motion before."""
    found = [SE3.identity()]
    for k in range(len(scans) - 1):
        initial = found[-1] if hypotheses is None else hypotheses[k]
        T, converged, _ = align(scans[k], scans[k + 1], initial)
        found.append(T if converged or hypotheses is not None else SE3.identity())
    return SE3.stack(found[1:])


def variances(a: SE3, b: SE3) -> Array:
    """Robust variances of what lies between two estimates: roll, pitch, yaw [deg²], xyz [cm²]."""
    delta = a.inverse() @ b
    both = np.concatenate([np.rad2deg(so3_log(delta.R)), 100.0 * delta.t], axis=1)
    off = np.abs(both - np.median(both, axis=0))
    return np.asarray((_SIGMA_PER_MAD * np.median(off, axis=0)) ** 2)


def main() -> None:
    """Print the standard deviation of each witness, axis by axis."""
    folder = DATA / "nclt-hdl32"
    scans = [frame.xyz.astype(np.float64) for frame in nclt(folder)]
    poses = nclt_truth(folder).T_a_b
    truth = poses[:-1].inverse() @ poses[1:]
    us = chain(ours(ScanTuning()), scans, None)
    peer = chain(small_gicp_pairs(), scans, truth)
    ab, ac, bc = variances(truth, us), variances(truth, peer), variances(us, peer)
    witnesses = (("truth and shared", ab + ac - bc), ("ours", ab + bc - ac),
                 ("small_gicp", ac + bc - ab))  # fmt: skip
    rows = []
    for name, twice in witnesses:
        sd = np.sqrt(np.maximum(twice / 2.0, 0.0))
        draws = np.random.default_rng(1).normal(size=(100_000, 6)) * sd
        alone = [
            np.median(np.linalg.norm(draws[:, part], axis=1)) for part in np.split(np.arange(6), 2)
        ]
        rows.append((name, *(number(float(v), 3) for v in (*sd[:3], alone[0], *sd[3:], alone[1]))))
    header = ("sd of", "roll deg", "pitch deg", "yaw deg", "makes deg median", "x cm", "y cm",
              "z cm", "makes cm median")  # fmt: skip
    print(text_table(header, rows))


if __name__ == "__main__":
    main()
