"""What is to be seen, without a browser."""

import json

import numpy as np
import pytest

from recon4.mapping.map_notes import MapNotes
from recon4.mapping.tile import FIELDS, STORED
from recon4.mapping.tile_writer import TileWriter
from recon4.model.pose_graph import Edge, Judge, Judgment, Measure, Reason, Verdict, known_judgment
from recon4_app.viewer.client.captions import (
    Facts,
    edge_facts,
    gnss_facts,
    measurement_facts,
    measurements_csv,
)
from recon4_app.viewer.client.legend import legend
from recon4_app.viewer.client.legend_html import facts_html, legend_html
from recon4_app.viewer.client.view import ViewState
from recon4_app.viewer.cloud.palette import Range, distinct_colors, paint, table, usual_range
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.scene.build import (
    Content,
    GnssMarks,
    bounds,
    describe,
    grid_cell_m,
    measurement_label,
)
from recon4_app.viewer.scene.layers import EdgeTable, edge_layer, edge_layers
from recon4_app.viewer.scene.nodes import LinesNode
from recon4_app.viewer.scene.source import ProjectSource
from recon4_app.viewer.words import words
from tests.project_builder import add_multiframes, build_project, loop_walk, verified_graph

ENGLISH = words("en")


@pytest.fixture
def content():
    walk = loop_walk()
    table = EdgeTable.of(verified_graph(walk))
    return Content(trajectory=walk, odometry=walk, edges=table, sensors=("a<b>",))


def cloud_of(folder, p_tile, ijk=(0, 0, 0), tile_m=10.0):
    columns = {
        name: np.zeros((len(p_tile), width) if width > 1 else len(p_tile), dtype)
        for name, (dtype, width) in FIELDS.items()
    }
    columns["xyz"] = np.asarray(p_tile, dtype=np.float32)
    with TileWriter(folder, STORED, tile_m=tile_m) as writer:
        writer.notes = MapNotes(voxel_m=0.01)
        writer.append(ijk, columns)
    return Cloud(folder)


def all_on(content, **changes):
    return ViewState(chosen={layer.key: True for layer in content.layers}, **changes)


def test_far_from_the_origin_points_keep_their_millimeters(tmp_path):
    p = np.array([[0.001, 0.002, 0.003], [9.999, 9.998, 2.0]] * 200)
    cloud = cloud_of(tmp_path / "map", p, ijk=(50_000, 540_000, 30))

    drawn = [cloud.base, *(cloud.part((0, k)) for k in range(1, len(cloud.boxes.sizes[0])))]
    places = np.concatenate([part.origin_m + part.p_part for part in drawn])

    assert all(part.p_part.dtype == np.float32 for part in drawn)
    expected = np.array([500_000.0, 5_400_000.0, 300.0]) + p
    np.testing.assert_allclose(
        np.sort(places, axis=0), np.sort(expected, axis=0), rtol=0, atol=2.5e-4
    )


def test_every_edge_is_drawn_once_in_the_layer_of_its_verdict(content):
    graph = content.edges.graph
    nodes = describe(content, all_on(content))

    drawn = {}
    for node in nodes:
        if isinstance(node, LinesNode) and node.path.startswith("/edges/"):
            key = node.path.removeprefix("/edges/").rpartition("/")[0]
            drawn[key] = drawn.get(key, 0) + len(node.segments)

    assert sum(drawn.values()) == len(graph.edges)
    assert drawn["accepted/odometry"] == len(graph) - 1
    assert drawn == {row.key: row.count for row in edge_layers(graph.edges)}


def test_an_edge_runs_from_node_to_node(content):
    graph = content.edges.graph
    path = f"/edges/{edge_layer(graph.edges[0]).key}/0"

    node = next(n for n in describe(content, all_on(content)) if n.path == path)

    ends = node.position_m + node.segments[0]
    np.testing.assert_allclose(ends, graph.T_map_body.t[list((0, 1))], atol=1e-5)


def test_what_a_person_decided_has_a_layer_and_a_color_of_its_own(content):
    edge = content.edges.graph.edges[0]

    kept = edge_layer(edge.judged(known_judgment(Verdict.ACCEPTED, decided_by="Ada")))
    rejected = edge_layer(edge.judged(known_judgment(Verdict.REJECTED, decided_by="Ada")))

    others = {layer.rgb for layer in edge_layers(content.edges.graph.edges)}
    assert kept.key == "decided/accepted" and rejected.key == "decided/rejected"
    assert len({kept.rgb, rejected.rgb} - others) == 2


def test_edges_by_error_are_gray_where_no_error_is_known(content):
    edges = list(content.edges.graph.edges)
    edges[0] = edges[0].evolve(error_m=0.05, limit_m=0.05)
    edges[1] = edges[1].evolve(error_m=0.0, limit_m=0.05)
    content = Content(edges=EdgeTable.of(content.edges.graph.with_edges(tuple(edges))))

    nodes = describe(content, all_on(content, edge_color="error / limit"))

    rgb = next(n.rgb for n in nodes if n.path == "/edges/accepted/odometry/0")
    np.testing.assert_array_equal(rgb[:3], [table("turbo")[255], table("turbo")[0], [110] * 3])


