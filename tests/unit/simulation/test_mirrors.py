"""Mirrors and clear panes: where a LiDAR puts what it sees in them."""

import numpy as np
import pytest

from recon4.geometry.mesh import MeshBuilder
from recon4.geometry.raycast import Hits, Scene
from recon4.geometry.tuning import SURFACES
from recon4.simulation.mirrors import follow


def seen(builder: MeshBuilder, *directions: list[float]) -> Hits:
    """What beams from the origin meet."""
    mesh = builder.mesh()
    scene = Scene(mesh)
    unit = np.array(directions) / np.linalg.norm(directions, axis=1, keepdims=True)
    rays = np.hstack([np.zeros_like(unit), unit]).astype(np.float32)
    return follow(scene.cast(rays), rays, scene=scene, reflectivity=mesh.reflectivity)


def wall_before(x: float, value: float) -> MeshBuilder:
    """A surface at x = 2, and walls at ``x`` and at -3."""
    builder = MeshBuilder()
    for place, of in ((2.0, value), (x, 0.5), (-3.0, 0.4)):
        builder.quad([place, -50, -50], [0, 100, 0], [0, 0, 100], reflectivity=of)
    return builder


def test_a_mirror_shows_the_wall_behind_the_sensor_as_far_behind_itself() -> None:
    hits = seen(wall_before(9.0, SURFACES.mirror), [1, 0, 0], [1, 0.5, 0.2])

    length = np.linalg.norm([1, 0.5, 0.2])
    assert hits.range_m == pytest.approx([7.0, 7.0 * length], abs=0.01)  # 2 m there, 5 m back
    assert hits.triangle // 2 == pytest.approx([2, 2])


def test_the_incidence_is_that_on_what_is_seen_in_the_mirror() -> None:
    builder = MeshBuilder()
    builder.quad([2, -5, -5], [0, 10, 0], [0, 0, 10], reflectivity=SURFACES.mirror)
    builder.quad([-3, -9, -5], [0, 0, 10], [3, -3, 0], reflectivity=0.5)  # turned by 45°
    along = np.array([2.0, -3.5, 0.0])

    hits = seen(builder, along.tolist())

    reflected = along * [-1, 1, 1] / np.linalg.norm(along)
    true = abs(reflected @ [np.sqrt(0.5), np.sqrt(0.5), 0])
    assert abs(hits.normal[0] @ along) / np.linalg.norm(along) == pytest.approx(true, abs=1e-4)


def test_a_clear_pane_lets_through_and_reflects_at_grazing_incidence() -> None:
    hits = seen(wall_before(9.0, SURFACES.clear), [1, 0, 0], [1, 2, 0], [1, 5, 0])

    assert hits.range_m[:2] == pytest.approx([9.0, 9.0 * np.sqrt(5.0)], abs=0.01)
    assert hits.range_m[2] == pytest.approx(7.0 * np.sqrt(26.0), abs=0.01)


def test_a_beam_between_two_mirrors_does_not_return() -> None:
    builder = MeshBuilder()
    for x in (-1.0, 2.0):
        builder.quad([x, -5, -5], [0, 10, 0], [0, 0, 10], reflectivity=SURFACES.mirror)

    assert seen(builder, [1, 0, 0]).range_m == pytest.approx([np.inf])


def test_without_mirrors_nothing_changes() -> None:
    builder = wall_before(9.0, 0.5)
    hits = seen(builder, [1, 0, 0], [-1, 0.3, 0])

    assert hits.range_m == pytest.approx([2.0, 3.0 * np.sqrt(1.09)], abs=1e-5)
