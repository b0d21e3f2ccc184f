"""What a finished run came to, in lines at a terminal."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, cast

from recon4.cli.terminal import worded, write, write_json
from recon4.locales.languages import of_terminal

if TYPE_CHECKING:
    from recon4.workflows.map_results import Summary
    from recon4.workflows.planar_results import Summary2d
    from recon4.workflows.summary import RunSummary

_MARKS = {"note": "·", "check": "▲", "do not use": "✕"}
"""Of findings, by their level."""


def show_run(summary: RunSummary, *, project: Path | None = None, as_json: bool = False) -> None:
    """Say what a finished run came to; of a project, also what its odometry tried."""
    if as_json:
        write_json(summary.to_json())
    else:
        write("\n".join([_describe(summary), *(_describe_tried(project) if project else ())]))


def _describe_tried(out: Path) -> list[str]:
    """The hypotheses that the odometry of a project tried, in lines; none if it has no table.

    Raises:
        StoreError: If the table is damaged.
    """
    from recon4.report.tried_hypotheses import tried_lines
    from recon4.store.project import read_artifacts
    from recon4.store.tried_hypotheses import read_tried

    odometry = read_artifacts(out).get("odometry")
    tried = read_tried(odometry) if odometry else ()
    return tried_lines(tried) if tried else []


def _describe(summary: RunSummary) -> str:
    """What a finished run came to, and where its results are."""
    from recon4.workflows.map_results import Summary

    if isinstance(summary, Summary):
        return _describe_3d(summary)
    return _describe_2d(cast("Summary2d", summary))


def _describe_2d(summary: Summary2d) -> str:
    width_m, height_m = (size * summary.grid.cell_m for size in summary.grid.size)
    lines = [
        worded("run-scans", scans=summary.scans, lost=summary.lost, **_walk(summary)),
        worded(
            "run-edges",
            count=sum(summary.edges.values()),
            edges=_verdicts(summary.edges),
            loops=summary.loops,
        ),
        worded(
            "run-grid",
            width_m=width_m,
            height_m=height_m,
            cell_m=summary.grid.cell_m,
            free_m2=summary.grid.free_m2,
        ),
        *_describe_end(summary),
        _file("map", summary.folder / "map.png"),
        _file("nav2", summary.folder / "map.yaml"),
        _file("report", summary.folder / "report.html"),
    ]
    return "\n".join(lines)


def _describe_3d(summary: Summary) -> str:
    edges = summary.edges
    lines = [
        worded("run-walk", multiframes=summary.multiframes, lost=summary.lost, **_walk(summary)),
        worded("run-pairs", pairs=sum(edges.values()), edges=_verdicts(edges)),
        worded("run-points", points=summary.points),
        *_describe_end(summary),
        _file("map", summary.folder / "map.laz"),
        _file("report", summary.folder / "report.html"),
    ]
    return "\n".join(lines)


def _walk(summary: RunSummary) -> dict[str, float]:
    return {"duration_s": summary.duration_s, "length_m": summary.path_length_m}


def _verdicts(edges: Mapping[str, int]) -> str:
    return ", ".join(worded(f"pairs-{verdict}", count=count) for verdict, count in edges.items())


def _file(of: str, path: Path) -> str:
    return f"{worded(f'label-{of}'):<8}{path}"


def _describe_end(summary: RunSummary) -> list[str]:
    """Work and memory, and the verdict with its reasons and notes by their codes, a line each."""
    from recon4.findings.wording import whole_text
    from recon4.model.finding import Level

    shown = [one for one in summary.findings if one.level is not Level.GOOD]
    texts = [(one, whole_text(one, of_terminal())) for one in shown]
    return [
        worded("run-work", seconds=summary.seconds, memory_gb=summary.peak_bytes / 1e9),
        worded("run-verdict", usability=summary.verdict.usability),
        *(f"  {_MARKS[one.level]} {one.kind}: {text}" for one, text in texts),
        *([f"  {worded('run-explain')}"] if shown else []),
    ]
