"""Slices over HTTP: points on fitted surfaces, as measured, or stray returns alone."""

from tests.project_builder import build_project
from tests.service.running import server_thread

SLICES = "/api/projects/office/slices"
IMAGE = f"{SLICES}/image"
Z1 = {"kind": "horizontal", "z_m": 1.5, "thickness_m": 0.2}
ASK = {"plane": Z1, "width": 400, "height": 300}


def test_points_are_shown_on_surfaces_as_measured_or_stray_returns_alone(tmp_path):
    build_project(tmp_path / "office", points=20_000, strays=5)
    with server_thread(tmp_path) as server:
        facts = server.get(SLICES).json()
        shown = {
            surface: server.post(IMAGE, json=ASK | {"surface": surface}).json()
            for surface in ("fitted", "raw", "strays")
        }
        unknown = server.post(IMAGE, json=ASK | {"surface": "loose"})

    assert facts["surface"] == "fitted"
    assert facts["points"] == 20_000 and facts["strays"] % 5 == 0
    assert {name: image["surface"] for name, image in shown.items()} == {n: n for n in shown}
    assert shown["fitted"]["points"] == shown["raw"]["points"] > 500
    assert 0 < shown["strays"]["points"] <= facts["strays"]
    assert unknown.status_code == 422
