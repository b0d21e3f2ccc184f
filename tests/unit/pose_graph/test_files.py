import json
import tracemalloc
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from recon4.errors import CorruptFile, StoreError
from recon4.geometry.se3 import SE3
from recon4.model.pose_graph import (
    Edge,
    EdgeKind,
    Judge,
    Judgment,
    Measure,
    PoseGraph,
    Reason,
    Verdict,
    known_judgment,
)
from recon4.pose_graph.files import load_graph, load_history, save_graph, write_edges_json
from recon4.pose_graph.g2o import write_g2o
from recon4.pose_graph.relations import squared_residuals
from recon4.store.arrays import load_arrays, save_arrays
from tests.benchmarks.false_loops import office_graph
from tests.g2o_reader import read_g2o


def sample() -> PoseGraph:
    graph, _ = office_graph(np.random.default_rng(1), nodes=12)
    rng = np.random.default_rng(2)
    root = rng.normal(size=(6, 6))
    odd = (
        graph.edges[3]
        .evolve(
            information=root @ root.T + np.eye(6),
            overlap=0.61,
            error_m=0.1 + 0.2,
            verification_m=1 / 3,
            paths=4,
            converged=False,
            iterations=12,
        )
        .judged(known_judgment(Verdict.REJECTED, Reason.OPERATOR, decided_by="Žofie"))
    )
    return graph.with_edges((*graph.edges[:3], odd, *graph.edges[4:]))


def same(a: Edge, b: Edge) -> None:
    for name in Edge.__struct_fields__:
        x, y = getattr(a, name), getattr(b, name)
        if isinstance(x, SE3):
            np.testing.assert_array_equal(x.R, y.R)
            np.testing.assert_array_equal(x.t, y.t)
        else:
            assert type(x) is type(y)
            np.testing.assert_array_equal(x, y)


def test_a_saved_graph_comes_back_bit_for_bit(tmp_path: Path) -> None:
    graph = sample()

    save_graph(tmp_path, graph)
    back = load_graph(tmp_path)

    np.testing.assert_array_equal(back.T_map_body.R, graph.T_map_body.R)
    np.testing.assert_array_equal(back.T_map_body.t, graph.T_map_body.t)
    np.testing.assert_array_equal(back.t_ns, graph.t_ns)
    assert len(back.edges) == len(graph.edges)
    for a, b in zip(graph.edges, back.edges, strict=True):
        same(a, b)


def test_saving_twice_writes_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        save_graph(tmp_path / name, sample())

    for file in ("graph.npz", "edges.json"):
        assert (tmp_path / "a" / file).read_bytes() == (tmp_path / "b" / file).read_bytes()


def test_a_graph_without_edges_is_saved(tmp_path: Path) -> None:
    graph = sample().with_edges(())

    save_graph(tmp_path, graph)

    assert len(load_graph(tmp_path).edges) == 0
    assert json.loads((tmp_path / "edges.json").read_text("utf-8"))["edges"] == []


def test_the_json_has_every_pair_and_null_for_unknown_numbers(tmp_path: Path) -> None:
    graph = sample()

    save_graph(tmp_path, graph)

    text = (tmp_path / "edges.json").read_text("utf-8")
    records = json.loads(text)["edges"]
    assert len(records) == len(graph.edges)
    assert "NaN" not in text
    odd = records[3]
    assert odd["frames"] == [15, 20]
    assert odd["decided_by"] == "Žofie"
    assert odd["reason"] == "operator"
    assert odd["chi2"] is None
    back = SE3.from_quat(odd["T_a_b"]["quaternion_xyzw"], odd["T_a_b"]["translation"])
    np.testing.assert_allclose(back.matrix(), graph.edges[3].T_i_j.matrix(), atol=1e-12)


def test_the_json_has_the_history_of_each_pair(tmp_path: Path) -> None:
    graph = sample()
    found = Judgment(Judge.SEARCH, Verdict.ACCEPTED, Reason.NONE, Measure.ERROR, 1 / 3, None)
    ada = Judgment(Judge.PERSON, Verdict.REJECTED, Reason.OPERATOR, person="Ada", note="a mirror")
    judged = graph.edges[4].judged(found).judged(ada)

    save_graph(tmp_path, graph.with_edges((*graph.edges[:4], judged)))

    record = json.loads((tmp_path / "edges.json").read_text("utf-8"))
    first, second = record["edges"][4]["history"]
    assert dict(zip(record["history"], first, strict=False)) == {
        "by": "search", "verdict": "accepted", "reason": "",
        "measure": "error_m", "value": 0.33333, "limit": None,
    }  # fmt: skip
    assert second == ["person", "rejected", "operator", "", None, None, "Ada", "a mirror"]


