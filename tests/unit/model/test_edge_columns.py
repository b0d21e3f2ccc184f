import tracemalloc

import numpy as np
import pytest
from msgspec.structs import replace

from recon4.geometry.se3 import SE3
from recon4.model import edge_columns
from recon4.model.edge_columns import EdgeColumns
from recon4.model.pose_graph import (
    CHECKS_OF_THE_GRAPH,
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    Reason,
    Verdict,
    accepted_unseen,
    relations_of,
)
from recon4.model.tuning import EDGE_COLUMNS

FOUND = Judgment(Judge.SEARCH, Verdict.ACCEPTED, Reason.NONE, Measure.ERROR, 0.01, 0.1)
OUTLIER = Judgment(Judge.ROBUST, Verdict.REJECTED, Reason.ROBUST, Measure.CHI2, 99.0)
ADA = Judgment(Judge.PERSON, Verdict.REJECTED, Reason.OPERATOR, person="Ada", note="a mirror")


def edge(row: int, *judgments: Judgment, kind: EdgeKind = EdgeKind.LOOP) -> Edge:
    rng = np.random.default_rng(row)
    return Edge(
        i=row, j=row + 7, T_i_j=SE3.exp(rng.normal(size=6)), kind=kind,
        judgments=judgments or (FOUND,), information=rng.normal(size=(6, 6)),
        overlap=0.1 * row, converged=bool(row % 2), iterations=row,
    )  # fmt: skip


def walk() -> list[Edge]:
    return [
        edge(0, *accepted_unseen(), kind=EdgeKind.ODOMETRY),
        edge(1, FOUND, OUTLIER),
        edge(2, FOUND, ADA),
        edge(3),
        edge(4, FOUND, OUTLIER, kind=EdgeKind.NEIGHBOR),
    ]


def same(one: Edge, other: Edge) -> bool:
    for name in Edge.__struct_fields__:
        a, b = getattr(one, name), getattr(other, name)
        if isinstance(a, SE3):
            a, b = np.hstack([a.R, a.t[:, None]]), np.hstack([b.R, b.t[:, None]])
        is_nan = isinstance(a, float) and np.isnan(a) and np.isnan(b)
        if type(a) is not type(b) or not (is_nan or np.array_equal(a, b)):
            return False
    return True


def test_edges_are_what_they_were_before_they_were_packed():
    columns, edges = EdgeColumns.of(iter(walk())), walk()

    assert all(map(same, columns, edges)) and len(columns) == 5
    assert same(columns[-1], edges[4]) and same(columns[1:3][1], edges[2])
    with pytest.raises(IndexError):
        columns[5]


def test_packed_edges_state_the_same_relations():
    packed, loose = EdgeColumns.of(walk()).relations, relations_of(walk())

    for name in ("i", "j", "information", "in_graph", "protected"):
        assert np.array_equal(getattr(packed, name), getattr(loose, name)), name
    assert packed.in_graph.tolist() == [True, False, False, True, False]
    assert packed.protected.tolist() == [True, False, True, False, False]


def test_an_edge_is_put_in_the_row_of_another_and_more_at_the_end():
    judged, added = edge(3).judged(ADA), edge(9, OUTLIER)

    found = EdgeColumns.of(walk()).replaced({3: judged}, [added])

    expected = [*walk()[:3], judged, walk()[4], added]
    assert len(found) == 6 and all(map(same, found, expected))
    assert found.relations.protected.tolist() == [True, False, True, True, False, False]


def test_histories_end_before_the_judges_whose_verdicts_do_not_count():
    contradicted = Judgment(Judge.VERIFICATION, Verdict.REJECTED, Reason.VERIFICATION)
    edges = [*walk(), edge(5, FOUND, contradicted, OUTLIER), edge(6, OUTLIER)]

    found = list(EdgeColumns.of(edges).histories.before(CHECKS_OF_THE_GRAPH))

    assert found == [one.before(CHECKS_OF_THE_GRAPH).judgments for one in edges]
    assert found[5] == (FOUND,) and found[6] == (OUTLIER,)


def test_many_edges_take_half_of_their_memory_as_objects(monkeypatch):
    block = 128  # to make edges takes long where memory is traced
    monkeypatch.setattr(edge_columns, "EDGE_COLUMNS", replace(EDGE_COLUMNS, block=block))
    count = 5 * block

    def kept_bytes(keep):  # type: ignore[no-untyped-def]
        tracemalloc.start()
        kept = keep(edge(row, FOUND, OUTLIER) for row in range(count))
        size_bytes, most_bytes = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        assert len(kept) == count
        return size_bytes, most_bytes

    as_objects, as_columns = kept_bytes(tuple), kept_bytes(EdgeColumns.of)

    assert as_columns[0] < 0.55 * as_objects[0]
    assert as_columns[1] < as_objects[0]
