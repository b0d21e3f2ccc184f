"""Picking edges and points under a click."""

from types import SimpleNamespace

import numpy as np
import pytest

from recon4.slam2d.grid_files import TrinaryMap
from recon4_app.viewer.client.pointer_tools import PointerTools
from recon4_app.viewer.client.view import ViewState
from recon4_app.viewer.cloud.parts import Cloud
from recon4_app.viewer.cloud.pick import Ray, pick_cell, pick_edge, pick_gnss, pick_point
from recon4_app.viewer.scene.build import Content, GnssMarks
from recon4_app.viewer.scene.layers import EdgeTable
from tests.project_builder import ROOM_M, build_project, loop_walk, verified_graph


@pytest.fixture(scope="module")
def room(tmp_path_factory):
    root = tmp_path_factory.mktemp("projects") / "office"
    build_project(root, points=400_000)
    return Cloud(next(root.glob("artifacts/*/tiles.json")).parent)


def ray(origin, target, pixel_rad=0.0015):
    direction = np.subtract(target, origin)
    return Ray(np.array(origin, float), direction / np.linalg.norm(direction), pixel_rad)


@pytest.mark.parametrize("target", [(16.0, 3.3, 1.1), (9.8, 10.0, 2.0), (5.0, 2.0, 0.0)])
def test_a_click_on_a_wall_gives_a_point_of_that_wall(room, target):
    found = pick_point(room, ray((9.0, 3.0, 1.5), target))

    axis = int(np.argmax(np.isclose(target, [16.0, 10.0, 0.0])))
    assert abs(found.p_map[axis] - target[axis]) < 1e-5
    assert np.linalg.norm(np.subtract(found.p_map, target)) < 0.12


def test_it_is_the_nearest_of_all_points_to_the_ray(room):
    at = ray((9.0, 3.0, 1.5), (16.0, 3.3, 1.1))
    found = pick_point(room, at)

    every = np.concatenate([tile.xyz_m() for tile in room.tiles]) - at.origin_m
    depth = every @ at.direction
    off = np.linalg.norm(every - depth[:, None] * at.direction, axis=1) / depth
    off[(depth < 0.0) | (np.linalg.norm(every + at.origin_m - found.p_map, axis=1) > 1.0)] = np.inf
    nearest = every[np.argmin(off)] + at.origin_m
    np.testing.assert_allclose(found.p_map, nearest, atol=1e-9)


def test_a_pillar_hides_the_wall_behind_it(room):
    found = pick_point(room, ray((6.0, 5.0, 1.0), (16.0, 5.0, 1.0)))

    assert abs(found.p_map[0] - 7.7) < 0.05


def test_the_point_comes_with_all_its_columns(room):
    found = pick_point(room, ray((9.0, 3.0, 1.5), (16.0, 3.3, 1.1)))

    for tile in room.tiles:
        rows = np.flatnonzero((tile.xyz_m() == found.p_map).all(axis=1))
        for row in rows.tolist():
            columns = tile.read(["t_ns", "sensor", "intensity", "intensity_normalized"])
            assert found.t_ns == columns["t_ns"][row]
            assert found.sensor == columns["sensor"][row]
            assert found.intensity == columns["intensity"][row]
            assert found.intensity_normalized == pytest.approx(columns["intensity_normalized"][row])
            return
    raise AssertionError("no such point")


@pytest.mark.parametrize("target", [(8.0, 5.0, 50.0), (-40.0, 60.0, 30.0)])
def test_a_click_into_the_air_gives_nothing(room, target):
    assert pick_point(room, ray((8.0, 3.0, ROOM_M[2] + 1.0), target)) is None


def test_the_edge_under_the_click_is_found_and_hidden_ones_are_not():
    graph = verified_graph(loop_walk())
    table = EdgeTable.of(graph)
    for row, edge in enumerate(graph.edges):
        if edge.verdict == "rejected" and edge.reason.value.startswith("verification"):
            middle = graph.T_map_body.t[[edge.i, edge.j]].mean(axis=0)
            away = ray(middle + np.array([0.3, 0.2, 9.0]), middle)

            assert table.graph.edges[pick_edge(table, ViewState(), away)] is edge
            hidden = ViewState(chosen={table.layers[table.layer[row]].key: False})
            assert pick_edge(table, hidden, away) != row


def test_a_click_beside_all_edges_finds_none():
    table = EdgeTable.of(verified_graph(loop_walk()))

    assert pick_edge(table, ViewState(), ray((0.0, 0.0, 9.0), (0.0, 0.1, 0.0))) is None


def test_a_gnss_position_under_the_click_is_found_when_it_is_shown():
    p = np.array([[0.0, 5.0, 1.0], [3.0, 5.0, 1.0]])
    marks = GnssMarks(np.array([1, 2]), p, p - [0.0, 0.0, 1.0], np.array([True, False]))
    ray = Ray(np.array([3.0, 0.0, 0.5]), np.array([0.0, 1.0, 0.0]), 0.001)

    assert pick_gnss(marks, ViewState(chosen={"gnss/rejected": True}), ray) == 1
    assert pick_gnss(marks, ViewState(chosen={"gnss/used": True}), ray) is None
    assert pick_gnss(marks, ViewState(), ray) is None


def plan_with_a_wall():
    """4 m x 3 m from (-1, -2) on: free, not seen beyond x = 2 m, a wall along y = 0.05 m."""
    gray = np.full((30, 40), 254, np.uint8)
    gray[:, 30:] = 205
    gray[30 - 1 - 20, :25] = 0
    return TrinaryMap(gray, 0.1, (-1.0, -2.0))


@pytest.mark.parametrize(
    ("target", "expected", "what"),
    [
        ((0.02, 0.03, 0.0), (0.05, 0.05), "surface"),
        ((0.02, 0.12, 0.0), (0.05, 0.05), "surface"),
        ((0.4, -1.5, 0.0), (0.4, -1.5), "free"),
        ((2.5, 0.5, 0.0), (2.5, 0.5), "not seen"),
    ],
)
def test_a_click_on_a_2d_map_gives_a_place_or_the_surface_near_it(target, expected, what):
    found = pick_cell(plan_with_a_wall(), ray((0.5, -0.5, 8.0), target))

    assert found.what == what
    np.testing.assert_allclose(found.p_map, (*expected, 0.0), atol=1e-9)


@pytest.mark.parametrize("target", [(9.0, 0.0, 0.0), (0.5, 0.5, 9.0)])
def test_a_click_beside_a_2d_map_gives_nothing(target):
    assert pick_cell(plan_with_a_wall(), ray((0.5, -0.5, 8.0), target)) is None


def test_a_distance_on_a_2d_map_is_measured():
    measured = []

    class Panel:
        def show_picked(self, facts):
            pass

    class Screen:
        phone = False

    content = Content(plan=plan_with_a_wall())
    source = SimpleNamespace(content=content, crs_coordinates=lambda p: None)
    tools = PointerTools(source, Screen(), Panel(), project="p", change=measured.append)
    view = ViewState()
    tools.command("measure", view)
    for target in ((-0.45, 0.04, 0.0), (1.05, 0.06, 0.0)):
        tools.click(ray((0.5, -0.5, 4.0), target), view)

    for update in measured:
        view = update(view)

    ((first, second),) = view.measurements
    assert first == pytest.approx((-0.45, 0.05, 0.0))
    assert np.linalg.norm(np.subtract(second, first)) == pytest.approx(1.5)