def test_a_file_from_before_edges_had_a_history_is_read(tmp_path: Path) -> None:
    graph = sample()
    save_graph(tmp_path, graph)
    columns = load_arrays(tmp_path / "graph.npz")
    new = {"judgments", "judgment", "judged_value", "judged_limit"}
    new |= {"judges", "verdicts", "reasons", "measures", "persons", "notes"}
    old = {name: column for name, column in columns.items() if name not in new}
    texts = {
        name: [str(getattr(edge, name)) for edge in graph.edges]
        for name in ("verdict", "reason", "decided_by")
    }
    texts["verdict"][5:7] = ["rejected", "rejected"]
    texts["reason"][5:7] = ["verification median > limit", "overlap < t_o"]
    old |= {name: np.array(column, dtype=np.str_) for name, column in texts.items()}
    save_arrays(tmp_path / "graph.npz", old)

    edges = load_graph(tmp_path).edges

    assert edges[0].judgments == (Judgment(Judge.ODOMETRY, Verdict.ACCEPTED),)
    assert edges[3].judgments == (
        Judgment(Judge.PERSON, Verdict.REJECTED, Reason.OPERATOR, person="Žofie"),
    )
    assert [one.by for one in edges[5].judgments][-1] is Judge.VERIFICATION
    assert edges[6].judgments == (Judgment(Judge.SEARCH, Verdict.REJECTED, Reason.OVERLAP),)


def test_the_history_of_one_pair_is_that_of_the_whole_graph(tmp_path: Path) -> None:
    graph = sample()
    save_graph(tmp_path, graph)

    for edge in load_graph(tmp_path).edges:
        frames = (int(graph.frame_ids[edge.i]), int(graph.frame_ids[edge.j]))
        expected = () if edge.kind is EdgeKind.ODOMETRY else edge.judgments
        assert load_history(tmp_path, frames) == expected
    assert load_history(tmp_path, (0, 9999)) == ()


@pytest.mark.parametrize(("name", "column", "message"), [
    ("judgments", np.ones(3, np.int64), "do not fit"),
    ("judgments", np.zeros((2, 2), np.int64), "expected one row"),
    ("judgment", np.full(3, 99), "do not fit"),
    ("judged_value", np.array(["x"]), "expected one row"),
    ("judges", np.array(["nobody"]), "do not fit|nobody"),
])  # fmt: skip
def test_judgments_that_do_not_fit_are_refused(
    tmp_path: Path, name: str, column: np.ndarray, message: str
) -> None:
    save_graph(tmp_path, sample())
    columns = load_arrays(tmp_path / "graph.npz")
    save_arrays(tmp_path / "graph.npz", {**columns, name: column})

    with pytest.raises(StoreError, match=message):
        load_graph(tmp_path)


@pytest.mark.parametrize(("name", "column"), [
    ("edge_R", np.zeros((11, 9))),
    ("information", np.zeros((11, 6, 5))),
    ("i", np.zeros(11)),
    ("overlap", np.array(["0.5"] * 11)),
])  # fmt: skip
def test_edges_with_columns_of_another_kind_are_refused(
    tmp_path: Path, name: str, column: np.ndarray
) -> None:
    graph = sample()
    save_graph(tmp_path, graph)
    rows = np.zeros(len(graph.edges), np.intp)
    columns = load_arrays(tmp_path / "graph.npz")
    save_arrays(tmp_path / "graph.npz", {**columns, name: column[rows]})

    with pytest.raises(StoreError, match=f"graph.npz: {name}: expected rows of"):
        load_graph(tmp_path)


def test_a_person_who_is_no_judge_is_refused(tmp_path: Path) -> None:
    save_graph(tmp_path, sample())
    columns = load_arrays(tmp_path / "graph.npz")
    persons = np.full(len(columns["persons"]), "Ada")
    save_arrays(tmp_path / "graph.npz", {**columns, "persons": persons})

    with pytest.raises(StoreError, match="of the person 'Ada'"):
        load_graph(tmp_path)


def test_edges_of_which_some_have_no_judgment_are_refused(tmp_path: Path) -> None:
    save_graph(tmp_path, sample())
    columns = load_arrays(tmp_path / "graph.npz")
    last = int(columns["judgments"][-1])
    fewer = {name: columns[name][:-last] for name in ("judgment", "judged_value", "judged_limit")}
    fewer["judgments"] = columns["judgments"][:-1]
    save_arrays(tmp_path / "graph.npz", {**columns, **fewer})

    with pytest.raises(StoreError, match="judgments do not fit"):
        load_graph(tmp_path)


def test_a_damaged_file_is_refused(tmp_path: Path) -> None:
    save_graph(tmp_path, sample())
    path = tmp_path / "graph.npz"
    path.write_bytes(path.read_bytes()[:2000])

    with pytest.raises(StoreError, match=r"graph\.npz"):
        load_graph(tmp_path)


