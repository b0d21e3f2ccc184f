"""Preview of the effect of decisions on the graph, without running the pipeline."""

from __future__ import annotations

from collections import OrderedDict
from time import perf_counter
from typing import Any

from recon4.model.pose_graph import PoseGraph
from recon4.review.decisions import AUTOMATIC, Decided
from recon4.review.solve import Reviewed, difference, facts_of, pair_of, review
from recon4.review.source import Source

_REMEMBERED = 6
_solved: OrderedDict[tuple[str, str], Reviewed] = OrderedDict()
"""Latest solutions of this process; the state before a decision is usually among them."""
_sources: OrderedDict[str, Source] = OrderedDict()


def preview(source: Source, decided: Decided, before: Decided) -> dict[str, Any]:
    """Result the stage ``review`` would have, and the change since earlier decisions.

    Args:
        source: The project's latest graph.
        decided: Decisions in force now.
        before: Decisions in force before the last one.

    Returns:
        JSON values: ``key`` of the decisions, ``last`` and ``all`` (`Difference` to before the last
        decision and to no decision), ``conflicts``, ``missing``, ``changed``, ``edges`` (squared
        residual and verdict of every pair somebody decided about), ``seconds``.

    Raises:
        StoreError: If there is no verified graph.
        GraphError: If the graph cannot be solved.
    """
    began_s = perf_counter()
    source = _known(source)
    earlier, now = _review(source, before).graph, _review(source, decided)
    record: dict[str, Any] = {
        "key": decided.key,
        "last": difference(earlier, now.graph).to_json(),
        "all": difference(source.verified, now.graph).to_json(),
        "edges": _decided_edges(now.graph),
    }
    record |= facts_of(now, ())
    del record["decisions"]
    return record | {"seconds": round(perf_counter() - began_s, 3)}


def _review(source: Source, decided: Decided) -> Reviewed:
    if not decided:
        return Reviewed(source.verified, (), (), ())
    known = (source.key, decided.key)
    if known not in _solved:
        _solved[known] = review(source.verified, decided.standing, settings=source.settings)
        if len(_solved) > _REMEMBERED:
            _solved.popitem(last=False)
    _solved.move_to_end(known)
    return _solved[known]


def _known(found: Source) -> Source:
    """The cached source of the same graph; artifacts never change."""
    known = str(found.artifacts["verification"])
    if known not in _sources:
        _sources[known] = found
        if len(_sources) > _REMEMBERED:
            _sources.popitem(last=False)
    return _sources[known]


def _decided_edges(graph: PoseGraph) -> list[dict[str, Any]]:
    return [
        {"pair": list(pair_of(graph, edge)), "chi2": edge.chi2, "verdict": str(edge.verdict)}
        for edge in graph.edges
        if edge.decided_by != AUTOMATIC
    ]
