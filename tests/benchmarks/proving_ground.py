"""The proving ground: walks through many worlds with errors the rig file does not know.

    python -m tests.benchmarks.proving_ground OUT [--walks W,…] [--degradations D,…] [--seconds S]
    python -m tests.benchmarks.proving_ground OUT --drawn 60 [--seed N]
    python -m tests.benchmarks.proving_ground OUT --table

Every walk is simulated once and written with every degradation. Each recording goes through the
stages up to the final trajectory and the verdict; no map is made. Each run is one line of
``OUT/runs.jsonl``; runs that are there are not repeated, so a stopped table continues. The table
is ``OUT/table.md``. ``--drawn`` draws runs with sensors of all families. What the
classes mean is in `judge` and in ``docs/studies/proving-ground.md``.
"""

from __future__ import annotations

import argparse
import json
import shutil
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from recon4.errors import Recon4Error
from recon4.findings.verdict import verdict_of
from recon4.model.finding import Finding
from recon4.model.finding_kinds import FindingKind
from recon4.model.rig import Rig, load_rig
from recon4.model.usability import MapVerdict, Usability
from recon4.progress import Silent
from recon4.recording.formats.poses import read_tum
from recon4.recording.kinds import located_sources
from recon4.recording.sources import Sources
from recon4.report.assessment import assess
from recon4.settings import preset
from recon4.simulation.crowd import Crowd
from recon4.simulation.degradation import parse_degradations
from recon4.simulation.setup import prepare
from recon4.simulation.simulate import record
from recon4.simulation.worlds import build_world
from recon4.store.frames import POINTS
from recon4.store.project import Project, ProjectDescription, read_artifacts
from recon4.store.stage import Input, StageRun, StageRunner
from recon4.workflows.choice import import_inputs
from recon4.workflows.lidar import LIDAR, to_trajectory
from recon4.workflows.map_results import report_facts
from recon4.workflows.summary import About
from recon4.workflows.workflow import Run as WorkflowRun
from tests.benchmarks.proving_draws import applies, drawn_runs, rig_of
from tests.benchmarks.proving_errors import Errors, measure

WALKS = (
    "corridor/1", "corridor:1/2", "corridor:2/3", "corridor:3/4", "tunnel/1", "tunnel:1/2",
    "garage/1", "garage:1/2", "plaza/1", "plaza:3/2", "storeys/1", "storeys:1/2",
    "tower/1", "forest/1", "forest:1/2",
    "office/1", "office/2", "staircase/1", "street/1", "field/1", "field/2",
    "mirrors/1", "elevator/1", "rooms/1", "rooms:1/2",
)  # fmt: skip
"""World with its variant, and the seed of walk and noise."""
DEGRADATIONS = (
    "none", "extrinsics", "imu-rotation", "imu-clock", "lidar-clock", "imu-grade", "imu-unit",
    "imu-axes", "imu-scale", "swap-lidars", "wrong-model", "dead-beams", "packet-loss", "beam-bias",
    "lever-arm", "gnss-clock", "no-imu", "people", "vehicles", "late-start",
)  # fmt: skip
OF_LIDARS = {"extrinsics", "lidar-clock", "swap-lidars", "wrong-model"}
"""What the audit of the rig finds of a LiDAR is part of the covariances."""
GENERIC = {FindingKind.LOOPS_NONE, FindingKind.IMU_MISSING, FindingKind.HEIGHTS_UNSTATED}
"""Findings that say only what the walk or the recording lacks, right or wrong."""
RECORDED = ("recording.pcap", "scans")
"""What a recording is in, the first of them that is there: packets, or a folder of clouds."""
_REASON_LENGTH = 160


def judge(errors: Errors | None, findings: Sequence[Finding]) -> str:
    """The class of a run.

    ``right``: the trajectory is right. ``announced``: it is wrong or there is none, and the
    verdict is *check* or *do not use* with at least one reason. ``vague``: the same, but the only
    reasons are those of `GENERIC`, right or wrong. ``SILENT``: it is wrong and the verdict is
    *good*.
    """
    if errors is not None and errors.right:
        return "right"
    reasons = [finding for finding in findings if finding.is_reason]
    if not reasons:
        return "SILENT"
    return "vague" if all(finding.kind in GENERIC for finding in reasons) else "announced"


