import numpy as np

from recon4.model.pose_graph import Reason, Verdict, known_judgment
from recon4.pose_graph.files import load_graph, save_graph
from tests.benchmarks.false_loops import office_graph


def test_edges_are_counted_as_the_finished_graph_has_them(tmp_path):
    graph, _ = office_graph(np.random.default_rng(1), nodes=12)
    rejected = [
        edge.judged(known_judgment(Verdict.REJECTED, Reason.ROBUST)) for edge in graph.edges[-3:]
    ]
    unverified = graph.edges[-4].judged(known_judgment(Verdict.UNVERIFIED))
    save_graph(tmp_path, graph.with_edges((*graph.edges[:-4], unverified, *rejected)))

    assert load_graph(tmp_path).verdict_counts() == {
        "accepted": len(graph.edges) - 4, "rejected": 3, "unverified": 1
    }  # fmt: skip
