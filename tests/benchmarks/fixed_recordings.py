"""Five fixed recordings, mapped by other code and by today's: same bytes, or not worse.

    python -m tests.benchmarks.fixed_recordings OUT --before CHECKOUT

Both map the same simulated recordings; today's code compares both with the truth. ATE, e_r in cm;
`processor` is user and system time of the command, so it depends little on what else runs.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import resource
import subprocess
import sys
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from tests.conftest import ROOT

WALKS = {
    "office": ("office", "--seconds", "25"),
    "staircase": ("staircase", "--seconds", "40"),
    "field with fixes": ("field", "--seconds", "40"),
    "office without IMU": ("office", "--seconds", "25", "--degrade", "no-imu"),
    "profiler": ("hall", "--rig", "wuerzburg", "--figure", "eight"),
}
RESULTS = ("trajectory.tum", "graph.g2o", "map.laz")


@dataclass(frozen=True, slots=True)
class Mapped:
    """What one code made of a recording."""

    hashes: tuple[str, ...]
    """Of `RESULTS`; "-" = the workflow has no such file."""
    ate_cm: float
    e_r_cm: float | None
    processor_s: float

    def figures(self) -> str:
        e_r = "-" if self.e_r_cm is None else f"{self.e_r_cm:.3f}"
        return f"{self.ate_cm:.3f}, {e_r}, {self.processor_s:.0f}"


def main() -> None:
    """Map all with both codes and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("out", type=Path)
    parser.add_argument("--before", type=Path, required=True, help="a checkout of other code")
    a = parser.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    print("| recording | before: ATE, e_r, processor s | today | same bytes |\n|---|---|---|---|")
    for name, walk in WALKS.items():
        recording = a.out / name.replace(" ", "-")
        if not recording.exists():
            _recon4(ROOT, "simulate", walk[0], str(recording), *walk[1:])
        before = _map(a.before.resolve(), recording, a.out / f"{recording.name}-before")
        today = _map(ROOT, recording, a.out / f"{recording.name}-today")
        pairs = zip(RESULTS, before.hashes, today.hashes, strict=True)
        same = [file for file, then, now in pairs if then == now != "-"]
        print(f"| {name} | {before.figures()} | {today.figures()} | {', '.join(same) or 'none'} |")


def _map(code: Path, recording: Path, project: Path) -> Mapped:
    beside = {"--imu": "imu.csv", "--gnss": "gnss.csv", "--rig": "rig.toml"}
    more = [
        (option, str(recording / name))
        for option, name in beside.items()
        if (recording / name).exists()
    ]
    before_s = _processor_s()
    _recon4(code, "process", str(recording), "--out", str(project), *chain(*more))
    took_s = _processor_s() - before_s
    model = ("--model", str(recording / "model.ply"))
    truth = ("--truth", str(recording / "truth.tum"))
    found = json.loads(_recon4(ROOT, "evaluate", str(project), *truth, *model, "--json"))
    files = [project / name for name in RESULTS]
    hashes = [hashlib.sha256(f.read_bytes()).hexdigest() if f.exists() else "-" for f in files]
    return Mapped(tuple(hashes), *_errors_cm(found), took_s)


def _errors_cm(found: dict[str, Any]) -> tuple[float, float | None]:
    surfaces = found["relative"]["point_weighted"] if "relative" in found else None
    ate_m = found["aligned"]["position_m"]["rmse"]
    return 100.0 * ate_m, None if surfaces is None else 100.0 * surfaces["mean_m"]


def _processor_s() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _recon4(code: Path, *arguments: str) -> str:
    environment = {**os.environ, "PYTHONPATH": str(code)}
    command = [sys.executable, "-m", "recon4", *arguments]
    done = subprocess.run(command, env=environment, cwd=code, capture_output=True, text=True)
    if done.returncode:
        raise SystemExit(f"recon4 {' '.join(arguments)}: {done.stderr.strip()}")
    return done.stdout


if __name__ == "__main__":
    main()