@dataclass(frozen=True, slots=True, kw_only=True)
class Run:
    """One line of ``runs.jsonl``."""

    walk: str
    degradation: str
    seconds: float
    errors: Errors | None
    """None = the program refused the recording."""
    lost: int
    multiframes: int
    kinds: dict[str, str]
    """Kind -> worst level of the findings."""
    verdict: str
    reasons: tuple[str, ...]
    outcome: str
    """As `judge` names it."""
    cpu_s: float
    """Processor time of the stages [s]."""
    stage_cpu_s: Mapping[str, float]
    """The same by stage."""
    audited: bool = True
    """Whether the rig file was compared with the recording."""

    def to_json(self) -> dict[str, Any]:
        """Plain JSON values."""
        return asdict(self)


def prove(recording: Path, work: Path, *, walk: str, degradation: str, quick: bool = False) -> Run:
    """Map a simulated recording up to its trajectory and verdict, and judge both.

    The audit of the rig file does not change the trajectory. With ``quick`` it only runs for
    errors `OF_LIDARS`, and if the trajectory is wrong: whether that was announced depends on it,
    but what is right is right whatever the program says. That saves a tenth of the time.

    Args:
        recording: Folder of ``recon4 simulate``.
        work: Folder to make a project in.
        walk: Name of the walk.
        degradation: Name of the degradation.
    """
    begun = time.process_time()
    truth = read_tum(recording / "truth.tum")
    seconds = round(int(truth.t_ns[-1] - truth.t_ns[0]) / 1e9, 3)
    errors, lost, multiframes = None, 0, 0
    findings: tuple[Finding, ...] = ()
    refused = False
    spent: Mapping[str, float] = {}
    audited = not quick or not OF_LIDARS.isdisjoint(degradation.split("+"))
    try:
        runs, findings = map_walk(recording, work, audited=audited)
        errors = measure(runs, truth)
        if not audited and not errors.right:
            audited = True
            runs, findings = map_walk(recording, work, audited=True)
        verdict = verdict_of(findings)
        lost = runs["odometry"].figures.lost
        multiframes = runs["frames"].figures.multiframes
        spent = {name: round(run.done.cpu_seconds, 1) for name, run in runs.items()}
    except Recon4Error as error:
        refused = True
        verdict = MapVerdict(Usability.DO_NOT_USE, (f"refused: {error}",))
    return Run(
        walk=walk,
        degradation=degradation,
        seconds=seconds,
        errors=errors,
        lost=lost,
        multiframes=multiframes,
        kinds={str(one.kind): str(one.level) for one in reversed(findings)},
        verdict=str(verdict.usability),
        reasons=verdict.reasons,
        outcome="announced" if refused else judge(errors, findings),
        cpu_s=round(time.process_time() - begun, 1),
        stage_cpu_s=spent,
        audited=audited,
    )


def map_walk(
    recording: Path, work: Path, *, audited: bool
) -> tuple[Mapping[str, StageRun[Any]], tuple[Finding, ...]]:
    """The stages up to the trajectory, and what the witnesses find in what they leave.

    Args:
        recording: Folder of ``recon4 simulate``.
        work: Folder to make a project in.
        audited: Whether to compare the rig file with the recording.
    """
    outdoors = json.loads((recording / "world.json").read_text("utf-8"))["outdoors"]
    name = "outdoor" if outdoors else "indoor"
    settings, rig = preset(name), load_rig(recording / "rig.toml")
    if not audited:
        settings = replace(settings, calibration=replace(settings.calibration, mode="off"))
    with Project.open(work) as project:
        project.describe(preset=name, rig=rig.name, inputs=[])
        runner = StageRunner(project, settings, Silent())
        run = WorkflowRun(runner)
        run.stage(LIDAR.imports, **simulated_inputs(recording, rig, project))
        LIDAR.before_review(run)
        to_trajectory(run)
        about = About(ProjectDescription(recording.name, name), settings)
        return runner.runs, tuple(assess(report_facts(runner.runs, about, created="")).findings)


def simulated_inputs(recording: Path, rig: Rig, project: Project) -> dict[str, Input | None]:
    """What ``recon4 process`` reads of a simulated recording: descriptions of LiDARs, too."""
    tables = {name: recording / f"{name}.csv" for name in ("imu", "gnss")}
    given = {name: path for name, path in tables.items() if path.exists()}
    written = next(path for name in RECORDED if (path := recording / name).exists())
    sources = located_sources(Sources.of(written, rig=rig, **given))
    return import_inputs(sources, project.ledger, Silent(), planar=False)