def test_a_walk_that_grows_changes_its_last_piece_only(content):
    whole = content.trajectory
    before = {n.path: n for n in describe(Content(trajectory=whole[:590]), ViewState())}
    after = {n.path: n for n in describe(Content(trajectory=whole), ViewState())}

    np.testing.assert_array_equal(before["/trajectory/0"].segments, after["/trajectory/0"].segments)
    assert len(before["/trajectory/1"].segments) < len(after["/trajectory/1"].segments)


def test_a_layer_that_is_off_is_invisible_but_there(content):
    off = ViewState(chosen={layer.key: False for layer in content.layers})

    shown = {node.path: node.visible for node in describe(content, off)}

    assert "/edges/accepted/loop/0" in shown
    assert not any(shown.values())


def three_positions():
    p = np.arange(9.0).reshape(3, 3)
    t_ns = np.array([1, 2, 3], dtype=np.int64) * 1_000_000_000
    return GnssMarks(t_ns, p, p + np.array([0.0, 0.0, 0.5]), np.array([True, False, True]))


def test_positions_of_a_receiver_are_edges_sorted_into_used_and_rejected():
    marks = three_positions()

    content = Content(gnss=marks, crs="EPSG:5514")
    nodes = {node.path: node for node in describe(content, ViewState())}

    used, rejected = nodes["/gnss/used"], nodes["/gnss/rejected"]
    assert len(used.segments) == 2 * (3 + 1) and len(rejected.segments) == 3 + 1
    lines = rejected.position_m + rejected.segments
    np.testing.assert_allclose(lines[:3].mean(axis=1), [marks.p_map[1]] * 3, atol=1e-6)
    np.testing.assert_allclose(lines[3], [marks.p_antenna[1], marks.p_map[1]], atol=1e-6)
    assert [layer.label(ENGLISH) for layer in content.layers[:2]] == [
        "GNSS, used (2)",
        "GNSS, rejected (1)",
    ]
    assert "/north" in nodes


def test_a_position_picked_says_how_far_off_the_walk_it_is():
    facts = dict(gnss_facts(three_positions(), 1, began_ns=0, say=ENGLISH).rows)

    assert facts["Time"] == "2.0 s"
    assert facts["Verdict"].startswith("rejected")
    assert facts["Residual, east north up"] == "+0.000 +0.000 -0.500 m"


def test_without_a_place_on_earth_there_is_no_north(content):
    assert not any("north" in node.path for node in describe(content, ViewState()))


def test_nothing_finished_yet_is_an_empty_room_with_a_grid():
    nodes = [node.path for node in describe(Content(), ViewState()) if node.visible]

    assert nodes == ["/grid"]
    assert legend(Content(), ViewState()).color_by is None


def test_what_was_seen_far_away_does_not_move_the_camera(tmp_path):
    rng = np.random.default_rng(1)
    p = np.concatenate([rng.uniform(0.0, 10.0, (1000, 3)), [[900.0, 900.0, 900.0]]])

    box = bounds(Content(cloud=cloud_of(tmp_path / "map", p)))

    assert box.size_m < 11.0
    assert grid_cell_m(box) == 1.0


def test_the_ends_of_a_range_get_the_ends_of_the_palette():
    rgb = paint(np.array([-9.0, 0.0, 1.0, 99.0, np.nan]), Range(0.0, 1.0), "viridis")

    expected = table("viridis")[[0, 0, 255, 255, 0]]
    np.testing.assert_array_equal(rgb, expected)


def test_a_constant_value_has_a_color_and_no_value_a_range():
    assert paint(np.full(3, 7.0), usual_range(np.full(3, 7.0)), "turbo").shape == (3, 3)
    assert usual_range(np.array([np.nan])) == Range(0.0, 1.0)


def test_multiframes_that_follow_each_other_differ_in_color():
    rgb = distinct_colors(np.arange(1000, dtype=np.uint32)).astype(int)

    assert np.linalg.norm(np.diff(rgb, axis=0), axis=1).min() > 60.0


def test_the_legend_and_the_facts_escape_what_people_named(tmp_path, content):
    content = Content(cloud=cloud_of(tmp_path / "map", np.zeros((9, 3))), sensors=content.sensors)

    text = legend_html(legend(content, ViewState(color_by="sensor")))
    text += facts_html([Facts("<i>", (("<u>", "<s>"),), ("<q>", '/"><script>'))])

    assert "a&lt;b&gt;" in text and "a<b>" not in text
    assert not any(tag in text for tag in ("<i>", "<u>", "<s>", "<q>", "<script>"))


