"""What is to be seen, without a browser."""

import numpy as np
import pytest

from app.viewer.layers import edge_layer, edge_layers
from app.viewer.palette import Range, paint, table, usual_range
from app.viewer.panels import legend_html
from app.viewer.scene import (
    Content,
    LinesNode,
    PointsNode,
    Tile,
    View,
    bounds,
    describe,
    grid_cell_m,
    legend,
)
from app.viewer.source import ProjectSource
from tests.project_builder import build_project, loop_walk, verified_graph

FAR_M = np.array([500_000.0, 5_400_000.0, 300.0])


def tile(p_tile, origin_m=(0.0, 0.0, 0.0)):
    z = p_tile[:, 2]
    columns = {"height": z, "sensor": np.zeros(len(z), np.uint8)}
    return Tile("0_0_0", np.asarray(origin_m), p_tile.astype(np.float32), columns)


@pytest.fixture
def content():
    walk = loop_walk()
    return Content(trajectory=walk, odometry=walk, graph=verified_graph(walk), sensors=("a<b>",))


def all_on(content, **changes):
    return View(layers=frozenset(layer.key for layer in content.layers), **changes)


def test_far_from_the_origin_points_keep_their_millimetres():
    p = np.array([[0.001, 0.002, 0.003], [9.999, 9.998, 2.0]])
    content = Content(tiles=(tile(p, FAR_M),), points_in_map=2)

    nodes = describe(content, View(color_by="height"))
    points = next(node for node in nodes if isinstance(node, PointsNode))

    assert points.p_node.dtype == np.float32
    np.testing.assert_allclose(points.position_m + points.p_node, FAR_M + p, rtol=0, atol=1e-6)


def test_every_edge_is_drawn_once_in_the_layer_of_its_verdict(content):
    nodes = describe(content, all_on(content))

    lines = {n.path: n for n in nodes if isinstance(n, LinesNode) and n.path.startswith("/edges/")}
    drawn = {path: len(node.segments) for path, node in lines.items()}

    assert sum(drawn.values()) == len(content.graph.edges)
    assert drawn["/edges/accepted/odometry"] == len(content.graph) - 1
    assert drawn == {f"/edges/{r.key}": r.count for r in edge_layers(content.graph.edges)}


def test_an_edge_runs_from_node_to_node(content):
    edge = content.graph.edges[0]
    path = f"/edges/{edge_layer(edge).key}"

    node = next(n for n in describe(content, all_on(content)) if n.path == path)

    ends = node.position_m + node.segments[0]
    np.testing.assert_allclose(ends, content.graph.T_map_body.t[[edge.i, edge.j]], atol=1e-5)


def test_a_layer_that_is_off_is_invisible_but_there(content):
    shown = {node.path: node.visible for node in describe(content, View())}

    assert not shown["/trajectory"] and not shown["/grid"]
    assert not any(on for path, on in shown.items() if path.startswith("/edges/"))


def test_nothing_finished_yet_is_an_empty_room_with_a_grid():
    nodes = describe(Content(), View(layers=frozenset({"grid"})))

    assert [node.path for node in nodes] == ["/grid"]
    assert legend(Content(), View()).color_by is None


def test_what_was_seen_far_away_does_not_move_the_camera():
    rng = np.random.default_rng(1)
    p = np.concatenate([rng.uniform(0.0, 10.0, (1000, 3)), [[900.0, 900.0, 900.0]]])

    box = bounds(Content(tiles=(tile(p),)))

    assert box.size_m < 11.0
    assert grid_cell_m(box) == 1.0


def test_the_ends_of_a_range_get_the_ends_of_the_palette():
    rgb = paint(np.array([-9.0, 0.0, 1.0, 99.0, np.nan]), Range(0.0, 1.0), "viridis")

    expected = table("viridis")[[0, 0, 255, 255, 0]]
    np.testing.assert_array_equal(rgb, expected)


def test_a_constant_value_has_a_color_and_no_value_a_range():
    assert paint(np.full(3, 7.0), usual_range(np.full(3, 7.0)), "turbo").shape == (3, 3)
    assert usual_range(np.array([np.nan])) == Range(0.0, 1.0)


def test_the_legend_escapes_what_people_named(content):
    p = np.zeros((1, 3))
    with_points = Content(tiles=(tile(p),), points_in_map=1, sensors=content.sensors)

    text = legend_html(legend(with_points, View(color_by="sensor")))

    assert "a&lt;b&gt;" in text and "a<b>" not in text


def test_a_small_budget_takes_an_even_part_of_every_tile(tmp_path):
    build_project(tmp_path / "office", points=10_000)
    source = ProjectSource(tmp_path / "office")

    few, all_of_them = source.content(1000), source.content(10**9)

    assert 990 <= sum(len(tile.p_tile) for tile in few.tiles) <= 1000
    assert len(few.tiles) == len(all_of_them.tiles) == 4
    assert sum(len(tile.p_tile) for tile in all_of_them.tiles) == few.points_in_map == 10_000


def test_the_source_notices_new_artifacts_once(tmp_path):
    build_project(tmp_path / "office", with_map=False)
    source = ProjectSource(tmp_path / "office")

    unchanged = source.changed()
    build_project(tmp_path / "office", points=100)

    assert not unchanged
    assert source.changed() and not source.changed()
    assert source.content(100).graph is not None