def values_of(degradation: str) -> dict[str, float]:
    """``none`` or degradations joined by ``+``, as ``--degrade`` reads them."""
    return {} if degradation == "none" else parse_degradations(degradation.split("+"))


def matrix(lines: Sequence[Mapping[str, Any]]) -> str:
    """Error and class of every run in Markdown: a row a degradation, a column a walk."""
    walks, degradations = (
        list(dict.fromkeys(line[name] for line in lines)) for name in ("walk", "degradation")
    )
    cell = {}
    for line in lines:
        ate = _number((line["errors"] or {}).get("ate_m"), 100.0, 1)
        outcome = line["outcome"]
        cell[line["walk"], line["degradation"]] = ate if outcome == "right" else f"{ate} {outcome}"
    rows = ["| ATE cm | " + " | ".join(walks) + " |", "|---|" + "---:|" * len(walks)]
    rows += [
        f"| {name} | " + " | ".join(cell.get((walk, name), "") for walk in walks) + " |"
        for name in degradations
    ]
    return "\n".join(rows) + "\n"


def table(lines: Sequence[Mapping[str, Any]]) -> str:
    """All runs as a table in Markdown, silent ones first, then a count of each class."""
    order = {"SILENT": 0, "vague": 1, "announced": 2, "right": 3}
    rows = [
        "| walk | degradation | length m | ATE cm | largest cm | closing cm | stated 2σ cm "
        "| NEES | on earth cm | lost | findings | verdict | class | first reason |",
        "|---|---|" + "---:|" * 9 + "---|---|---|",
    ]
    for line in sorted(lines, key=lambda r: (order[r["outcome"]], r["walk"], r["degradation"])):
        e = line["errors"] or {}
        figures = [_number(e.get("length_m"), 1.0, 0)]
        figures += [
            _number(e.get(name), 100.0, 1)
            for name in ("ate_m", "largest_m", "closing_m", "stated_m")
        ]
        figures += [_number(e.get("nees"), 1.0, 2), _number(e.get("placed_m"), 100.0, 1)]
        reason = (line["reasons"] or [""])[0][:_REASON_LENGTH].replace("|", "/")
        cells = [f"{line['walk']}, {line['seconds']:g} s", line["degradation"], *figures]
        cells += [f"{line['lost']} of {line['multiframes']}", str(len(line["kinds"]))]
        # Without the audit of the rig a verdict is not the whole one.
        verdict = line["verdict"] if line.get("audited", True) else f"({line['verdict']})"
        rows.append("| " + " | ".join([*cells, verdict, line["outcome"], reason]) + " |")
    counts = {name: sum(line["outcome"] == name for line in lines) for name in order}
    total = ", ".join(f"{count} {name}" for name, count in counts.items())
    return "\n".join([*rows, "", f"{len(lines)} runs: {total}.", "", _calibration(lines)]) + "\n"


def _calibration(lines: Sequence[Mapping[str, Any]]) -> str:
    """How true the stated covariances are, as a sentence."""
    errors = [line["errors"] for line in lines if line["errors"] and "nees" in line["errors"]]
    if not errors:
        return "No covariances were stated."
    nees = np.array([e["nees"] for e in errors])
    bad, announced = (sum(e[name] for e in errors) for name in ("bad_places", "bad_announced"))
    return (
        f"NEES per degree of freedom in {len(nees)} runs: mean {nees.mean():.2f}, median "
        f"{np.median(nees):.2f}; {announced} of {bad} places that are wrong by more than 5 cm "
        "have a stated 2σ above 5 cm."
    )


def _number(value: float | None, factor: float, digits: int) -> str:
    return "-" if value is None else f"{factor * value:.{digits}f}"


def read_lines(path: Path) -> list[dict[str, Any]]:
    """Finished runs; a last line that was cut off is left out."""
    if not path.exists():
        return []
    whole = path.read_text("utf-8").split("\n")[:-1]
    return [json.loads(line) for line in whole]