def test_g2o_keeps_poses_edges_and_residuals(tmp_path: Path) -> None:
    graph = sample()

    write_g2o(tmp_path / "graph.g2o", graph)
    back = read_g2o(tmp_path / "graph.g2o")

    used = graph.with_edges(tuple(edge for edge in graph.edges if edge.in_graph))
    assert len(back.edges) == len(used.edges) == len(graph.edges) - 1
    np.testing.assert_allclose(back.T_map_body.matrix(), graph.T_map_body.matrix(), atol=1e-14)
    np.testing.assert_allclose(
        squared_residuals(back.T_map_body, back.relations),
        squared_residuals(used.T_map_body, used.relations),
        rtol=1e-9,
        atol=1e-9,
    )


def test_g2o_is_translation_first(tmp_path: Path) -> None:
    graph = sample()
    first = graph.edges[0].evolve(information=np.diag([1.0, 2, 3, 4, 5, 6]))

    write_g2o(tmp_path / "graph.g2o", graph.with_edges((first,)))

    words = (tmp_path / "graph.g2o").read_text("ascii").splitlines()[-1].split()
    assert [float(words[k]) for k in (10, 16, 21, 25, 28, 30)] == [4, 5, 6, 1, 2, 3]


def test_gtsam_reads_our_file_and_agrees_about_the_error(tmp_path: Path) -> None:
    gtsam = pytest.importorskip("gtsam")
    graph = sample()

    write_g2o(tmp_path / "graph.g2o", graph)
    factors, values = gtsam.readG2o(str(tmp_path / "graph.g2o"), True)

    of = graph.relations
    ours = squared_residuals(graph.T_map_body, of)[of.in_graph].sum()
    assert 2.0 * factors.error(values) == pytest.approx(ours, rel=1e-6)


@settings(max_examples=60)
@given(share=st.floats(0.0, 0.9999))
def test_a_truncated_g2o_file_is_rejected(
    tmp_path_factory: pytest.TempPathFactory, share: float
) -> None:
    path = tmp_path_factory.mktemp("cut") / "graph.g2o"
    write_g2o(path, sample())
    whole = path.read_bytes()
    path.write_bytes(whole[: int(share * len(whole))])

    with pytest.raises(CorruptFile):
        read_g2o(path)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "no vertex"),
        ("VERTEX_SE2 0 0 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n", "line 2: .* missing vertex"),
        ("VERTEX_SE2 0 0 0\n", "line 1: VERTEX_SE2 has 5 fields, got 4"),
        ("VERTEX_SE2 0 0 0 x\n", "line 1: could not convert"),
        ("VERTEX_SE2 0 0 0 nan\n", "line 1: a number is not finite"),
        ("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 0 0 0 0\n", "a vertex is there twice"),
        ("LANDMARK 0 0 0\n", "line 1: expected one of"),
        ("ply\nformat ascii 1.0\n", "line 1: expected one of"),
    ],
)
def test_a_file_that_is_not_g2o_is_rejected(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "graph.g2o").write_text(text)

    with pytest.raises(CorruptFile, match=message):
        read_g2o(tmp_path / "graph.g2o")


def test_an_edge_from_a_later_to_an_earlier_node_is_reversed(tmp_path: Path) -> None:
    lines = ["VERTEX_SE2 0 0 0 0", "VERTEX_SE2 1 1 0 1.5", "EDGE_SE2 1 0 -1 0.5 -1.4 9 1 2 8 3 7"]
    (tmp_path / "graph.g2o").write_text("\n".join(lines) + "\n")

    edge = read_g2o(tmp_path / "graph.g2o").edges[0]

    assert (edge.i, edge.j) == (0, 1)
    expected = SE3.from_rpy(0, 0, -1.4, t=[-1.0, 0.5, 0.0]).inverse()
    np.testing.assert_allclose(edge.T_i_j.matrix(), expected.matrix(), atol=1e-12)
    assert np.linalg.eigvalsh(edge.information)[0] > 0.0


def test_the_json_of_many_pairs_is_written_in_blocks_that_fit_together(tmp_path: Path) -> None:
    few = sample()
    graph = few.with_edges(few.edges * (12_000 // len(few.edges)))
    tracemalloc.start()
    write_edges_json(tmp_path / "edges.json", graph)
    _, peak_bytes = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    write_edges_json(tmp_path / "few.json", few)

    size_bytes = (tmp_path / "edges.json").stat().st_size
    assert size_bytes > 5e6
    assert peak_bytes < 0.6 * size_bytes
    records = json.loads((tmp_path / "edges.json").read_text("utf-8"))["edges"]
    once = json.loads((tmp_path / "few.json").read_text("utf-8"))["edges"]
    assert records == once * (12_000 // len(once))
