"""Pairs of sweeps of a profiler's head: a node stands for all line scans of its sweep."""

from __future__ import annotations

from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import Edge
from recon4.pose_graph.pairs import too_little_overlap
from recon4.profiler.tuning import LineTuning
from recon4.review.source import Source
from recon4.settings.reads import LineGraphReads, part_of
from recon4.settings.tuning import tuned


def has_sweeps(source: Source) -> bool:
    """Whether the nodes of the graph are sweeps of a head."""
    return source.frames.rig.row_of("profiler") is not None


def multiframes_of(source: Source, node: int) -> range:
    """Multiframes with points of a node's sweep."""
    return source.sweeps.multiframes(source.frames, node)


def align_sweeps(source: Source, nodes: tuple[int, int], predicted: SE3) -> Edge:
    """Register two sweeps as the search does, from an operator's predicted pose.

    Args:
        source: The project's latest graph.
        nodes: Rows of the graph.
        predicted: Initial ``T_i_j``.

    Returns:
        The edge with the reason for which the search would reject it, if there is one.
    """
    from recon4.profiler.sweep_graph import Link, register_pair
    from recon4.profiler.sweeps import unwind_sweep

    settings, sweeps = source.settings, source.sweeps
    first, second = (
        unwind_sweep(
            source.frames,
            sweeps,
            node,
            trajectory=source.odometry,
            settings=tuned(LineTuning, settings.lines),
        )
        for node in nodes
    )
    link = Link(*nodes, initial=predicted, overlap=0.0)
    reads = part_of(settings, LineGraphReads)
    edge, close_points = register_pair((first, second), link, settings=reads)
    if not edge.reason and close_points < tuned(LineTuning, settings.lines).link_pairs:
        return edge.judged(too_little_overlap(edge.overlap))
    return edge