def run_walk(
    walk: str,
    degradations: Sequence[str],
    out: Path,
    *,
    seconds: float,
    keep: bool = False,
    quick: bool = False,
) -> Iterator[Run]:
    """Simulate a walk with every degradation and prove each recording, `quick` or not.

    With ``keep`` the recordings stay in ``OUT/recordings``, where the next run finds them, and the
    artifacts without points in ``OUT/kept``, for studies of the errors.
    """
    outdoors, rig = build_world(walk.split("/")[0]).outdoors, rig_of(walk)
    wanted = [d for d in degradations if applies(d, outdoors=outdoors, rig=rig)]
    name = f"{walk}_{seconds:g}s".translate(str.maketrans("/: +", "-v__"))
    folders = {d: out / "recordings" / name / d.replace("+", "_") for d in wanted}
    simulate_walk(walk, {d: f for d, f in folders.items() if not f.exists()}, seconds=seconds)
    for degradation, recording in folders.items():
        project = out / "project"
        shutil.rmtree(project, ignore_errors=True)
        yield prove(recording, project, walk=walk, degradation=degradation, quick=quick)
        if keep:
            _keep(recording, project, out / "kept" / f"{name}_{degradation}")
        else:
            shutil.rmtree(recording)
        shutil.rmtree(project, ignore_errors=True)


def simulate_walk(walk: str, folders: Mapping[str, Path], *, seconds: float) -> None:
    """Write the recordings of a walk; the rays are cast once for all that do not change them."""
    world, seed = walk.split("/")[:2]
    values = {degradation: values_of(degradation) for degradation in folders}
    for crowd in {Crowd.of(of_one) for of_one in values.values()}:
        same = {folders[d]: v for d, v in values.items() if Crowd.of(v) == crowd}
        for folder in same:
            folder.parent.mkdir(parents=True, exist_ok=True)
        setup = prepare(world, seconds=seconds, seed=int(seed), rig=rig_of(walk), crowd=crowd)
        record(setup, same, bag=False, progress=Silent())


def _keep(recording: Path, project: Path, into: Path) -> None:
    shutil.rmtree(into, ignore_errors=True)
    if project.is_dir():
        for stage, folder in read_artifacts(project).items():
            shutil.copytree(folder, into / stage, ignore=shutil.ignore_patterns(POINTS))
    into.mkdir(parents=True, exist_ok=True)
    for name in ("truth.tum", "world.json"):
        shutil.copy(recording / name, into)


def main() -> None:
    """Run what is missing and write the table."""
    parser = argparse.ArgumentParser()
    parser.add_argument("out", type=Path)
    parser.add_argument("--walks", default=",".join(WALKS))
    parser.add_argument("--degradations", default=",".join(DEGRADATIONS))
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--keep", action="store_true", help="keep recordings and artifacts")
    parser.add_argument("--quick", action="store_true", help="audit the rig of wrong walks only")
    parser.add_argument("--drawn", type=int, default=0, help="runs with drawn sensors")
    parser.add_argument("--seed", type=int, default=1, help="of the drawn runs")
    parser.add_argument("--table", action="store_true", help="only write the table")
    a = parser.parse_args()
    a.out.mkdir(parents=True, exist_ok=True)
    path = a.out / "runs.jsonl"
    degradations = a.degradations.split(",")
    plan = [(walk, degradations) for walk in a.walks.split(",")]
    if a.drawn:
        plan = [(walk, [d]) for walk, d in drawn_runs(a.drawn, a.seed, degradations)]
    for walk, wanted in [] if a.table else plan:
        done = {(r["walk"], r["degradation"], r["seconds"]) for r in read_lines(path)}
        missing = [d for d in wanted if (walk, d, a.seconds) not in done]
        runs = (
            run_walk(walk, missing, a.out, seconds=a.seconds, keep=a.keep, quick=a.quick)
            if missing
            else ()
        )
        for run in runs:
            with path.open("a", encoding="utf-8") as file:
                file.write(json.dumps(run.to_json()) + "\n")
            ate = _number(run.errors.ate_m if run.errors else None, 100.0, 1)
            print(f"{walk} {run.degradation}: ATE {ate} cm, {run.verdict}, {run.outcome}, "
                  f"{run.cpu_s} s", flush=True)  # fmt: skip
    lines = read_lines(path)
    (a.out / "table.md").write_text(f"{matrix(lines)}\n{table(lines)}", "utf-8")
    print(table(lines))


if __name__ == "__main__":
    main()
