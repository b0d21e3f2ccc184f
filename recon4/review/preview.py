"""Preview of the effect of decisions on the graph, without running the pipeline."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from time import perf_counter

from recon4.findings.review_problems import problem_findings
from recon4.findings.wording import whole_text
from recon4.model.plain import finite_or_none
from recon4.model.pose_graph import AUTOMATIC, PoseGraph
from recon4.review.decisions import Decided, Pair
from recon4.review.solve import (
    Difference,
    EdgeConflict,
    Reviewed,
    difference,
    pair_of,
    review,
    review_figures,
)
from recon4.review.source import Source
from recon4.review.tuning import PREVIEW
from recon4.settings.reads import VerificationReads, part_of

_solved: OrderedDict[tuple[str, str], Reviewed] = OrderedDict()
"""Latest solutions of this process; the state before a decision is usually among them."""
_sources: OrderedDict[str, Source] = OrderedDict()


@dataclass(frozen=True, slots=True)
class DecidedEdge:
    """Verdict of a pair with a decision."""

    pair: Pair
    chi2: float | None
    """Chi-square contribution; None = not in the graph."""
    verdict: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Effect:
    """Effect of the decisions on the graph."""

    key: str
    """Key of the decisions."""
    last: Difference
    """To the graph before the last decision."""
    all: Difference
    """To the graph without decisions."""
    edges: tuple[DecidedEdge, ...]
    conflicts: tuple[EdgeConflict, ...]
    """Accepted edges that do not fit the graph, worst first."""
    missing: tuple[Pair, ...]
    """Pairs of decisions without effect."""
    changed: tuple[Pair, ...]
    """Pairs whose measurement has changed since the decision."""
    warnings: tuple[str, ...]
    """The same in sentences."""
    seconds: float
    """Computing time [s]."""


def preview(source: Source, decided: Decided, before: Decided) -> Effect:
    """Result the stage ``review`` would have, and the change since earlier decisions.

    Args:
        source: The project's latest graph.
        decided: Decisions in force now.
        before: Decisions in force before the last one.

    Raises:
        StoreError: If there is no verified graph.
        GraphError: If the graph cannot be solved.
    """
    began_s = perf_counter()
    source = _known(source)
    earlier, now = _review(source, before).graph, _review(source, decided)
    figures = review_figures(now, len(decided.standing), chi2_before=None)
    return Effect(
        key=decided.key,
        last=difference(earlier, now.graph),
        all=difference(source.verified, now.graph),
        edges=_decided_edges(now.graph),
        conflicts=now.conflicts,
        missing=now.problems.missing,
        changed=now.problems.changed,
        warnings=tuple(whole_text(one) for one in problem_findings(figures)),
        seconds=round(perf_counter() - began_s, 3),
    )


def _review(source: Source, decided: Decided) -> Reviewed:
    if not decided:
        return Reviewed(source.verified, (), (), ())
    known = (source.key, decided.key)
    if known not in _solved:
        settings = part_of(source.settings, VerificationReads)
        _solved[known] = review(source.verified, decided.standing, settings=settings)
        if len(_solved) > PREVIEW.remembered:
            _solved.popitem(last=False)
    _solved.move_to_end(known)
    return _solved[known]


def _known(found: Source) -> Source:
    """The cached source of the same graph; artifacts never change."""
    known = str(found.artifacts["verification"])
    if known not in _sources:
        _sources[known] = found
        if len(_sources) > PREVIEW.remembered:
            _sources.popitem(last=False)
    return _sources[known]


def _decided_edges(graph: PoseGraph) -> tuple[DecidedEdge, ...]:
    return tuple(
        DecidedEdge(pair_of(graph, edge), finite_or_none(edge.chi2), str(edge.verdict))
        for edge in graph.edges
        if edge.decided_by != AUTOMATIC
    )