def test_an_edge_picked_leads_to_its_review(content):
    row = next(k for k, e in enumerate(content.edges.graph.edges) if e.verdict == "rejected")
    edge = content.edges.graph.edges[row]

    facts = edge_facts(content.edges, row, "my office", say=ENGLISH)

    assert facts.link == ("Open in review", f"../../my%20office/review/?edge={edge.i}-{edge.j}")
    assert ("Verdict", "rejected") in facts.rows
    assert ("Reason", str(edge.reason)) in facts.rows
    assert "Error" not in dict(facts.rows)


def test_an_edge_picked_says_who_judged_it_in_order(content):
    found = Judgment(Judge.SEARCH, Verdict.ACCEPTED, Reason.NONE, Measure.ERROR, 0.0123, 0.05)
    paths = Judgment(
        Judge.VERIFICATION, Verdict.REJECTED, Reason.VERIFICATION, Measure.PATHS, 0.4, 0.1
    )
    ada = Judgment(Judge.PERSON, Verdict.ACCEPTED, person="Ada", note="same door")
    graph = content.edges.graph
    first = graph.edges[0]
    judged = Edge(
        i=first.i, j=first.j, T_i_j=first.T_i_j, kind=first.kind, judgments=(found, paths, ada)
    )

    table = EdgeTable.of(graph.with_edges((judged, *graph.edges[1:])))
    rows = dict(edge_facts(table, 0, "office", say=ENGLISH).rows)

    assert rows["1. search"] == "accepted, error 0.0123 m of 0.05"
    assert rows["2. verification"] == (
        "rejected, verification median > limit, path discrepancy 0.4 m of 0.1"
    )
    assert rows["3. Ada"] == "accepted, same door"


def test_a_distance_has_its_components():
    points = ((1.0, 1.0, 1.0), (4.0, 5.0, -11.0))

    rows = dict(measurement_facts(1, points, ENGLISH).rows)
    table = measurements_csv([points, ((1.0, 2.0, 3.0),)]).splitlines()

    assert rows == {"Distance": "13.0000 m", "Horizontal": "5.0000 m", "Vertical": "-12.0000 m"}
    assert table[1].endswith(",13.00000,5.00000,-12.00000")
    assert table[2] == "2,1.00000,2.00000,3.00000,,,,,,"
    assert measurement_label(1, points, ENGLISH) == "1: 13.000 m"


def test_the_source_notices_new_artifacts_once(tmp_path):
    build_project(tmp_path / "office", with_map=False)
    source = ProjectSource(tmp_path / "office", tmp_path / "jobs")

    unchanged = source.changed()
    build_project(tmp_path / "office", points=100)

    assert not unchanged
    assert source.changed() and not source.changed()
    assert source.content.edges is not None and len(source.content.cloud) == 100


def test_a_map_that_control_points_alone_put_on_earth_is_shown(tmp_path):
    build_project(tmp_path / "office", points=100)
    add_multiframes(tmp_path / "office")
    (file,) = (tmp_path / "office" / "artifacts").glob("*/georeference.json")
    record = json.loads(file.read_text("utf-8"))
    no_fix = {"t_ns": [], "used": [], "residual_enu_m": [], "georeferenced": True}
    file.write_text(json.dumps(record | {"georeference": no_fix}), "utf-8")

    source = ProjectSource(tmp_path / "office", tmp_path / "jobs")

    assert source.content.gnss is not None and source.content.gnss.p_map.shape == (0, 3)


def test_every_word_of_a_scene_is_in_the_language_of_the_view(tmp_path, content):
    german = words("de")
    content = Content(
        cloud=cloud_of(tmp_path / "map", np.zeros((9, 3))),
        trajectory=content.trajectory,
        edges=content.edges,
        gnss=three_positions(),
    )
    view = all_on(content, language="de", color_by="height", edge_color="chi²")

    shown = {layer.label(german) for layer in content.layers}
    legend_text = legend_html(legend(content, view))
    labels = {node.text for node in describe(content, view) if node.path.startswith("/labels/")}
    row = next(k for k, e in enumerate(content.edges.graph.edges) if e.verdict == "rejected")
    facts = edge_facts(content.edges, row, "office", say=german)

    assert shown.isdisjoint(layer.label(ENGLISH) for layer in content.layers)
    assert shown >= {"Trajektorie", "GNSS, verworfen (1)", "Verworfen, Überlappung < t_o (3)"}
    assert "Farbe: Höhe" in legend_text and "m über dem Ursprung" in legend_text
    assert "Kanten: chi²" in legend_text
    assert labels == {"Anfang und Ende", "unten"}
    assert dict(facts.rows)["Urteil"] == "verworfen" and facts.link[0] == "In der Prüfung öffnen"
    assert dict(gnss_facts(three_positions(), 1, began_ns=0, say=german).rows)["Zeit"] == "2,0 s"
